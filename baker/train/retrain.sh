#!/bin/sh
# retrain.sh  Makes the shipped weights: data set, network, the evaluation page, export.
#
#   baker/train/retrain.sh [BUILD_DIR] [WORK_DIR]
#
# BUILD_DIR holds bin/sinew-bake (default: build/release). WORK_DIR takes the data set and the runs (default: BUILD_DIR/train);
# a second call goes on where the first was cut. In the environment, if wanted: MINUTES (14) of one core a network, SEEDS (0; the one that
# validates best is kept), PROCESSES (2), PLAN (assets/bodies/plan.json), GENERATE and TRAIN (further options of those commands), OUT (assets) and PYTHON (/usr/bin/python3).
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build/release}
work=${2:-$build/train}
python=${PYTHON:-/usr/bin/python3}
out=${OUT:-$root/assets}
bake=$build/bin/sinew-bake

[ -x "$bake" ] || { echo "retrain.sh: no $bake; build the project first, or name its build folder" >&2; exit 2; }
"$python" -c 'import torch' 2>/dev/null || { echo "retrain.sh: $python has no PyTorch; apt-get install python3-torch" >&2; exit 2; }

trainer() { "$python" "$root/baker/train" "$@"; }
simulate() { trainer generate --bake "$bake" --plan "${PLAN:-$root/assets/bodies/plan.json}" --out "$work/data" ${GENERATE:-} "$@"; }

mkdir -p "$work"
simulate --processes "${PROCESSES:-2}" --splits train validation
simulate --processes 1 > "$work/generate.log" 2>&1 &   # what judging needs, while training runs
pids=$!
set --
for seed in ${SEEDS:-0}; do
  trainer train "$work/data" --out "$work/run$seed" --seed "$seed" --minutes "${MINUTES:-14}" --device auto ${TRAIN:-} > "$work/run$seed.log" 2>&1 &
  pids="$pids $!"
  set -- "$@" "$work/run$seed"
done
for pid in $pids; do
  wait "$pid" || { tail -n 3 "$work"/*.log >&2; kill $pids 2>/dev/null || :; exit 2; }
done

best=$(trainer best "$@")
trainer evaluate "$work/data" --run network="$best" --out "$out/evaluation"
trainer export "$work/data" --run "$best" --page "$out/evaluation" --model network --body momo --out "$out/weights" --name creature
"$bake" check "$out/weights/creature.safetensors" "$out/weights/creature.vectors.safetensors" --tolerance 1e-4
