"""Stands in for `sinew-bake creature`, `truth`, `character` and `info` where a test is about who calls them and
when: notes every call in the file of SINEW_PRETEND_LOG, fails for outputs and motions that SINEW_PRETEND_FAIL
names, takes SINEW_PRETEND_SECONDS for a truth, and finds the regions that SINEW_PRETEND_REGIONS lists."""
import argparse
import json
import os
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "baker"))
from train.data.trajectory import BASIS, DRIVE_WIDTH, VERSION  # noqa: E402
from train.files.safetensors import save  # noqa: E402

NODES, RATE_HZ = 4, 60
TENSORS_BEYOND = {"surface": np.zeros((1, 1, 3), np.float16)}


def truth(a):
    time.sleep(float(os.environ.get("SINEW_PRETEND_SECONDS", 0)))
    ticks = round(a.seconds * RATE_HZ)
    t = np.arange(ticks + 1)[:, None, None] / RATE_HZ
    n = 3 * NODES
    shapes = dict(zip(BASIS, ((1, 2), (1, 2), (n, 2), (n, 2), (2, n), (n, n), (1, 2), (1, 2))))
    tensors = {
        "drive": np.full((ticks + 1, NODES, DRIVE_WIDTH), a.strength),
        "rotation": np.tile(np.eye(3).ravel(), (ticks + 1, NODES, 1)),
        "displacement": 0.01 * a.strength * np.sin(2 * np.pi * 3 * t) * np.ones((1, NODES, 3)),
        "node.rest_position": np.ones((NODES, 3)),
        "node.rest_normal": np.ones((NODES, 3)),
        "node.stiffness": np.zeros((NODES, 1)),
        "region.radius_m": np.array([0.1]),
        **{f"modes.0.{k}": np.full(shape, 10 * np.pi) for k, shape in shapes.items()},
        **(TENSORS_BEYOND if a.surface else {}),
    }
    tensors = {k: v if v.dtype == np.float16 else v.astype(np.float32) for k, v in tensors.items()}
    tensors["node.region"] = np.zeros(NODES, np.int32)
    tensors["edges"] = np.array([[0, 1]], np.int32)
    metadata = {"sinew.trajectory": VERSION, "rate_hz": RATE_HZ, "regions": "flesh", "held_out": ",".join(a.hold_out)}
    for key in ("motion", "seed", "substeps"):
        metadata[key] = getattr(a, key)
    metadata.update(strength=f"{a.strength:.9g}", seconds=f"{a.seconds:.9g}")
    save(a.output, tensors, metadata)


def character(a):
    with open(a.input) as source, open(a.output, "w") as out:
        out.write(source.read())


def info(a):
    regions = filter(None, os.environ.get("SINEW_PRETEND_REGIONS", "").split(","))
    print(json.dumps({"regions": [{"name": n, "first_hz": 3.0, "displacement_limit_m": 1.0} for n in regions], "clips": []}))


def creature(a):
    with open(a.input) as recipe, open(a.output, "w") as out:
        out.write(json.load(recipe)["name"])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("input")
    parser.add_argument("-o", dest="output", default="")
    for option, kind in (("seed", int), ("strength", float), ("seconds", float)):
        parser.add_argument(f"--{option}", type=kind)
    parser.add_argument("--substeps", type=int, default=4)
    parser.add_argument("--hold-out", action="append", default=[])
    for option in ("recipe", "motion", "tissue"):
        parser.add_argument(f"--{option}", default="")
    for option in ("surface", "json", "quick", "keep-network"):
        parser.add_argument(f"--{option}", action="store_true")
    a = parser.parse_args()
    with open(os.environ["SINEW_PRETEND_LOG"], "a") as log:
        print(a.command, a.output, file=log)
    fails = os.environ.get("SINEW_PRETEND_FAIL", "none")
    if fails in a.output or fails == a.motion:
        sys.exit("sinew-bake: it is said to fail")
    {"truth": truth, "character": character, "info": info, "creature": creature}[a.command](a)


if __name__ == "__main__":
    main()
