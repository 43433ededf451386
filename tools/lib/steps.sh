# Shell helpers of tools/demo and tools/check: named steps with their time, and how many jobs this machine bears.

say() { printf '%s\n' "$*"; }

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

# step NAME COMMAND...: says what starts, runs it, says how long it took; returns the command's status.
step() {
  local name=$1 began=$SECONDS status=0
  shift
  say "== $name"
  "$@" || status=$?
  say "== $name: $((SECONDS - began)) s$([ "$status" -eq 0 ] || printf ', FAILED')"
  return "$status"
}

# One job a core, but no more than one for each 1.5 GB of memory: Eigen and ITK sources take about 1 GB each.
jobs_here() {
  local cores memory_mb by_memory
  cores=$(nproc)
  memory_mb=$(awk '/^MemAvailable/ {print int($2 / 1024)}' /proc/meminfo)
  by_memory=$((memory_mb / 1500))
  [ "$by_memory" -ge 1 ] || by_memory=1
  if [ "$cores" -lt "$by_memory" ]; then echo "$cores"; else echo "$by_memory"; fi
}
