#!/usr/bin/env bash
# The kiosk's unit: systemd finds nothing wrong with it, and it is shut off from what it does not need.
set -u
unit=$ORCART_SOURCE_DIR/board/cart/orcart.service
most_exposure=20 # tenths of systemd's scale from 0 to 10; without any hardening a service has 9.6

skip() {
  printf 'unit_file_test: Skipped\n%s\n' "$1"
  exit 77
}
command -v systemd-analyze >/dev/null || skip "systemd-analyze is not here; apt-get install systemd would bring it"
[ "$(systemd-analyze --version | sed -n '1s/^systemd \([0-9]*\).*/\1/p')" -ge 250 ] ||
  skip "systemd-analyze is older than 250 and judges no unit that is not installed"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# As installed, but for the program and its README, which lie elsewhere here.
sed "s|^ExecStart=/usr/bin/orcartd|ExecStart=$ORCART_BINARY_DIR/firmware-host/app/orcartd|; /^Documentation=/d" "$unit" \
  >"$work/orcart.service"
said=$(systemd-analyze verify --man=no "$work/orcart.service" 2>&1) && [ -z "$said" ] || {
  printf 'systemd-analyze verify says of %s:\n%s\n' "$unit" "$said"
  exit 1
}
systemd-analyze security --offline=true --threshold="$most_exposure" "$work/orcart.service" >"$work/security" 2>&1 || {
  grep '✗' "$work/security"
  tail -n 1 "$work/security"
  exit 1
}

# The test bites: the same unit without its hardening is refused.
sed -E '/^(Protect|Private|Restrict|System|Capability|NoNew|Device|Lock|IPAddress|User|Group)/d' "$work/orcart.service" >"$work/open.service"
if systemd-analyze security --offline=true --threshold="$most_exposure" "$work/open.service" >/dev/null 2>&1; then
  echo "a unit without hardening was taken for a good one"
  exit 1
fi
