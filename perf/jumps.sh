#!/usr/bin/env bash
# Measures how far changes of tier move the creature's surface, and rewrites the table of jumps in perf/README.md. Twenty minutes; with
# SINEW_CHARACTER, a pack that sinew-trade wrote, fifteen.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_jumps sinew-bake sinew-trade
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
character=${SINEW_CHARACTER:-$(perf/traded_creature.sh "$measured")}
build/release/bin/perf_jumps "$character" --rates >"$measured/jumps.csv"
python3 perf/summarise_jumps.py "$measured/jumps.csv"
