# Shell helper of tools/check: runs ctest, shows what failed and why what was skipped was, and keeps the counts.

passed=0 failed=0 skipped=0

# count_step STATUS: a step without tests of its own (a build, the formatter) counts as one.
count_step() {
  if [ "$1" -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
  return "$1"
}

# run_ctest PRESET CTEST_OPTIONS...: quiet while green; adds to the counts; non-zero where a test failed.
run_ctest() {
  local dir=$ORCART_ROOT/build/$1 status=0 all not_run bad
  local log=$ORCART_ROOT/build/$1-ctest.log results=$ORCART_ROOT/build/$1-ctest.xml
  shift
  rm -f "$results"
  ctest --test-dir "$dir" -j "$(jobs_here)" --output-on-failure --no-tests=error --output-junit "$results" "$@" \
    >"$log" 2>&1 || status=$?
  all=$(junit_count tests "$results") bad=$(junit_count failures "$results")
  not_run=$(($(junit_count skipped "$results") + $(junit_count disabled "$results")))
  if [ "$status" -ne 0 ]; then
    grep -vE '  (Passed|\*\*\*Skipped) |^ *Start +[0-9]+:|^$' "$log" | tail -n 200
    [ "$bad" -gt 0 ] || bad=1 all=$((all + 1))
  fi
  say "$all tests, $bad failed, $not_run skipped"
  skip_reasons "$dir/Testing/Temporary/LastTest.log"
  passed=$((passed + all - bad - not_run)) failed=$((failed + bad)) skipped=$((skipped + not_run))
  [ "$status" -eq 0 ]
}

junit_count() {
  local value
  value=$(sed -n "0,/^[[:space:]]*$1=\"/s/^[[:space:]]*$1=\"\([0-9]*\)\".*/\1/p" "$2" 2>/dev/null)
  echo "${value:-0}"
}

# A skipped GoogleTest prints "FILE:LINE: Skipped" and then its reason.
skip_reasons() {
  awk 'skipped && NF { print; skipped = 0 } /: Skipped$/ { skipped = 1 }' "$1" | sort | uniq -c |
    sed 's/^ *\([0-9]*\) /  skipped \1: /'
}
