#!/usr/bin/env bash
# Bakes the creature, where what is there is older than what it is baked from.
# usage: bake_creature.sh SINEW_BAKE FOLDER RECIPE...   recipes by their names in assets/creature: tissue tissue_rods tissue_touch
set -euo pipefail
bake=$1 folder=$2
assets=$(cd "$(dirname "$0")/.." && pwd)/assets
creature=$assets/creature/creature.json
weights=$assets/weights/creature.safetensors
mkdir -p "$folder"

. "$(dirname "$0")/newer.sh"

newer "$folder/creature.glb" "$bake" "$creature" || "$bake" creature "$creature" -o "$folder/creature.glb"
for name in "${@:3}"; do
  recipe=$assets/creature/$name.json
  pack=$folder/creature${name#tissue}.sinew
  newer "$pack" "$folder/creature.glb" "$recipe" "$weights" ||
    "$bake" character "$folder/creature.glb" --recipe "$recipe" --tissue "$weights" -o "$pack"
done
