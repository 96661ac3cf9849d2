#!/usr/bin/env bash
# Measures the ground truth's own error on the creature and on the gallery's characters, and rewrites assets/evaluation/truth/.
# CHARACTERS holds one folder for each character. Half an hour on two cores, an hour where others use them too.
# usage: truth.sh CHARACTERS
set -euo pipefail
[ $# = 1 ] || { echo "usage: truth.sh CHARACTERS (a folder with a folder for each character of the gallery)" >&2; exit 2; }
cd "$(dirname "$0")/.."
characters=$(realpath "$1")
recipes=$(grep -l '"regions"' assets/gallery/*_*.json)

file_of() {
  local file
  for file in "$characters/$(basename "$1" .json)"/file.{glb,gltf,vrm}; do
    [ ! -e "$file" ] || { echo "$file"; return; }
  done
  echo "truth.sh: no $characters/$(basename "$1" .json)/file.glb; give the folder of the gallery's characters" >&2
  return 2
}
for recipe in $recipes; do file_of "$recipe" >/dev/null; done

cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_truth sinew-bake
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
build/release/bin/sinew-bake creature assets/creature/creature.json -o "$measured/creature.glb" >/dev/null

measure_all() {
  build/release/bin/perf_truth "$measured/creature.glb" --name creature --recipe assets/creature/tissue.json "$@"
  for recipe in $recipes; do
    build/release/bin/perf_truth "$(file_of "$recipe")" --name "$(basename "$recipe" .json)" --recipe "$recipe" "$@"
  done
}
measure_all >"$measured/some.csv"
measure_all --clips 1000 --slow --seconds 0.5 >"$measured/all.csv"
"${PYTHON:-/usr/bin/python3}" perf/summarise_truth.py "$measured/some.csv" "$measured/all.csv"
