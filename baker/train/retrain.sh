#!/bin/sh
# retrain.sh  Makes weights as the shipped ones were made: bodies, data set, two networks, the better one judged and exported.
#
#   baker/train/retrain.sh [BUILD_DIR] [WORK_DIR]
#
# BUILD_DIR holds bin/sinew-bake (default: build/release). WORK_DIR takes the data set and the runs (default: BUILD_DIR/train);
# a second call goes on where the first was cut. In the environment, if wanted: MINUTES (20) a network, SEEDS ("0 1"), PROCESSES (2),
# GENERATE and TRAIN (further options of those commands), OUT (assets/weights) and PYTHON (/usr/bin/python3).
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build/release}
work=${2:-$build/train}
python=${PYTHON:-/usr/bin/python3}
minutes=${MINUTES:-20}
seeds=${SEEDS:-"0 1"}
out=${OUT:-$root/assets/weights}
bake=$build/bin/sinew-bake

[ -x "$bake" ] || { echo "retrain.sh: no $bake; build the project first, or name its build folder" >&2; exit 2; }
"$python" -c 'import torch' 2>/dev/null || { echo "retrain.sh: $python has no PyTorch; apt-get install python3-torch" >&2; exit 2; }

mkdir -p "$work"
"$python" "$root/baker/train" generate --plan "$root/assets/bodies/plan.json" --bake "$bake" --out "$work/data" --processes "${PROCESSES:-2}" ${GENERATE:-}

runs=
for seed in $seeds; do
  "$python" "$root/baker/train" train "$work/data" --out "$work/run$seed" --seed "$seed" --minutes "$minutes" --device auto ${TRAIN:-} \
    > "$work/run$seed.log" 2>&1 &
  runs="$runs $work/run$seed"
  pids="${pids:-} $!"
done
for pid in $pids; do
  wait "$pid" || { tail -n 3 "$work"/run*.log >&2; exit 2; }
done

best=$("$python" "$root/baker/train" best $runs)
"$python" "$root/baker/train" evaluate "$work/data" --run "$best"
"$python" "$root/baker/train" export "$work/data" --run "$best" --out "$out" --name creature
"$bake" check "$out/creature.safetensors" "$out/creature.vectors.safetensors" --tolerance 1e-4
