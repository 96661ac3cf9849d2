#!/usr/bin/env bash
# Measures how far the ground truth is from itself on the creature and on the gallery's characters, whose files lie in the folder that is
# given, a folder each, and rewrites assets/evaluation/truth/. An hour on two cores that are shared, half of one otherwise.
# usage: truth.sh CHARACTERS
set -euo pipefail
cd "$(dirname "$0")/.."
characters=$(realpath "${1:?usage: truth.sh CHARACTERS (a folder with a folder for each character of the gallery)}")

cmake --preset release -DSINEW_BUILD_PERF=ON | grep "^-- perf:" || true
cmake --build --preset release --target perf_truth sinew-bake
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
build/release/bin/sinew-bake creature assets/creature/creature.json -o "$measured/creature.glb" >/dev/null

measure_all() {
  build/release/bin/perf_truth "$measured/creature.glb" --name creature --recipe assets/creature/tissue.json "$@"
  for recipe in $(grep -l '"regions"' assets/gallery/*_*.json); do
    name=$(basename "$recipe" .json)
    build/release/bin/perf_truth "$(ls "$characters/$name"/file.* | head -n 1)" --name "$name" --recipe "$recipe" "$@"
  done
}
measure_all >"$measured/some.csv"
measure_all --clips 1000 --slow --seconds 0.5 >"$measured/all.csv"
"${PYTHON:-/usr/bin/python3}" perf/summarise_truth.py "$measured/some.csv" "$measured/all.csv"
