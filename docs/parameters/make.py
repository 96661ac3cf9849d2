#!/usr/bin/env python3
"""Draws the pictures of docs/parameters.md: one creature with a low, a medium and a high value of each parameter, and how it moves over time.

Usage: make.py BUILD [NAME]...

BUILD is a build folder (build/release) with sinew-bake and the shared library. The creature is baked into out/, as samples/run.sh does.
NAME draws these pictures alone. They are written to docs/pictures/parameters/.
"""
import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

SYSTEM_PYTHON = "/usr/bin/python3"
try:
    import cffi  # noqa: F401
    import matplotlib
    import numpy as np
    from PIL import Image, ImageFilter
except ImportError as missing:  # a Python without Debian's packages
    if os.path.realpath(sys.executable) == os.path.realpath(SYSTEM_PYTHON):
        sys.exit(f"make.py: {missing}; apt-get install python3-cffi python3-matplotlib python3-pil")
    os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, *sys.argv])

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PICTURES = HERE.parent / "pictures/parameters"
OUT = ROOT / "out"
sys.path.insert(0, str(ROOT / "python"))
import draw  # noqa: E402
from layout import PANEL_HEIGHT, PANEL_WIDTH, TINT_FULL, WORDS, compose, write_png  # noqa: E402
from scenes import SCENES  # noqa: E402

RATE_HZ, REST_S = 60, 2.0


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"make.py: {command[0]}: {(done.stderr or done.stdout).strip()}")


def bake_rods(build, name, keys):
    """A creature whose rods have other keys in their recipe; nothing else of it is simulated."""
    recipe = json.loads((ROOT / "assets/creature/tissue_rods.json").read_text())
    folder = OUT / "parameters"
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps({"regions": [], "rods": [{**rod, **keys} for rod in recipe["rods"]]}))
    run(build / "bin/sinew-bake", "character", OUT / "creature.glb", "--recipe", folder / f"{name}.json", "-o", folder / f"{name}.sinew", "--quick")
    return folder / f"{name}.sinew"


class Played:
    """A scene at one value: positions and normals of each frame, metres."""

    def __init__(self, pack, scene, value, skinned=False):
        import sinew
        with sinew.World() as world:
            asset = world.load(pack)
            one = world.add(asset)
            if skinned:
                one.tier_limit("skinning")
            else:
                scene.set(world, one, value)
            positions, normals = [], []
            for frame in range(-int(REST_S * RATE_HZ), int(scene.seconds * RATE_HZ) + 1):
                if frame == 0 and not skinned:
                    scene.begin(world, one, value)
                one.pose(scene.motion(asset, frame / RATE_HZ))
                world.step(1 / RATE_HZ)
                if frame >= 0:
                    positions.append(one.positions())
                    normals.append(one.normals())
        self.asset, self.positions, self.normals = asset, np.array(positions), np.array(normals)


def part_of(asset, view):
    if view.includes:
        return np.flatnonzero(view.includes(asset.positions))
    return next(region["vertices"] for region in asset.regions if region["name"] == view.part)


def sampled_vertex(skinned, played, view):
    """How each of them displaces the vertex of the part that moves most, along the view's axis: [3, frames], % of the height."""
    part = part_of(skinned.asset, view)
    along = np.array([(one.positions - skinned.positions)[:, part, view.axis] for one in played])
    return 100 * along[:, :, np.argmax(np.abs(along).max(1).sum(0))] / skinned.asset.info["height_m"]


def clearest(curves, first):
    """The frame, of those from the first on, in which the three differ most and are in the order of their largest movements."""
    sizes = np.abs(curves)
    ordered = sizes if sizes[0].max() < sizes[2].max() else sizes[::-1]
    apart = np.minimum(ordered[1] - ordered[0], ordered[2] - ordered[1])[first:]
    if apart.max() <= 0:  # the medium one does not move
        apart = np.abs(curves[0] - curves[2])[first:]
    return first + int(np.argmax(apart))


def tint(paint, one, skinned, frame):
    moved = np.linalg.norm(one.positions[frame] - skinned.positions[frame], axis=1) / skinned.asset.info["height_m"] / TINT_FULL
    return paint.tinted(matplotlib.colormaps["YlOrRd"](np.clip(moved, 0, 1))[:, :3], np.clip(4 * moved, 0, 1))


def render(scene, one, skinned, paint, frame):
    """The picture of a moment, and the outline that skinning alone has then, where the two differ."""
    triangles = skinned.asset.triangles.astype(int)
    how = scene.view.camera, PANEL_WIDTH, PANEL_HEIGHT
    if scene.view.tint:
        paint = tint(paint, one, skinned, frame)
    outline = draw.covered(skinned.positions[frame], triangles, *how)
    differs = near(outline, draw.covered(one.positions[frame], triangles, *how))
    return draw.picture(one.positions[frame], one.normals[frame], triangles, paint, *how), np.ma.array(outline, mask=~differs)


def near(rest, moved):
    """Pixels about a visible difference of two silhouettes: an outline elsewhere would only cover the picture."""
    differs = Image.fromarray((np.abs(rest - moved) > 0.5).astype(np.uint8) * 255)
    return np.array(differs.filter(ImageFilter.MinFilter(3)).filter(ImageFilter.MaxFilter(15))) > 0


def draw_scene(name, build, paint):
    scene = SCENES[name]
    packs = [OUT / "creature_rods.sinew"] * 3
    if scene.rods:
        packs = [bake_rods(build, f"{name}_{word}", scene.rods(value)) for word, value in zip(WORDS, scene.values)]
    skinned = Played(packs[0], scene, None, skinned=True)
    played = [Played(pack, scene, value) for pack, value in zip(packs, scene.values)]
    curves = sampled_vertex(skinned, played, scene.view)
    frame = clearest(curves, int(scene.shown_from * RATE_HZ))
    pictures, outlines = zip(*(render(scene, one, skinned, paint, frame) for one in played))
    write_png(compose(scene, pictures, outlines, np.arange(curves.shape[1]) / RATE_HZ, curves, frame), PICTURES / f"{name}.png")


def read_arguments():
    class Parser(argparse.ArgumentParser):
        def error(self, message):
            self.exit(2, f"make.py: {message}; make.py --help\n")

    parser = Parser(prog="make.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", metavar="BUILD", type=Path)
    parser.add_argument("names", metavar="NAME", nargs="*", default=[], help=", ".join(SCENES))
    arguments = parser.parse_args()
    for file in ("bin/sinew-bake", "runtime/libsinew.so"):
        if not (arguments.build / file).is_file():
            parser.error(f"no {file} in {arguments.build}; build it with cmake --build --preset release")
    for name in arguments.names:
        if name not in SCENES:
            parser.error(f"no picture '{name}'; there are {', '.join(SCENES)}")
    return arguments.build.resolve(), arguments.names or list(SCENES)


def main():
    build, names = read_arguments()
    os.environ.update(SINEW_LIBRARY=str(build / "runtime/libsinew.so"), SINEW_INCLUDE=str(ROOT / "runtime/include"))
    run(ROOT / "samples/bake_creature.sh", build / "bin/sinew-bake", OUT, "tissue_rods")
    PICTURES.mkdir(parents=True, exist_ok=True)
    paint = draw.Paint(OUT / "creature.glb")
    for name in names:
        draw_scene(name, build, paint)
        print(PICTURES.relative_to(ROOT) / f"{name}.png")


if __name__ == "__main__":
    main()
