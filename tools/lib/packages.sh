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
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' 2>/dev/null | awk '$1 == "installed" {print $2}')
  packages_in "$@" | grep -vxF -e "$installed" || true
}

# install_packages SECTION...: needs root and the network only where something is missing.
install_packages() {
  local missing
  command -v dpkg-query >/dev/null ||
    fail "board/packages lists Debian 12 packages, but dpkg-query is not here: run this on Debian 12."
  missing=$(missing_packages "$@")
  if [ -z "$missing" ]; then
    say "all packages of [$*] are installed"
    return 0
  fi
  say "installing $(wc -l <<<"$missing") packages: $(tr '\n' ' ' <<<"$missing")"
  as_root apt-get -qq update </dev/null
  # shellcheck disable=SC2086  # one word a package
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends \
    -o Dpkg::Use-Pty=0 $missing </dev/null | sed -n '/^E:/p'
}

# as_root COMMAND...: directly when root, through sudo where a person may answer it or it asks nothing.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
    sudo "$@"
  else
    fail "Packages are missing and this user may not install them: as root, run apt-get install $missing"
  fi
}
