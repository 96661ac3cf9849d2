#!/bin/sh
# tune_gallery.sh  Trains a network for each character of the gallery that has a recipe with soft parts, ships those that pay and writes
# assets/evaluation/characters/.
#
#   baker/train/tune_gallery.sh CHARACTERS [BUILD_DIR] [WORK_DIR]
#
# CHARACTERS holds a folder a character, with file.glb, .gltf or .vrm in it; BUILD_DIR bin/sinew-train (default: build/release). WORK_DIR
# takes truth and weights (default: BUILD_DIR/characters); a second call leaves out what is done. In the environment, if wanted:
# MINUTES (20, a character), PROCESSES (all cores) and PYTHON (/usr/bin/python3). Two hours and a half on two cores.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
characters=${1:?"usage: tune_gallery.sh CHARACTERS [BUILD_DIR] [WORK_DIR]"}
build=${2:-$root/build/release}
work=${3:-$build/characters}
mkdir -p "$work"
for recipe in "$root"/assets/gallery/*_*.json; do
  grep -q '"regions"' "$recipe" || continue
  name=$(basename "$recipe" .json)
  [ ! -e "$work/$name.tissue.safetensors" ] || continue
  for file in "$characters/$name"/file.glb "$characters/$name"/file.gltf "$characters/$name"/file.vrm; do
    [ ! -e "$file" ] || break
  done
  "$build/bin/sinew-train" "$file" --recipe "$recipe" --minutes "${MINUTES:-20}" ${PROCESSES:+--processes "$PROCESSES"} --keep -o "$work/$name.sinew"
  [ -e "$work/$name.tissue.safetensors" ] || echo "tune_gallery.sh: $name: no weights are better than those it began with; it is not on the page" >&2
done
"${PYTHON:-/usr/bin/python3}" "$root/baker/train" characters "$work" --bake "$build/bin/sinew-bake" --assets "$root/assets"
