#!/usr/bin/env bash
# The Debian packages: what they depend on, and that orcartd's installs and runs on a fresh Debian 12.
set -u
work=$(mktemp -d)
chmod 755 "$work" # apt fetches as a user of its own
trap 'rm -rf "$work"' EXIT

skip() {
  printf 'package_test: Skipped\n%s\n' "$1"
  exit 77
}
fail() {
  printf '%s\n' "$@"
  exit 1
}

cpack --config "$ORCART_BINARY_DIR/CPackConfig.cmake" -G DEB -B "$work" >"$work/log" 2>&1 || fail "cpack failed:" "$(tail -n 20 "$work/log")"
package=$(find "$work" -maxdepth 1 -name 'orcartd_*.deb')
[ -n "$package" ] || fail "cpack made no orcartd_*.deb"

depends=$(dpkg-deb -f "$package" Depends)
[[ $depends == *libembree3* && $depends == *libsqlite3* ]] || fail "the dependencies were not read from the program: $depends"
dpkg-deb -c "$package" >"$work/files"
heavy=$(grep -oE 'lib(opencv|ceres|insighttoolkit|vtk|assimp|gdcm|python)[^, ]*' <<<"$depends")
[ -z "$heavy" ] || fail "the resident program depends on what is for tools only:" "$heavy"

for file in usr/bin/orcartd usr/lib/systemd/system/orcart.service usr/lib/udev/rules.d/70-orcart.rules usr/lib/sysusers.d/orcart.conf \
  usr/share/orcart/carts/demo.toml usr/share/orcart/surfaces/LICENSE.colin27 usr/share/doc/orcartd/copyright etc/default/orcart; do
  grep -q " \./$file\$" "$work/files" || fail "$package lacks $file"
done

sources=/etc/apt/sources.list.d/debian.sources
[ -e "$sources" ] || sources=/etc/apt/sources.list
command -v mmdebstrap >/dev/null || skip "mmdebstrap is not here, so the package was not installed; apt-get install mmdebstrap would bring it"
[ "$(id -u)" -eq 0 ] || skip "only root may make a fresh Debian here, so the package was not installed"
# systemd-standalone-sysusers makes the user without a whole systemd.
mmdebstrap --quiet --variant=minbase --skip=cleanup/apt/lists --include=systemd-standalone-sysusers bookworm "$work/fresh" "$sources" >"$work/log" 2>&1 ||
  skip "a fresh Debian could not be had ($(tail -n 1 "$work/log")), so the package was not installed"
before=$(chroot "$work/fresh" dpkg-query -f '.\n' -W | wc -l)
cp "$package" "$work/fresh/orcartd.deb"
chroot "$work/fresh" env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends /orcartd.deb >"$work/log" 2>&1 ||
  fail "the package cannot be installed on a fresh Debian:" "$(tail -n 20 "$work/log")"
after=$(chroot "$work/fresh" dpkg-query -f '.\n' -W | wc -l)
chroot "$work/fresh" id orcart >"$work/log" 2>&1 || fail "the package made no user orcart"
for group in video render input dialout; do
  grep -q "($group)" "$work/log" || fail "the user orcart is not in the group $group: $(cat "$work/log")"
done
mount -t proc proc "$work/fresh/proc" 2>/dev/null && trap 'umount "$work/fresh/proc"; rm -rf "$work"' EXIT
chroot "$work/fresh" orcartd --cart /usr/share/orcart/carts/demo.toml --panel none --clock simulated --for 1s >"$work/log" 2>&1 ||
  fail "orcartd does not run on a fresh Debian:" "$(tail -n 20 "$work/log")"
echo "orcartd installed with $((after - before - 1)) more packages and ran a simulated second"
