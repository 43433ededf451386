# Shell helpers of board/vm: where things lie, and how a machine that cannot have them says so.

VM_DIR=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
VM_CACHE=${ORCART_VM_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/orcart-vm}
VM_CANNOT=77 # what ctest takes for skipped

say() { printf '%s\n' "$*" >&2; }

# A wrong call or a broken step.
fail() {
  say "board/vm: $*"
  exit 1
}

# This machine lacks something: no fault of the code under test.
cannot() {
  printf 'board/vm: Skipped\n%s\n' "no virtual machine here: $*"
  exit "$VM_CANNOT"
}

need_command() { # COMMAND PACKAGE
  command -v "$1" >/dev/null || cannot "$1 is missing; apt-get install $2 would bring it"
}
