#!/usr/bin/env bash
# Measures how far changes of tier move the creature's surface, and rewrites the table of jumps in perf/README.md. Twenty minutes; with
# SINEW_CHARACTER, a pack that sinew-trade wrote, fifteen.
# --quick: what to look at before and after a change of transitions, three minutes: along idle, walk and hop, with fewer moments of
# change; prints the table and writes nothing but build/release/quick_character.sinew, which it bakes where the baker is newer.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_jumps sinew-bake sinew-trade
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
if [ "${1:-}" = --quick ]; then
  quick=build/release/quick_character.sinew
  if [ -z "${SINEW_CHARACTER:-}" ] && ! [ "$quick" -nt build/release/bin/sinew-bake ]; then
    cp "$(perf/traded_creature.sh "$measured" 1)" "$quick.new"
    mv "$quick.new" "$quick"
  fi
  character=${SINEW_CHARACTER:-$quick}
  build/release/bin/perf_jumps "$character" --quick >"$measured/jumps.csv"
  python3 perf/summarise_jumps.py --print "$measured/jumps.csv"
  exit
fi
character=${SINEW_CHARACTER:-$(perf/traded_creature.sh "$measured")}
build/release/bin/perf_jumps "$character" >"$measured/jumps.csv"
python3 perf/summarise_jumps.py "$measured/jumps.csv"
