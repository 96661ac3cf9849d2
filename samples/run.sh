#!/usr/bin/env bash
# Installs what is missing, builds, bakes the creature, runs the character loop and scenes of rods headless; prints tables and writes pictures.
set -euo pipefail
cd "$(dirname "$0")/.."

# What only training and tests need is left to tests/run.sh.
scripts/install_packages.sh samples
cmake --preset release >/dev/null
build() { cmake --build --preset release --target "$@" | { grep -v '^ninja: no work' || true; }; }
build sinew-bake sinew-demo

bin=build/release/bin
out=out
mkdir -p "$out"

. samples/newer.sh

tissue=assets/creature/tissue.json
samples/bake_creature.sh "$bin/sinew-bake" "$out" tissue
newer "$out/first/contact_sheet.png" "$out/creature.sinew" "$bin/sinew-demo" || {
  "$bin/sinew-demo" "$out/creature.sinew" --clip hop --seconds 1 --view front --frames "$out/first" >/dev/null
  echo "The first pictures: $out/first/contact_sheet.png"
}

# What is built and baked without using all cores is so beside the films, which are then rendered; the times that are printed are
# measured later, when nothing else runs.
the_rest() {
  set -e
  build sinew-hello sinew-engine sinew-rods sinew-contacts sinew-hair
  # The same creature with its tail and ears as rods, and with a belly that its own hands press.
  samples/bake_creature.sh "$bin/sinew-bake" "$out" tissue_rods tissue_touch
}
set -m  # a process group of its own, so that nothing of it goes on when this script is stopped
the_rest >"$out/the_rest.txt" 2>&1 &
the_rest_id=$!
set +m
trap 'kill -- "-$the_rest_id" 2>/dev/null || true; cat "$out/the_rest.txt" >&2; rm -f "$out/the_rest.txt"' EXIT

newer "$out/hop.truth.safetensors" "$out/creature.glb" "$tissue" || {
  echo "Simulating the ground truth of the hop (once)"
  "$bin/sinew-bake" truth "$out/creature.glb" --recipe "$tissue" --motion clip:hop --seconds 3 --positions -o "$out/hop.truth.safetensors"
}
# Films and large pictures; the demo alone makes small ones in seconds.
quality=(--view front --width 360 --height 400 --samples 4)
newer "$out/pictures/contact_sheet.png" "$out/creature.sinew" "$out/hop.truth.safetensors" "$bin/sinew-demo" ||
  "$bin/sinew-demo" "$out/creature.sinew" --seconds 3 --truth "$out/hop.truth.safetensors" --frames "$out/pictures" --picture-fps 20 "${quality[@]}" >/dev/null
wait "$the_rest_id"  # where it failed, the trap says why
trap - EXIT
cat "$out/the_rest.txt"
rm "$out/the_rest.txt"
newer "$out/pictures_rods/contact_sheet.png" "$out/creature_rods.sinew" "$bin/sinew-demo" ||
  "$bin/sinew-demo" "$out/creature_rods.sinew" --seconds 2.4 --clip hop --frames "$out/pictures_rods" --picture-fps 15 "${quality[@]}"
echo
echo "One creature against the ground truth of the hop:"
"$bin/sinew-demo" "$out/creature.sinew" --seconds 3 --truth "$out/hop.truth.safetensors"
echo
echo "16 creatures, 10 seconds, 1500 us a frame:"
"$bin/sinew-demo" "$out/creature.sinew" --instances 16 --seconds 10 --budget-us 1500 --report "$out/report.json"
python=python3
"$python" -c 'import matplotlib' 2>/dev/null || python=/usr/bin/python3
"$python" samples/demo/plot_budget.py "$out/report.json" -o "$out/budget.png"
echo
echo "Rods without a character:"
newer "$out/rods/two_rods.png" "$bin/sinew-rods" || "$bin/sinew-rods" --samples 16 -o "$out/rods"
echo
echo "Hair over the shoulders of a turning character, against nothing, capsules of its bones, and its skin:"
newer "$out/hair/hair_skin.png" "$bin/sinew-hair" || "$bin/sinew-hair" --samples 16 -o "$out/hair"
echo
echo "Soft tissue against a Bullet world and against the character's hands:"
"$bin/sinew-contacts" "$out/creature_touch.sinew" --samples 16 -o "$out/contacts"
echo
echo "Pictures: $out/first/contact_sheet.png  $out/pictures/contact_sheet.png  $out/pictures_rods/contact_sheet.png  $out/pictures (frames, animation)  $out/budget.png  $out/rods/*.png  $out/hair/*.png  $out/contacts/*.png"
