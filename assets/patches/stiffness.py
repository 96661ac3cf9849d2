#!/usr/bin/env python3
"""Three posts of one shape, painted soft, medium and stiff, on a bar that moves, all emulated: stiffness.jpg.

    stiffness.py BUILD_DIR WORK_DIR
"""
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "assets" / "gallery"))
from modelling import Limb, skin_about  # noqa: E402
from rigged_glb import Mesh, Rig, write_glb  # noqa: E402

STIFFNESS = {"soft": 0.0, "medium": 0.45, "stiff": 0.9}  # painted on all of a post, which is to swing at about 2, 4 and 8 Hz
COLOURS = {"soft": (0.85, 0.45, 0.4), "medium": (0.8, 0.7, 0.35), "stiff": (0.4, 0.55, 0.75), "Bar": (0.5, 0.5, 0.52)}


def sway(t):
    """One stroke to the side and back, with a halt between: what is soft goes on."""
    stroke = lambda s: s * s * (3 - 2 * s)
    there = stroke(np.clip(t / 0.25, 0, 1)) - stroke(np.clip((t - 0.5) / 0.25, 0, 1))
    return {"bar": ((0, 0, 0), (0.3 * float(there), 0, 0))}


def posts():
    rig = Rig()
    rig.bone("bar", "", 0, 0.1, 0)
    for k, name in enumerate(STIFFNESS):
        rig.bone(name, "bar", 0.5 * (k - 1), 0.2, 0)
    limbs = [Limb("bar", (-0.65, 0.1, 0), (0.65, 0.1, 0), 0.1, 0.1)]
    positions, triangles, weights = skin_about(limbs, rig.names(), 0.04, 0.01, 0.02)
    rig.meshes.append(Mesh("bar", positions, triangles, weights, ["Bar"] * len(triangles)))
    for k, name in enumerate(STIFFNESS):
        x = 0.5 * (k - 1)
        limb = [Limb("bar", (x, 0.1, 0), (x, 0.18, 0), 0.09, 0.09), Limb(name, (x, 0.26, 0), (x, 0.75, 0), 0.1, 0.13)]
        positions, triangles, weights = skin_about(limb, rig.names(), 0.035, 0.02, 0.06)
        rig.meshes.append(Mesh(name, positions, triangles, weights, [name] * len(triangles)))
    rig.clips = {"Sway": (1.2, sway)}
    return rig


def recipe():
    regions = [{"name": name, "joints": [name], "stiffness": share} for name, share in STIFFNESS.items()]
    return {"model": "deep_emulator", "regions": regions, "rods": [], "coreless_joints": list(STIFFNESS),
            "young_soft_pa": 6e5, "young_stiff_pa": 1.2e7, "nodes_per_region": 60}


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"stiffness.py: {command[0]}: {done.stderr.strip() or done.stdout.strip()}")
    return done.stdout


def main(build, work):
    from PIL import Image

    tools, work = Path(build) / "bin", Path(work)
    work.mkdir(parents=True, exist_ok=True)
    write_glb(posts(), work / "posts.glb", COLOURS)
    (work / "posts.json").write_text(json.dumps(recipe(), indent=1))
    weights = ROOT / "assets" / "weights" / "emulator.safetensors"
    print(run(tools / "sinew-bake", "character", work / "posts.glb", "--recipe", work / "posts.json", "--emulator", weights,
              "-o", work / "posts.sinew"))
    print(run(tools / "sinew-demo", work / "posts.sinew", "--clip", "Sway", "--seconds", 2.4, "--view", "front", "--frames", work,
              "--width", 400, "--height", 320, "--samples", 16))
    Image.open(work / "contact_sheet.png").convert("RGB").save(Path(__file__).with_name("stiffness.jpg"), quality=85)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
