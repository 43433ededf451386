# Shell helper of tools/demo and tools/check: installs what board/packages lists and this machine lacks.

# packages_in SECTION...: the packages of those sections of board/packages, one a line.
packages_in() {
  awk -v wanted=" $* " '
    /^\[.*\]$/ { on = index(wanted, " " substr($0, 2, length($0) - 2) " ") > 0; next }
    /^#/ || NF == 0 { next }
    on { print $1 }' "$ORCART_ROOT/board/packages"
}

# missing_packages SECTION...: those of them that dpkg does not show as installed.
missing_packages() {
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' | awk '$1 == "installed" {print $2}')
  packages_in "$@" | grep -vxF -e "$installed" || true
}

# install_packages SECTION...: needs root and the network only where something is missing.
install_packages() {
  local missing log=$ORCART_ROOT/build/packages.log
  if ! command -v dpkg-query >/dev/null; then
    say "board/packages lists Debian 12 packages, but there is no dpkg-query here: run this on Debian 12" >&2
    return 1
  fi
  missing=$(missing_packages "$@")
  if [ -z "$missing" ]; then
    say "all of [$*] is installed"
    return 0
  fi
  missing=$(tr '\n' ' ' <<<"$missing")
  say "installing $missing"
  mkdir -p "${log%/*}"
  # shellcheck disable=SC2086  # one word a package
  as_root apt-get -qq update >"$log" 2>&1 </dev/null &&
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends \
      -o Dpkg::Use-Pty=0 $missing >>"$log" 2>&1 </dev/null && return 0
  tail -n 15 "$log" >&2
  say "packages of board/packages could not be installed; all that apt said: $log" >&2
  return 1
}

# as_root COMMAND...: directly when root, through sudo where it asks nothing or a person may answer it. It asks on the
# terminal, whatever the command's own input and output are.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || { : </dev/tty; } 2>/dev/null; }; then
    sudo "$@"
  else
    say "this user may not install packages: run tools/demo or tools/check as root once"
    return 1
  fi
}
