#!/usr/bin/env python3
"""Bakes characters with all their flesh emulated and plays them: the table of assets/patches/README.md.

    compare.py BUILD_DIR CHARACTERS_DIR WORK_DIR [NAME...]

CHARACTERS_DIR holds a folder a character, with file.glb, .gltf or .vrm; our creature comes last. Recipes are the gallery's and the
creature's, with "model": "deep_emulator". Prints the table of perf_emulator, and before it the error of the usual recipe.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

import sinew  # noqa: E402
from sinew import baking  # noqa: E402

WEIGHTS = ROOT / "assets" / "weights" / "emulator.safetensors"


def emulated(recipe):
    """The same flesh, predicted patch by patch; one control graph."""
    recipe = {k: v for k, v in recipe.items() if k not in ("levels", "left_out", "rods")}
    return {**recipe, "model": "deep_emulator", "rods": []}


def bake(source, recipe, out, **weights):
    try:
        sinew.bake(source, out, recipe=recipe, **weights)
    except sinew.Refused as refused:
        sys.exit(f"compare.py: {source}: {refused}")
    return sinew.info(out)


def error_of(info, tier):
    found = [t for t in info["tiers"] if t["tier"] == tier and t["level"] == 0]
    return found[0]["error_ratio"] if found else None


def creature(work):
    path = work / "creature.glb"
    baking.run("creature", ROOT / "assets" / "creature" / "creature.json", "-o", path)
    return path


def found(characters, work, names):
    """Name, file and the usual recipe of each."""
    for folder in sorted(Path(characters).iterdir()):
        own = ROOT / "assets" / "gallery" / f"{folder.name}.json"
        source = next(iter(sorted(folder.glob("file.*"))), None)
        if source and own.exists() and (not names or folder.name in names):
            yield folder.name, source, own
    if not names or "creature" in names:
        yield "creature", creature(work), ROOT / "assets" / "creature" / "tissue.json"


def main(build, characters, work, *names):
    build, work = Path(build), Path(work)
    os.environ["SINEW_BAKE"] = str(build / "bin" / "sinew-bake")
    work.mkdir(parents=True, exist_ok=True)
    packs = []
    for name, source, own in found(characters, work, names):
        recipe = work / f"{name}.json"
        recipe.write_text(json.dumps(emulated(json.loads(own.read_text())), indent=1))
        out = work / f"{name}.sinew"
        usual = bake(source, own, work / f"{name}_own.sinew")
        if error_of(usual, "modal") is None:
            continue  # nothing of it is flesh
        bake(source, recipe, out, emulator=WEIGHTS)
        print(f"{name}: the usual recipe leaves {error_of(usual, 'modal'):.3f} by modes", flush=True)
        packs.append(out)
    subprocess.run([build / "bin" / "perf_emulator", *packs], check=True)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
