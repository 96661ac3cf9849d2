#!/usr/bin/env bash
# Feeds what reads bytes from outside with millions of damaged files, under sanitizers, and writes what came of it to tests/fuzz/report.txt.
# usage: tests/fuzz.sh [EXECUTIONS | SECONDSs] [TARGET...]: so many of each (2000000), or as many as go into so many seconds: tests/fuzz.sh 600s pack
# What is found lies in build/fuzz/findings: build/fuzz/bin/fuzz_TARGET FILE shows it again. What a run learns, the next begins with. With
# SINEW_FUZZ_LET_PASS=1 packs that load and of which something read is not finite are counted only, and what is worse is looked for.
set -euo pipefail
cd "$(dirname "$0")/.."
amount=${1:-2000000}
[ $# -eq 0 ] || shift
all=(pack snapshot safetensors recipe gltf)
# Bytes of a file at most: those of the largest seed that counts.
declare -A most=([pack]=81920 [snapshot]=32768 [safetensors]=16384 [recipe]=16384 [gltf]=40960)
[ $# -gt 0 ] || set -- "${all[@]}"
case $amount in
  *s) limit="-max_total_time=${amount%s}" ;;
  *) limit="-runs=$amount" ;;
esac

scripts/install_packages.sh fuzz
cmake --preset fuzz >/dev/null
cmake --build build/fuzz --target fuzz_seeds "${@/#/fuzz_}"
out=build/fuzz
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1 ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1
if [ ! "$out/seeds" -nt "$out/bin/fuzz_seeds" ]; then
  rm -rf "$out/seeds" "$out/seeds.part"
  "$out/bin/fuzz_seeds" "$out/seeds.part"
  mv "$out/seeds.part" "$out/seeds"
  touch "$out/seeds"
fi
mkdir -p "$out/findings" "$out/rows"
status=0
for target in "$@"; do
  corpus=$out/corpus/$target log=$out/$target.log
  mkdir -p "$corpus"
  rm -f "$out/findings/$target"-*
  begin=$SECONDS
  "$out/bin/fuzz_$target" "$limit" -max_len="${most[$target]}" -entropic=0 -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 -verbosity=1 \
    -artifact_prefix="$out/findings/$target-" "$corpus" "$out/seeds/$target" >"$log" 2>&1 || status=1
  findings=$(find "$out/findings" -name "$target-*" | wc -l)
  [ "$findings" -eq 0 ] || grep -m 3 -E 'ERROR|runtime error|SUMMARY|not finite' "$log" || true
  passed=$(sed -n 's/^not finite: //p' "$log")
  [ -z "$passed" ] || findings="$findings, $passed packs let pass of which something read is not finite"
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  coverage=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
  printf '| %s | %s | %s | %s | %s |\n' "$target" "${runs:-?}" "$findings" "${coverage:-?}" "$((SECONDS - begin))" | tee "$out/rows/$target"
done

{
  echo "# Fuzzing"
  echo
  echo "Written by \`tests/fuzz.sh\`, each row by the last run of its target with $(clang++-14 --version | head -n 1), under AddressSanitizer and"
  echo "UndefinedBehaviorSanitizer, kernels included. Checksums are taken as right. A finding is a crash, undefined behaviour, a leak, more than 20 s or"
  echo "2 GiB, or what the target's first line forbids. Coverage counts edges."
  echo
  echo "| target | executions | findings | coverage | seconds |"
  echo "|---|--:|--:|--:|--:|"
  for target in "${all[@]}"; do cat "$out/rows/$target" 2>/dev/null || echo "| $target | not run | | | |"; done
} >tests/fuzz/report.txt
exit $status
