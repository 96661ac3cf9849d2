#!/usr/bin/env python3
"""Bakes characters with all their soft tissue emulated and plays them: assets/patches/characters.csv.

    compare.py BUILD_DIR CHARACTERS_DIR WORK_DIR [NAME...]

CHARACTERS_DIR holds one folder for each character, with file.glb, .gltf or .vrm; our creature comes last. Recipes are the gallery's
and the creature's, with "model": "deep_emulator". Prints the rows too; with NAMEs it only prints them.
"""
import csv
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
TABLE = Path(__file__).with_name("characters.csv")
# Errors are fractions of skinning's; "usual" is the character's own recipe, by modes. The others are columns of perf_emulator.
COLUMNS = ("character", "nodes", "modes_error", "modes_us_per_tick", "emulator_error", "emulator_us_per_tick", "largest_of_limit", "explosions",
           "usual_modes_error")


def emulated(recipe):
    """The same soft tissue, predicted patch by patch; one control graph."""
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


def rows_of(printed, usual):
    """Rows of COLUMNS from the table that perf_emulator prints. usual: name -> error."""
    for line in printed.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) == len(COLUMNS) - 1 and cells[0].endswith(".sinew"):
            name = Path(cells[0]).stem
            yield [name, *cells[1:], f"{usual[name]:.3f}"]


def main(build, characters, work, *names):
    build, work = Path(build), Path(work)
    os.environ["SINEW_BAKE"] = str(build / "bin" / "sinew-bake")
    work.mkdir(parents=True, exist_ok=True)
    packs, usual = [], {}
    for name, source, own in found(characters, work, names):
        recipe = work / f"{name}.json"
        recipe.write_text(json.dumps(emulated(json.loads(own.read_text())), indent=1))
        out = work / f"{name}.sinew"
        error = error_of(bake(source, own, work / f"{name}_own.sinew"), "modal")
        if error is None:
            continue  # it has no soft tissue
        bake(source, recipe, out, emulator=WEIGHTS)
        usual[name] = error
        packs.append(out)
    played = subprocess.run([build / "bin" / "perf_emulator", *packs], check=True, capture_output=True, text=True)
    rows = list(rows_of(played.stdout, usual))
    if len(rows) != len(packs):
        sys.exit(f"compare.py: perf_emulator printed {len(rows)} rows of {len(COLUMNS) - 1} columns for {len(packs)} packs")
    csv.writer(sys.stdout).writerows([COLUMNS, *rows])
    if not names:
        with TABLE.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
