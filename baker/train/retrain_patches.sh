#!/bin/sh
# retrain_patches.sh  Makes the shipped weights of DeepEmulators: data sets, networks, judgement, export.
#
#   baker/train/retrain_patches.sh [BUILD_DIR] [WORK_DIR]
#
# BUILD_DIR holds bin/sinew-bake (default: build/release). WORK_DIR takes data sets and runs (default: BUILD_DIR/train_patches).
# In the environment, if wanted: NETWORKS (name=plan,latent:minutes ..., of one core), OUT (assets/weights), PAGE (assets/patches)
# and PYTHON (/usr/bin/python3).
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build/release}
work=${2:-$build/train_patches}
python=${PYTHON:-/usr/bin/python3}
out=${OUT:-$root/assets/weights}
page=${PAGE:-$root/assets/patches}
networks=${NETWORKS:-emulator=bodies,16:8 emulator_paper=paper,64:13}
bake=$build/bin/sinew-bake

[ -x "$bake" ] || { echo "retrain_patches.sh: no $bake; build the project first, or name its build folder" >&2; exit 2; }
"$python" -c 'import torch' 2>/dev/null || { echo "retrain_patches.sh: $python has no PyTorch; apt-get install python3-torch" >&2; exit 2; }
trainer() { "$python" "$root/baker/train" "$@"; }

mkdir -p "$work"
for network in $networks; do
  name=${network%=*} sizes=${network#*=} minutes=${network##*:}
  sizes=${sizes%:*}
  plan=${sizes%,*} latent=${sizes#*,}
  "$bake" patch-data --plan "$root/assets/patches/$plan.json" --explicit -o "$work/$plan"
  trainer train-patches "$work/$plan" --out "$work/$name" --latent "$latent" --minutes "$minutes" > "$work/$name.log"
  trainer export-patches "$work/$plan" --run "$work/$name" --out "$out" --name "$name" --page "$page"
  "$bake" check "$out/$name.safetensors" "$out/$name.vectors.safetensors" --tolerance 1e-4
done
