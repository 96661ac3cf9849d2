#!/usr/bin/env bash
# The long part of tests/extremes: bakes the creature and, where SINEW_SHARED_DIR in the environment says where they are, characters of
# others, plays cases, writes tests/extremes/report.txt. tests/extremes.sh [CASES]
set -euo pipefail
cd "$(dirname "$0")/.."
cases="${1:-100000}"
characters="${SINEW_SHARED_DIR:-}/characters"
out=out/extremes
[[ "$cases" =~ ^[1-9][0-9]*$ ]] || { echo "extremes.sh: '$cases' is no number of cases; tests/extremes.sh 100000" >&2; exit 2; }

scripts/install_packages.sh release
cmake --preset release >/dev/null
cmake --build --preset release --target sinew-bake extremes
mkdir -p "$out"
samples/bake_creature.sh build/release/bin/sinew-bake "$out" tissue tissue_rods tissue_touch
packs=("$out"/creature{,_rods,_touch}.sinew)
for name in godette_vrm0 kaykit_mage khronos_cesium_man khronos_fox mh_heavy_male quaternius_wolf raylib_greenman; do
  [ -d "$characters/$name" ] || continue
  file=$(find "$characters/$name" -name "*.glb" -o -name "*.vrm" | head -n 1)
  [ -n "$file" ] || continue
  recipe=()
  [ ! -e "assets/gallery/$name.json" ] || recipe=(--recipe "assets/gallery/$name.json")
  build/release/bin/sinew-bake character "$file" "${recipe[@]}" --quick -o "$out/$name.sinew" >"$out/$name.txt"
  packs+=("$out/$name.sinew")
done
build/release/bin/extremes --cases "$cases" "${packs[@]}" >"$out/report.txt" && status=0 || status=$?
[ -s "$out/report.txt" ] || exit "$status"
mv "$out/report.txt" tests/extremes/report.txt
cat tests/extremes/report.txt
exit "$status"
