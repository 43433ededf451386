#!/bin/bash
# In the guest: every device that board/vm/run was asked for is there, by the driver that it should be by.
set -u
failures=0
expect() { # WHAT COMMAND...
  local what=$1
  shift
  "$@" >/dev/null 2>&1 && return
  printf 'not so: %s (%s)\n' "$what" "$*"
  failures=$((failures + 1))
}

driver_of_card() { sed -n 's/^DRIVER=//p' "/sys/class/drm/$1/device/uevent"; }
pull_moves_the_line() {
  local line=$ORCART_TEST_GPIO_SIM/sim_gpio4
  echo pull-up >"$line/pull" && [ "$(cat "$line/value")" = 1 ] &&
    echo pull-down >"$line/pull" && [ "$(cat "$line/value")" = 0 ]
}
screendump_is_a_picture() { vm-host screendump machine.png && [ "$(head -c 4 /vm/machine.png | tail -c 3)" = PNG ]; }
unplugs_and_replugs() {
  local bridge=/dev/ttyUSB0 tenths
  vm-host unplug tracker || return
  for ((tenths = 0; tenths < 50; tenths++)); do [ -e $bridge ] || break && sleep 0.1; done
  [ ! -e $bridge ] && vm-host plug tracker || return
  for ((tenths = 0; tenths < 150; tenths++)); do [ ! -e $bridge ] || return 0 && sleep 0.1; done
  return 1
}

[ "${1:-}" != rt ] || expect "the kernel is PREEMPT_RT" test "$(cat /sys/kernel/realtime)" = 1
expect "gpio-sim's chip is there" test -c "${ORCART_TEST_GPIO%%:*}"
expect "a pull moves its line" pull_moves_the_line
expect "a rotary encoder is driven by rotary-encoder" grep -q '"rotary-encoder"' /proc/bus/input/devices
expect "vivid is there" grep -q vivid "/sys/class/video4linux/${ORCART_TEST_CAMERA##*/}/name"
expect "v4l2loopback is there" grep -q endoscope "/sys/class/video4linux/${ORCART_VM_CAMERA##*/}/name"
expect "the screen is driven by bochs-drm" test "$(driver_of_card card0)" = bochs-drm
expect "its connector is connected" grep -qx connected /sys/class/drm/card0-Virtual-1/status
expect "its picture comes out" screendump_is_a_picture
expect "vkms is there" test -e /dev/dri/card1
expect "a USB gadget could be bound" test -e /sys/class/udc/dummy_udc.0
expect "the USB keyboard is there" grep -q 'QEMU USB Keyboard' /proc/bus/input/devices
expect "the bridge is an FT232" grep -q '^0403$' /sys/bus/usb-serial/devices/ttyUSB0/../../idVendor
expect "it can be unplugged and plugged again" unplugs_and_replugs
expect "what is written stays in the guest" bash -c "touch '$0.written' && [ -e '$0.written' ]"
[ "$failures" -eq 0 ] && echo "every device is there: $(uname -r), up for $(cut -d ' ' -f 1 /proc/uptime) s"
exit "$((failures > 0))"
