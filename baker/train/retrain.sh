#!/bin/sh
# retrain.sh  Makes the shipped weights: data set, networks, the evaluation page, export.
#
#   baker/train/retrain.sh [BUILD_DIR] [WORK_DIR]
#
# BUILD_DIR holds bin/sinew-bake (default: build/release). WORK_DIR takes the data set and the runs (default: BUILD_DIR/train);
# a second call goes on where the first was cut. In the environment, if wanted: NETWORKS (name=channels:minutes ..., of one core),
# SEEDS (0; of each network the one that validates best is kept), PROCESSES (2), PLAN (assets/bodies/plan.json),
# GENERATE and TRAIN (further options of those commands), OUT (assets) and PYTHON (/usr/bin/python3).
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build/release}
work=${2:-$build/train}
python=${PYTHON:-/usr/bin/python3}
out=${OUT:-$root/assets}
networks=${NETWORKS:-creature=8,3:27}
bake=$build/bin/sinew-bake

[ -x "$bake" ] || { echo "retrain.sh: no $bake; build the project first, or name its build folder" >&2; exit 2; }
"$python" -c 'import torch' 2>/dev/null || { echo "retrain.sh: $python has no PyTorch; apt-get install python3-torch" >&2; exit 2; }

began=$(date +%s)
done_with() { echo "retrain.sh: after $((($(date +%s) - began) / 60)) min: $*"; }
trainer() { "$python" "$root/baker/train" "$@"; }
set -- generate --bake "$bake" --plan "${PLAN:-$root/assets/bodies/plan.json}" --out "$work/data" ${GENERATE:-}

mkdir -p "$work"
trainer "$@" --processes "${PROCESSES:-2}" --splits train validation
done_with "data to train on"
# What judging needs, behind the training. Not by trainer(): $! of a function is a shell's, which dies alone.
nice -n 15 "$python" "$root/baker/train" "$@" --processes 1 > "$work/generate.log" 2>&1 &
judged=$!
pids=
trap 'kill $pids $judged 2>/dev/null || :; exit 2' INT TERM
for network in $networks; do
  for seed in ${SEEDS:-0}; do
    run=${network%=*}.$seed channels=${network#*=} minutes=${network##*:}
    "$python" "$root/baker/train" train "$work/data" --out "$work/$run" --channels "${channels%:*}" --seed "$seed" --minutes "$minutes" --device auto ${TRAIN:-} \
      > "$work/$run.log" 2>&1 &
    pids="$pids $!"
  done
done
wait_for() { wait "$1" || { tail -n 3 "$work"/*.log >&2; kill $pids "$judged" 2>/dev/null || :; exit 2; }; }
for pid in $pids; do wait_for "$pid"; done
done_with "networks trained"
wait_for "$judged"
done_with "data to judge by"

# Of the seeds of this call.
best_of() { set -- "$1" ""; for seed in ${SEEDS:-0}; do set -- "$1" "$2 $work/$1.$seed"; done; trainer best $2; }

set --
names=
for network in $networks; do
  name=${network%=*}
  names="$names $name"
  best=$(best_of "$name")
  set -- "$@" --run "$name=$best"
done
trainer evaluate "$work/data" "$@" --enduring $names --out "$out/evaluation"
for name in $names; do
  best=$(best_of "$name")
  trainer export "$work/data" --run "$best" --page "$out/evaluation" --model "$name" --body momo --out "$out/weights" --name "$name"
  "$bake" check "$out/weights/$name.safetensors" "$out/weights/$name.vectors.safetensors" --tolerance 1e-4
done
done_with "networks judged and exported"
