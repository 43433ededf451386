# Shell helper of tools/demo and tools/check: configures and builds one preset, quietly while all goes well.

# build_preset PRESET CMAKE_OPTIONS -- TARGETS: options and targets may be empty; a log of each lies in build/.
build_preset() {
  local preset=$1 options=() log=$ORCART_ROOT/build/$1.log
  shift
  while [ $# -gt 0 ] && [ "$1" != -- ]; do options+=("$1") && shift; done
  [ $# -eq 0 ] || shift
  mkdir -p "${log%/*}"
  cmake -S "$ORCART_ROOT" --preset "$preset" "${options[@]}" >"$log" 2>&1 || {
    tail -n 30 "$log" >&2
    return 1
  }
  NINJA_STATUS='[%f/%t %es] ' ninja -C "$ORCART_ROOT/build/$preset" -j "$(jobs_here)" "$@" 2>&1 | tee -a "$log" | show_progress
}

# One line that grows on a terminal; elsewhere every fiftieth step. What a failing command says is shown in full.
show_progress() {
  local line failed='' steps=0
  while IFS= read -r line; do
    case $line in
      'ninja: Entering'* | 'ninja: no work'*) continue ;;
      FAILED* | 'ninja: error'*) failed=yes ;;
    esac
    if [ -n "$failed" ] || [[ $line != '['*/*'] '* ]]; then
      say "$line"
    elif [ -t 1 ]; then
      printf '\r\033[K%.100s' "$line"
    elif steps=$((steps + 1)) && [ $((steps % 50)) -eq 0 ]; then
      say "${line%%]*}]"
    fi
  done
  [ ! -t 1 ] || printf '\r\033[K'
}
