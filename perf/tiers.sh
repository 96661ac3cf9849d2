#!/usr/bin/env bash
# Measures every tier of the creature against ground truth and rewrites perf/results/<processor>_tiers.csv, perf/trade/tiers.png, .svg and
# the table of perf/trade/README.md. Under ten minutes on two quiet cores; a run that was stopped goes on where it was, by what it has left
# in build/release/tiers. --again begins anew.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release >/dev/null
cmake --build --preset release --target sinew-trade sinew-bake | { grep -v '^ninja: no work' || true; }
out=build/release/tiers
[ "${1:-}" != --again ] || rm -rf "$out"
mkdir -p "$out"
recipe=assets/creature/tissue.json weights=assets/weights
[ -e "$out/creature.sinew" ] || {
  build/release/bin/sinew-bake creature assets/creature/creature.json -o "$out/creature.glb"
  build/release/bin/sinew-bake character "$out/creature.glb" --recipe $recipe --tissue $weights/creature.safetensors \
    -o "$out/creature.sinew" >/dev/null
}
# The hop is held out of all training (assets/bodies/plan.json).
build/release/bin/sinew-trade "$out/creature.sinew" --recipe $recipe --tissue $weights/creature.safetensors \
  --clip hop -o "$out/trade"
python=python3
"$python" -c 'import matplotlib' 2>/dev/null || python=/usr/bin/python3
"$python" perf/summarise_tiers.py "$out/trade"
