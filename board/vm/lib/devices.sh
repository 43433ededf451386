# Shell helpers of board/vm/run: the host's side of the guest's devices, and what the guest may ask for while it runs.

VM_DEVICES='gpio encoder tracker tracker_here usb_gadget vivid camera screen vkms uinput keyboard'

# device_arguments NAME: adds to `machine`, the arguments of QEMU. Devices that are modules only need none.
device_arguments() {
  case $1 in
    tracker)
      start_emulator
      machine+=(-chardev "socket,id=tracker,path=$run_dir/tracker.socket,server=off,reconnect=1")
      add_usb && machine+=(-device usb-serial,chardev=tracker,id=tracker,port=1,always-plugged=off)
      ;;
    tracker_here)
      machine+=(-chardev "socket,id=far,path=$run_dir/tracker.socket,server=on,wait=off"
        -device virtserialport,chardev=far,name=tracker
        -chardev "socket,id=tracker,path=$run_dir/tracker.socket,server=off,reconnect=1")
      add_usb && machine+=(-device usb-serial,chardev=tracker,id=tracker,port=1)
      ;;
    keyboard) add_usb && machine+=(-device usb-kbd,id=keyboard) ;;
    screen) machine+=(-device VGA,vgamem_mb=32,edid=on,xres=1280,yres=800) ;;
    gpio | encoder | usb_gadget | vivid | camera | vkms | uinput) ;;
    *) fail "there is no device $1; there are $VM_DEVICES" ;;
  esac
}

add_usb() {
  [[ " ${machine[*]} " == *' qemu-xhci '* ]] || machine+=(-device qemu-xhci)
}

# The tracker's emulator runs here, beside QEMU; `orcart` is the one just built.
start_emulator() {
  local orcart=${ORCART_BINARY_DIR:-$VM_DIR/../../build/dev}/tools/orcart/orcart
  [ -x "$orcart" ] || fail "--device tracker wants $orcart; cmake --build build/dev --target orcart makes it"
  "$orcart" emulate tracker --unix "$run_dir/tracker.socket" "${emulator_options[@]}" \
    >"$run_dir/emulator.txt" 2>&1 &
  emulator=$!
  helpers+=("$emulator")
}

# serve_guest: carries out what vm-host asks, line by line, until QEMU ends.
serve_guest() {
  local verb what how
  exec 5<>"$run_dir/qmp.in" 6<"$run_dir/qmp.out"
  qmp '{"execute": "qmp_capabilities"}' >/dev/null
  exec 7<>"$run_dir/host.in"
  while read -r verb what how; do answer "$verb" "$what" "$how" >&7; done <"$run_dir/host.out"
}

answer() {
  case "$1 $2" in
    'screendump '*) qmp_said screendump "\"filename\": \"$run_dir/share/${2##*/}\", \"format\": \"png\"" ;;
    'unplug tracker') qmp_said device_del '"id": "tracker"' ;;
    'plug tracker') qmp_said device_add '"driver": "usb-serial", "id": "tracker", "port": "1", "chardev": "tracker"' ;;
    'key '*)
      local down=true
      [ "$3" = down ] || down=false
      qmp_said input-send-event "\"events\": [{\"type\": \"key\", \"data\":
        {\"down\": $down, \"key\": {\"type\": \"qcode\", \"data\": \"$2\"}}}]"
      ;;
    *) echo "the host does not know how to $1 $2" ;;
  esac
}

qmp_said() { # COMMAND ARGUMENTS: "done", or what QEMU answered
  local said
  said=$(qmp "{\"execute\": \"$1\", \"arguments\": {$2}}")
  [[ $said == *'"return"'* ]] && echo "done" || echo "${said//$'\n'/ }"
}

# One QMP command, its reply; events in between are let go.
qmp() {
  local line
  printf '%s\n' "${1//$'\n'/ }" >&5
  while read -r -t 20 line <&6; do
    case $line in *'"return"'* | *'"error"'*)
      printf '%s\n' "$line"
      return
      ;;
    esac
  done
  echo "QEMU does not answer"
}
