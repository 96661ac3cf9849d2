#!/bin/sh
# retrain_rods.sh  Makes the shipped weights of rods' starts: data set, networks, export.
#
#   baker/train/retrain_rods.sh [BUILD_DIR] [WORK_DIR]
#
# BUILD_DIR holds bin/sinew-bake (default: build/release). WORK_DIR takes the data set and the runs (default: BUILD_DIR/train_rods).
# In the environment, if wanted: NETWORKS (name=latent,blocks,depth:minutes ..., of one core), PLAN (assets/rods/plan.json),
# OUT (assets/weights) and PYTHON (/usr/bin/python3).
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build/release}
work=${2:-$build/train_rods}
python=${PYTHON:-/usr/bin/python3}
out=${OUT:-$root/assets/weights}
networks=${NETWORKS:-coping_8=8,1,1:1.7 coping_16=16,2,1:2.3 coping_32=32,3,1:4}
bake=$build/bin/sinew-bake

[ -x "$bake" ] || { echo "retrain_rods.sh: no $bake; build the project first, or name its build folder" >&2; exit 2; }
"$python" -c 'import torch' 2>/dev/null || { echo "retrain_rods.sh: $python has no PyTorch; apt-get install python3-torch" >&2; exit 2; }
trainer() { "$python" "$root/baker/train" "$@"; }

mkdir -p "$work"
"$bake" rod-data --plan "${PLAN:-$root/assets/rods/plan.json}" -o "$work/data"
for network in $networks; do
  name=${network%=*} sizes=${network#*=} minutes=${network##*:}
  sizes=${sizes%:*}
  latent=${sizes%%,*} depth=${sizes##*,} blocks=${sizes#*,}
  trainer train-rods "$work/data" --out "$work/$name" --latent "$latent" --blocks "${blocks%,*}" --depth "$depth" --minutes "$minutes" > "$work/$name.log"
  trainer export-rods "$work/data" --run "$work/$name" --out "$out" --name "$name"
  "$bake" check "$out/$name.safetensors" "$out/$name.vectors.safetensors" --tolerance 1e-5
done
trainer export-rods "$work/data" --examples 512 --out "$out" --name coping_examples
