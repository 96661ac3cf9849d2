"""sinew-bake, from Python."""
import json
import os
import subprocess

from sinew.refused import Refused


def run(*arguments):
    """Any of its commands; returns what it prints. The program is on the path, or where SINEW_BAKE says."""
    command = [os.environ.get("SINEW_BAKE", "sinew-bake"), *map(os.fspath, arguments)]
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except FileNotFoundError:
        raise FileNotFoundError(f"sinew: no program {command[0]}; put sinew-bake on the path, or set SINEW_BAKE") from None
    if done.returncode != 0:
        raise Refused(done.returncode, done.stderr.strip() or f"sinew-bake ended with {done.returncode}")
    return done.stdout


def bake(source, out, *, recipe=None, tissue=None, rods=None, emulator=None, quick=False):
    """Bakes a .glb, .gltf or .vrm into a .sinew file; returns what the program says: notes and the table of parts.

    recipe: a .json file; tissue, rods, emulator: weights (.safetensors). Raises Refused with the program's line."""
    options = []
    for name, value in (("recipe", recipe), ("tissue", tissue), ("rods", rods), ("emulator", emulator)):
        if value is not None:
            options += [f"--{name}", value]
    return run("character", source, "-o", out, *options, *(["--quick"] if quick else []))


def info(path):
    """What a file holds: `sinew-bake info --json`."""
    return json.loads(run("info", path, "--json"))
