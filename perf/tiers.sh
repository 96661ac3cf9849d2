#!/usr/bin/env bash
# Measures every tier of the creature against ground truth. Rewrites perf/reports/tiers.csv, tiers.png and tiers.svg and the table of
# perf/trade/README.md. About three minutes on two quiet cores; a stopped run resumes from build/release/tiers. --again starts over.
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
"${PYTHON:-/usr/bin/python3}" perf/summarise.py perf/tiers.sh tiers="$out/trade/trade.csv"
cp "$out/trade/trade.png" perf/reports/tiers.png
cp "$out/trade/trade.svg" perf/reports/tiers.svg
