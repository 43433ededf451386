#!/usr/bin/env bash
# The shell helpers of tools/check and tools/demo: sections of the package list, counts of a test run, time of a step.
set -u
ORCART_ROOT=$(mktemp -d)
trap 'rm -rf "$ORCART_ROOT"' EXIT
lib=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../../tools/lib" && pwd)
for part in steps packages tests lint; do
  # shellcheck source=/dev/null
  . "$lib/$part.sh"
done

failures=0
expect() {
  [ "$2" = "$3" ] && return
  printf '%s: expected "%s", got "%s"\n' "$1" "$3" "$2"
  failures=$((failures + 1))
}

# A ctest of our own: writes the results file it is told to, as CMake 3.25 does, and ends with $CTEST_STATUS.
mkdir -p "$ORCART_ROOT/bin" "$ORCART_ROOT/board" "$ORCART_ROOT/build/dev/Testing/Temporary"
cat >"$ORCART_ROOT/bin/ctest" <<'FAKE'
#!/usr/bin/env bash
while [ "$1" != --output-junit ]; do shift; done
printf '<testsuite name="x"\n\ttests="%s"\n\tfailures="%s"\n\tdisabled="0"\n\tskipped="%s"\n\t>\n' $CTEST_COUNTS >"$2"
exit "$CTEST_STATUS"
FAKE
chmod +x "$ORCART_ROOT/bin/ctest"
export PATH=$ORCART_ROOT/bin:$PATH
printf 'a_test.cpp:7: Skipped\nno such recording\na_test.cpp:9: Skipped\nno such recording\n' \
  >"$ORCART_ROOT/build/dev/Testing/Temporary/LastTest.log"

counts_of() { # COUNTS STATUS: what a run leaves in the counts, and its status
  passed=0 failed=0 skipped=0
  local status=0
  CTEST_COUNTS=$1 CTEST_STATUS=$2 run_ctest dev >"$ORCART_ROOT/said" || status=$?
  echo "$passed $failed $skipped $status"
}
expect "a green run" "$(counts_of '10 0 2' 0)" "8 0 2 0"
expect "reasons of skips" "$(grep -c 'skipped 2: no such recording' "$ORCART_ROOT/said")" 1
expect "a red run" "$(counts_of '10 3 2' 8)" "5 3 2 1"
expect "a run that failed without a failing test" "$(counts_of '0 0 0' 8)" "0 1 0 1"

printf '# list\n[build]\n# why\na\nb\n\n[check]\nc\n[build_more]\nd\n' >"$ORCART_ROOT/board/packages"
expect "one section" "$(packages_in build | tr '\n' ' ')" "a b "
expect "two sections" "$(packages_in build check | tr '\n' ' ')" "a b c "
dpkg-query() { printf 'installed a\nnot-installed b\nconfig-files c\ninstalled bb\n'; }
expect "what is missing" "$(missing_packages build check | tr '\n' ' ')" "b c "

# A sudo that wants its password: it does what it is told where there is a terminal to ask on. setsid takes that away.
printf '#!/bin/sh\n[ "$1" != -n ] || exit 1\nexec "$@"\n' >"$ORCART_ROOT/bin/sudo"
printf '#!/bin/sh\necho 1000\n' >"$ORCART_ROOT/bin/id"
chmod +x "$ORCART_ROOT/bin/sudo" "$ORCART_ROOT/bin/id"
cat >"$ORCART_ROOT/asks" <<ASK
. "$lib/steps.sh" && . "$lib/packages.sh"
as_root echo installed </dev/null 2>/dev/null | grep -o 'installed\|may not'
ASK
expect "a person may be asked" "$(script -qec "bash $ORCART_ROOT/asks" /dev/null </dev/null | tr -d '\r')" installed
expect "nobody may be asked" "$(setsid -w bash "$ORCART_ROOT/asks" </dev/null)" "may not"
rm "$ORCART_ROOT/bin/id" "$ORCART_ROOT/bin/sudo"

mkdir -p "$ORCART_ROOT"/{realtime,board,render,firmware-host,tools,tests}
echo 'int x;' >"$ORCART_ROOT/tools/x.cpp"
format_says() { # SCRIPT: the check's status with a clang-format that does this
  printf '#!/bin/sh\n%s\n' "$1" >"$ORCART_ROOT/bin/clang-format" && chmod +x "$ORCART_ROOT/bin/clang-format"
  check_format >"$ORCART_ROOT/said" || { echo "$?" && return; }
  echo 0
}
expect "all is formatted" "$(format_says 'exit 0')" 0
expect "a source is not" "$(format_says 'echo "tools/x.cpp:1:1: error: code should be clang-formatted" >&2; exit 1')" 1
expect "which one" "$(grep -c 'tools/x.cpp' "$ORCART_ROOT/said")" 1
expect "a clang-format that dies" "$(format_says 'kill -SEGV $$')" 1
expect "a clang-format that is not there" "$(format_says 'exit 127')" 1
rm "$ORCART_ROOT/bin/clang-format"

expect "a step's status" "$(step name false >"$ORCART_ROOT/said" || echo $?)" 1
expect "a step's last line" "$(tail -n 1 "$ORCART_ROOT/said")" "== name: 0 s, FAILED"
exit "$((failures > 0))"
