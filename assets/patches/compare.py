#!/usr/bin/env python3
"""Bakes characters with all their flesh emulated and plays them: the table of assets/patches/README.md.

    compare.py BUILD_DIR CHARACTERS_DIR WORK_DIR [NAME...]

CHARACTERS_DIR holds a folder a character, with file.glb, .gltf or .vrm. Recipes are the gallery's, with "model": "deep_emulator".
Prints the table of perf_emulator, and beside it the error of the gallery's own recipe.
"""
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WEIGHTS = ROOT / "assets" / "weights" / "emulator.safetensors"


def emulated(recipe):
    """The same flesh, predicted patch by patch; one control graph."""
    recipe = {k: v for k, v in recipe.items() if k not in ("levels", "left_out", "rods")}
    return {**recipe, "model": "deep_emulator", "rods": []}


def bake(build, source, recipe, out, *more):
    command = [build / "bin" / "sinew-bake", "character", source, "--recipe", recipe, "-o", out, *more]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"compare.py: {source}: {done.stderr.strip() or done.stdout.strip()}")
    info = subprocess.run([build / "bin" / "sinew-bake", "info", out, "--json"], capture_output=True, text=True, check=True)
    return json.loads(info.stdout)


def error_of(info, tier):
    found = [t for t in info["tiers"] if t["tier"] == tier and t["level"] == 0]
    return found[0]["error_ratio"] if found else None


def main(build, characters, work, *names):
    build, work = Path(build), Path(work)
    work.mkdir(parents=True, exist_ok=True)
    packs = []
    for folder in sorted(Path(characters).iterdir()):
        own = ROOT / "assets" / "gallery" / f"{folder.name}.json"
        source = next(iter(sorted(folder.glob("file.*"))), None)
        if source is None or not own.exists() or (names and folder.name not in names):
            continue
        recipe = work / f"{folder.name}.json"
        recipe.write_text(json.dumps(emulated(json.loads(own.read_text())), indent=1))
        out = work / f"{folder.name}.sinew"
        usual = bake(build, source, own, work / f"{folder.name}_own.sinew")
        if error_of(usual, "modal") is None:
            continue  # nothing of it is flesh
        bake(build, source, recipe, out, "--emulator", WEIGHTS)
        print(f"{folder.name}: the gallery's recipe leaves {error_of(usual, 'modal'):.3f} by modes", flush=True)
        packs.append(out)
    subprocess.run([build / "bin" / "perf_emulator", *packs], check=True)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
