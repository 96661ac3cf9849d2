"""sinew-train: what it is asked for, checked before anything is written."""
import argparse
import json
import math
import os
import sys
from urllib.parse import unquote

from ..files.safetensors import BadData, refuse_over
from . import SHIPPED, tissue_beside

NAME = "sinew-train"


class _Parser(argparse.ArgumentParser):
    """Refuses in one line."""

    def error(self, message):
        self.exit(2, f"{NAME}: {message}; see {NAME} --help\n")


def _parser():
    p = _Parser(
        prog=NAME,
        description="Fine-tunes the shipped tissue network on ground truth of one character and bakes the "
        "best of modal base, shipped and fine-tuned network, by their errors on motions that were held out. "
        "Ctrl-C keeps the best so far; a second run goes on with the motions in C.train.",
    )
    p.add_argument("character", metavar="C.glb", help="skinned glTF or VRM; clips are used where it has any")
    p.add_argument("--recipe", metavar="R.json", help="as of sinew-bake character")
    p.add_argument("--minutes", type=float, default=20.0, help="of the clock, for everything; default 20")
    p.add_argument("--tissue", metavar="W.safetensors", default=SHIPPED, help="weights to begin with")
    p.add_argument("--rods", metavar="W.safetensors", help="as of sinew-bake character")
    p.add_argument("-o", "--output", metavar="C.sinew", required=True)
    p.add_argument("--keep", action="store_true", help="write the tuned weights even where they do not win")
    p.add_argument("--seed", type=int, default=0, help="of training; default 0")
    p.add_argument("--processes", type=int, default=len(os.sched_getaffinity(0)), help="default all cores")
    p.add_argument("--bake", default="sinew-bake", help=argparse.SUPPRESS)
    return p


def _need_file(path, what):
    if os.path.isdir(path):
        raise BadData(f"{path}: is a directory; give {what}")
    if not os.path.exists(path):
        raise BadData(f"{path}: no such file; give {what}")


def _files_of(character):
    """The character's file and those that a .gltf names: buffers and pictures beside it."""
    files = [character]
    try:
        with open(character, encoding="utf-8") as f:
            gltf = json.load(f)
        uris = [one.get("uri", "") for kind in ("buffers", "images") for one in gltf.get(kind, [])]
        files += [os.path.join(os.path.dirname(character), unquote(u)) for u in uris if not u.startswith("data:")]
    except (ValueError, AttributeError, TypeError):
        pass  # a .glb; what is damaged sinew-bake refuses
    return files


def _keep_inputs(a):
    """Throws BadData where what will be written is what is read."""
    inputs = [*_files_of(a.character), a.tissue, *(f for f in (a.recipe, a.rods) if f)]
    refuse_over([a.output, tissue_beside(a.output)], inputs)


def _refuse_emulated(recipe):
    """What sinew-bake refuses of a recipe it refuses in its own words."""
    try:
        with open(recipe, encoding="utf-8") as f:
            parts = json.load(f)
        parts = [parts, *parts.get("regions", [])]
        emulated = any(part.get("model") == "deep_emulator" for part in parts)
    except (ValueError, AttributeError, TypeError):
        return
    if emulated:
        raise BadData(f'{recipe}: says "model": "deep_emulator", which this does not train; leave it out')


def _check(a):
    """Throws BadData where an argument cannot be used."""
    if not (0 < a.minutes < math.inf):
        raise BadData(f"--minutes {a.minutes:g}: must be above 0; it is the whole time, 20 is a good one")
    if a.processes < 1:
        raise BadData(f"--processes {a.processes}: must be 1 or more")
    _need_file(a.character, "a skinned glTF or VRM")
    _need_file(a.tissue, "trained weights, as assets/weights/creature.safetensors")
    if a.recipe:
        _need_file(a.recipe, "a recipe, JSON")
        _refuse_emulated(a.recipe)
    if a.rods:
        _need_file(a.rods, "weights of a coping_net, as assets/weights/coping_8.safetensors")
    _keep_inputs(a)
    if os.path.isdir(a.output):
        file = os.path.join(a.output, "C.sinew")
        raise BadData(f"{a.output}: is a directory; give a file's name, as {file}")
    folder = os.path.dirname(os.path.abspath(a.output))
    if not os.path.isdir(folder):
        raise BadData(f"{a.output}: no folder {folder}; make it first")


def main(arguments=None):
    """Exit codes: 0 good, 2 unusable input (one line says what, where, how to mend)."""
    a = _parser().parse_args(arguments)
    try:
        _check(a)
        from .stages import tune  # PyTorch takes a second to load

        tune(a)
    except BadData as error:
        print(f"{NAME}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 0
