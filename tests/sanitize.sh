#!/usr/bin/env bash
# Builds with sanitizers and with clang and runs the fast tests under the former, one after the other; what came of it goes to tests/sanitize.txt.
# usage: tests/sanitize.sh [PRESET[:ROOM,ROOM...] ...]: asan-ubsan tsan clang, an hour on two cores from nothing; tsan:core,world builds and
# runs the tests of those rooms alone (of clang: builds them), and the result says so
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- asan-ubsan tsan clang

# What cannot run there, as tests' names; the reason stands behind it and goes into the result.
callers="their programs are built without the sanitizer that the shared library then needs first"
left_out_asan_ubsan=("c/(tcc|python|node)_reads_the_same_numbers_as_cpp: $callers"
  "world/a_part_that_is_off_fades_costs_no_tick_and_comes_back_from_rest: it asks for less than a microsecond")
left_out_tsan=("${left_out_asan_ubsan[@]}")

export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1

names() { for line in "$@"; do echo "${line%%: *}"; done | paste -sd '|'; }

run() {  # preset, rooms; prints its lines of the result
  local -n left_out=left_out_${1//-/_}
  local log=build/$1/sanitize.log arguments=(-L fast) status=0 which=
  [ -z "$2" ] || arguments+=(-R "^(${2//,/|})/")
  [ -z "$2" ] || which=" of the rooms $2"
  [ ${#left_out[@]} -eq 0 ] || arguments+=(-E "$(names "${left_out[@]}")")
  ctest --test-dir "build/$1" -j "$(nproc)" --timeout 300 --output-on-failure "${arguments[@]}" >"$log" 2>&1 || status=1
  local passed skipped failed
  passed=$(grep -cE '^ *[0-9]+/[0-9]+ Test .* Passed ' "$log" || true)
  skipped=$(grep -cE '^ *[0-9]+/[0-9]+ Test .*\*\*\*Skipped' "$log" || true)
  failed=$(grep -cE '^ *[0-9]+/[0-9]+ Test .*\*\*\*(Failed|Timeout|Exception|Not Run)' "$log" || true)
  echo "- $1, $(compiler_of "$1"): $((passed + skipped + failed)) fast tests$which run, $passed passed, $skipped skipped for want of something on the machine, $failed failed."
  grep -E '^ *[0-9]+/[0-9]+ Test .*\*\*\*(Failed|Timeout|Exception|Not Run)' "$log" | sed -E 's/.*: ([^ ]+) .*\*\*\*([A-Za-z]+).*/  - failed: `\1` (\2)/' || true
  for line in "${left_out[@]}"; do echo "  - left out: \`${line%%: *}\`: ${line#*: }"; done
  return $status
}

compiler_of() { "$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "build/$1/CMakeCache.txt")" --version | head -n 1; }

status=0
for wanted in "$@"; do
  preset=${wanted%%:*} rooms=
  [ "$preset" = "$wanted" ] || rooms=${wanted#*:}
  scripts/install_packages.sh "$preset"
  cmake --preset "$preset" >/dev/null
  targets=(all)
  [ -z "$rooms" ] || IFS=, read -ra targets <<<"test_${rooms//,/,test_}"
  cmake --build "build/$preset" -j "$(nproc)" --target "${targets[@]}"
  row=build/$preset/sanitize_row.md
  case $preset in
    clang) echo "- clang, $(compiler_of clang): ${rooms:-all} built with warnings as errors, and there is none." >"$row" ;;
    *) run "$preset" "$rooms" >"$row" || status=1 ;;
  esac
  cat "$row"
done

{
  echo "# Sanitizers"
  echo
  echo "Written by \`tests/sanitize.sh\` at $(git describe --always --dirty)."
  echo
  for preset in asan-ubsan tsan clang; do cat "build/$preset/sanitize_row.md" 2>/dev/null || echo "- $preset: not run."; done
} >tests/sanitize.txt
exit $status
