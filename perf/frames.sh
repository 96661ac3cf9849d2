#!/usr/bin/env bash
# Measures whole frames against their budget and rewrites perf/results/<processor>_frames.csv, perf/frames.png and the table of frames
# in perf/README.md. About eight minutes on quiet cores; FRAMES=600 for a short look (its tails say little).
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release -DSINEW_BUILD_PERF=ON | grep "^-- perf:" || true
cmake --build --preset release --target perf_frames sinew-bake sinew-trade
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
character=${SINEW_CHARACTER:-$(perf/traded_creature.sh "$measured")}
build/release/bin/perf_frames "$character" --frames "${FRAMES:-5300}" >"$measured/frames.csv"
python=python3
"$python" -c 'import matplotlib' 2>/dev/null || python=/usr/bin/python3
"$python" perf/summarise_frames.py "$measured/frames.csv"
