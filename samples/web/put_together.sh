#!/usr/bin/env bash
# Builds the engine and puts the page's folder together.
# usage: put_together.sh BUILD FOLDER PACKS   PACKS: of bake_creature.sh: creature.glb, creature_crowd.sinew, creature_rods.sinew, creature_touch.sinew
set -euo pipefail
build=$1 folder=$2 packs=$3
source=$(cd "$(dirname "$0")/../.." && pwd)

cmake --preset web -S "$source" -B "$build" >/dev/null
cmake --build "$build" --target sinew-web | { grep -v '^ninja: no work' || true; }
mkdir -p "$build/npm" "$folder/characters" "$folder/three/addons/"{controls,loaders,utils}
cp "$source/samples/web/package.json" "$build/npm/"
(cd "$build/npm" && npm install --no-package-lock --no-audit --no-fund --prefer-offline --silent)
cp "$source"/samples/web/page/* "$build/bin/sinew.wasm" "$folder/"
three=$build/npm/node_modules/three
cp "$three"/build/three.{module,core}.min.js "$three/LICENSE" "$folder/three/"
for file in controls/OrbitControls loaders/GLTFLoader utils/BufferGeometryUtils; do
  cp "$three/examples/jsm/$file.js" "$folder/three/addons/$file.js"
done
cp "$packs"/creature{.glb,_rods.sinew,_touch.sinew} "$folder/characters/"
cp "$packs/creature_crowd.sinew" "$folder/characters/creature.sinew"  # the same creature, and coarser control graphs for crowds
