#!/usr/bin/env bash
# put_together.sh SINEW_BAKE WASM_BUILD FOLDER: the page of the sources as they are, in FOLDER/page, and what tests it, in FOLDER/npm.
# Exits with 77, skipped, where npm's registry is not to be had.
set -euo pipefail
bake=$1 build=$2 folder=$3
here=$(cd "$(dirname "$0")" && pwd)
samples=$here/../../../samples

mkdir -p "$folder/npm"
cp "$here/package.json" "$folder/npm/"
(cd "$folder/npm" && npm install --no-package-lock --no-audit --no-fund --prefer-offline --silent) || exit 77
"$samples/bake_creature.sh" "$bake" "$folder/packs" tissue_crowd tissue_rods tissue_touch
"$samples/web/put_together.sh" "$build" "$folder/page" "$folder/packs"
