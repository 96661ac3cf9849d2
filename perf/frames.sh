#!/usr/bin/env bash
# Measures frames of crowds against their budget, a crowd's error against ground truth, and the error after gaps in simulation. Rewrites
# perf/reports/frames.csv, frames.png, crowd_error.csv and gaps.csv and their tables in perf/README.md. About eleven minutes on quiet cores.
# --crowd: only the crowd's error and the gaps; two minutes if SINEW_CHARACTER names a pack of the crowd's creature that sinew-trade wrote.
# FRAMES=600 measures fewer frames a scene.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_frames perf_gaps sinew-bake sinew-trade
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
character=${SINEW_CHARACTER:-$(perf/traded_creature.sh "$measured")}
python=${PYTHON:-/usr/bin/python3}
if [ "${1:-}" != --crowd ]; then
  build/release/bin/perf_frames "$character" --frames "${FRAMES:-5300}" >"$measured/frames.csv"
  "$python" perf/summarise.py perf/frames.sh frames="$measured/frames.csv"
fi

# Five seconds of each of the creature's clips.
build/release/bin/sinew-bake creature assets/creature/creature.json -o "$measured/truth.glb"
truths=("$measured"/{idle,walk,hop,shake}.safetensors)
printf '%s\n' "${truths[@]}" | xargs -P "$(nproc)" -I{} sh -c 'build/release/bin/sinew-bake truth "$1" \
  --recipe assets/creature/tissue_crowd.json --motion "clip:$(basename "$2" .safetensors)" --seconds 5 --positions -o "$2" >/dev/null' \
  sh "$measured/truth.glb" {}
build/release/bin/perf_frames "$character" --crowd "${truths[@]}" >"$measured/crowd_error.csv"
build/release/bin/perf_gaps "$character" "${truths[@]}" >"$measured/gaps.csv"
"$python" perf/summarise.py "perf/frames.sh --crowd" crowd_error="$measured/crowd_error.csv" gaps="$measured/gaps.csv"
