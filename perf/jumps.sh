#!/usr/bin/env bash
# Measures the visible jump of changes of tier on the creature's surface and rewrites perf/reports/jumps.csv and its table in
# perf/README.md. Sixteen minutes; thirteen if SINEW_CHARACTER names a pack that sinew-trade wrote.
# --quick prints the table for idle, walk and hop with fewer changes and writes nothing but build/release/quick_character.sinew, which it
# bakes if the baker is newer. Three minutes; for a comparison before and after an edit of the transitions.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_jumps sinew-bake sinew-trade
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
quick=() print=()
if [ "${1:-}" = --quick ]; then
  quick=(--quick) print=(--print)
  pack=build/release/quick_character.sinew
  if [ -z "${SINEW_CHARACTER:-}" ] && ! [ "$pack" -nt build/release/bin/sinew-bake ]; then
    cp "$(perf/traded_creature.sh "$measured" 1)" "$pack.new"
    mv "$pack.new" "$pack"
  fi
  character=${SINEW_CHARACTER:-$pack}
else
  character=${SINEW_CHARACTER:-$(perf/traded_creature.sh "$measured")}
fi
build/release/bin/perf_jumps "$character" "${quick[@]}" >"$measured/jumps.csv"
"${PYTHON:-/usr/bin/python3}" perf/summarise.py "${print[@]}" perf/jumps.sh jumps="$measured/jumps.csv"
