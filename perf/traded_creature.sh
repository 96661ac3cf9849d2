#!/usr/bin/env bash
# Bakes the crowd's creature with its tiers measured along all of its clips into the folder $1, and prints the pack's path.
# $2: seconds of each clip; 5 by default.
set -euo pipefail
cd "$(dirname "$0")/.."

recipe=assets/creature/tissue_crowd.json tissue=assets/weights/creature.safetensors
build/release/bin/sinew-bake creature assets/creature/creature.json -o "$1/creature.glb" >&2
build/release/bin/sinew-bake character "$1/creature.glb" --recipe $recipe --tissue $tissue -o "$1/creature.sinew" >/dev/null
build/release/bin/sinew-trade "$1/creature.sinew" --recipe $recipe --tissue $tissue --seconds "${2:-5}" -o "$1/trade" >/dev/null
echo "$1/trade/creature.sinew"
