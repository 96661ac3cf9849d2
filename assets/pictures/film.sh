#!/usr/bin/env bash
# Films the creature's hop for the readme, hop.webp in this folder: skinning alone, Sinew, and the displacement between them.
# usage: film.sh BUILD   the folder that has bin/sinew-bake and bin/sinew-demo (build/release)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
refuse() {
  echo "film.sh: $1" >&2
  exit 2
}
[ $# = 1 ] || refuse "usage: film.sh BUILD"
for program in sinew-bake sinew-demo; do
  [ -x "$1/bin/$program" ] || refuse "no bin/$program in $1; build it with cmake --build --preset release --target $program"
done
ffmpeg -hide_banner -encoders 2>/dev/null | grep libwebp_anim >/dev/null || refuse "no ffmpeg with libwebp_anim; apt-get install ffmpeg"
bin=$(cd "$1/bin" && pwd)
out=$root/out

"$root/samples/bake_creature.sh" "$bin/sinew-bake" "$out" tissue
# The clip lasts 73/60 s, and the demo begins 0.3 s late: from picture 31 on the swing repeats itself, after two hops nearly in a whole number of pictures.
fps=20 first=31 pictures=49
"$bin/sinew-demo" "$out/creature.sinew" --clip hop --seconds 4.1 --view auto --frames "$out/film" --picture-fps "$fps" --width 212 --height 250 --samples 32 >/dev/null
part=$here/hop.part.webp
trap 'rm -f "$part"' EXIT
ffmpeg -y -loglevel error -framerate "$fps" -start_number "$first" -i "$out/film/frame_%04d.png" -frames:v "$pictures" -c:v libwebp_anim -loop 0 -quality 78 -compression_level 6 "$part"
mv "$part" "$here/hop.webp"
echo "$here/hop.webp: $(stat -c %s "$here/hop.webp") bytes"
