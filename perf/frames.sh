#!/usr/bin/env bash
# Measures whole frames against their budget and rewrites perf/results/<processor>_frames.csv, perf/frames.png and the table of frames
# in perf/README.md; then what a crowd under a budget is truly off and what gaps in simulation leave, and rewrites
# perf/results/<processor>_crowd_error.csv, _gaps.csv and these tables.
# About eleven minutes on quiet cores; FRAMES=600 for a short look (its tails say little). --crowd: only the latter; two minutes with
# SINEW_CHARACTER, a pack of the crowd's creature that sinew-trade wrote. FRAMES=5900 has 100,000 frames without Embree, too.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_frames perf_gaps sinew-bake sinew-trade
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
character=${SINEW_CHARACTER:-$(perf/traded_creature.sh "$measured")}
if [ "${1:-}" != --crowd ]; then
  build/release/bin/perf_frames "$character" --frames "${FRAMES:-5300}" >"$measured/frames.csv"
  python=python3
  "$python" -c 'import matplotlib' 2>/dev/null || python=/usr/bin/python3
  "$python" perf/summarise_frames.py "$measured/frames.csv"
fi

# Five seconds of each of the creature's clips.
build/release/bin/sinew-bake creature assets/creature/creature.json -o "$measured/truth.glb"
truths=("$measured"/{idle,walk,hop,shake}.safetensors)
printf '%s\n' "${truths[@]}" | xargs -P "$(nproc)" -I{} sh -c 'build/release/bin/sinew-bake truth "$1" \
  --recipe assets/creature/tissue_crowd.json --motion "clip:$(basename "$2" .safetensors)" --seconds 5 --positions -o "$2" >/dev/null' \
  sh "$measured/truth.glb" {}
build/release/bin/perf_frames "$character" --crowd "${truths[@]}" >"$measured/crowd_error.csv"
python3 perf/summarise_table.py crowd_error "$measured/crowd_error.csv"
build/release/bin/perf_gaps "$character" "${truths[@]}" >"$measured/gaps.csv"
python3 perf/summarise_table.py gaps "$measured/gaps.csv"
