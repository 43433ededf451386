# Shell helper of tools/check: clang-format over every source, clang-tidy over as many as its time allows.

our_sources() {
  (cd "$ORCART_ROOT" && find realtime board render firmware-host tools tests -name '*.[ch]pp' -o -name '*.h' | sort)
}

check_format() {
  local said unformatted status=0
  said=$(cd "$ORCART_ROOT" && our_sources | xargs clang-format --dry-run --Werror 2>&1) || status=$?
  unformatted=$(sed -n 's/^\([^ :]*\):[0-9]*:[0-9]*: error: .*/\1/p' <<<"$said" | sort -u)
  # shellcheck disable=SC2086  # one word a file
  [ -z "$unformatted" ] || { say "run clang-format -i on:" $unformatted && return 1; }
  [ "$status" -eq 0 ] || { say "clang-format did not look at every source: $(tail -n 1 <<<"$said")" && return 1; }
}

# check_tidy SECONDS: the sources changed last come first, so that what is new is always looked at.
check_tidy() {
  local all count began=$SECONDS seen=$ORCART_ROOT/build/tidy-seen status=0
  all=$(tidy_order)
  count=$(wc -l <<<"$all")
  : >"$seen"
  export -f tidy_one
  ORCART_ROOT=$ORCART_ROOT TIDY_SEEN=$seen TIDY_UNTIL=$(($(date +%s) + $1)) \
    xargs -P "$(jobs_here)" -n 1 bash -c 'tidy_one "$0"' <<<"$all" || status=$?
  say "clang-tidy read $(wc -l <"$seen") of $count sources in $((SECONDS - began)) s"
  [ "$status" -eq 0 ]
}

# Not for clang 14, which has no std::source_location with GCC's library and refuses Relacy's templates.
not_for_clang=tools/latency/channel_model.cpp

# The sources the dev build compiles, latest change first.
tidy_order() {
  local compiled
  compiled=$(sed -n "s|^ *\"file\": \"$ORCART_ROOT/\(.*\)\".*|\1|p" "$ORCART_ROOT/build/dev/compile_commands.json" | grep -vxF "$not_for_clang" | sort -u)
  {
    git -C "$ORCART_ROOT" diff --name-only HEAD 2>/dev/null
    git -C "$ORCART_ROOT" log -n 100 --name-only --format= 2>/dev/null
    printf '%s\n' "$compiled"
  } | awk -v compiled="$compiled" '
    BEGIN { split(compiled, list, "\n"); for (i in list) known[list[i]] = 1 }
    known[$0] && !seen[$0]++'
}

# The analyser walks every path through GoogleTest's macros and finds nothing there: tests go without it.
tidy_one() {
  local found options=()
  [ "$(date +%s)" -lt "$TIDY_UNTIL" ] || return 0
  [[ $1 != tests/* ]] || options=(--checks='-clang-analyzer-*')
  echo "$1" >>"$TIDY_SEEN"
  found=$(cd "$ORCART_ROOT" && clang-tidy -p build/dev --quiet "${options[@]}" "$1" 2>/dev/null) || {
    printf '%s\n' "$found"
    return 1
  }
}
