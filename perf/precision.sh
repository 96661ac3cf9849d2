#!/usr/bin/env bash
# Bakes a body's character in every precision, int8 by scales from its validation motions, and judges each against ground truth on
# its test motions, in closed loop: how much fp16 and int8 add to the float32 network's error.
#   perf/precision.sh [DATA]
# DATA takes the true motions (default build/release/precision); they are simulated where they are not there, some three minutes.
# In the environment, if wanted: PLAN (assets/bodies/precision.json: the creature's own), BODY (momo), WEIGHTS (the shipped networks)
# and PYTHON (/usr/bin/python3).
set -euo pipefail
shopt -s nullglob
cd "$(dirname "$0")/.."

cmake --preset release >/dev/null
cmake --build --preset release --target sinew-bake | { grep -v '^ninja: no work' || true; }
bake=build/release/bin/sinew-bake
data=${1:-build/release/precision}
body=$data/${BODY:-momo}
"${PYTHON:-/usr/bin/python3}" baker/train generate --bake "$bake" --plan "${PLAN:-assets/bodies/precision.json}" --out "$data" \
  --splits validation test long >/dev/null

packs=$(mktemp -d)
trap 'rm -rf "$packs"' EXIT
bake_as() {  # NAME PRECISION [--calibrate ...]
  "$bake" character "$body/body.glb" --recipe "$body/tissue.json" --tissue "$weights" --keep-network --precision "$2" "${@:3}" \
    -o "$packs/$name.$1.sinew" >/dev/null
}
worst=0
for weights in ${WEIGHTS:-assets/weights/creature.safetensors}; do
  name=$(basename "$weights" .safetensors)
  for precision in fp32 fp16 int8; do
    calibrate=()
    [ $precision = int8 ] && for motion in "$body"/validation-*.safetensors; do calibrate+=(--calibrate "$motion"); done
    bake_as $precision $precision "${calibrate[@]}"
  done
  bake_as int8_by_vectors int8
  echo "$weights"
  "$bake" judge "$packs/$name".{fp32,fp16,int8,int8_by_vectors}.sinew --truth "$body"/{test,long}-*.safetensors \
    --ticks 10 50 100 200 600 --most-added 0.1 || worst=$?
done
exit $worst
