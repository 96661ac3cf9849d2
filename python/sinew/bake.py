"""sinew-bake, from Python."""
import os
import subprocess

from sinew.library import Refused


def bake(source, out, *, recipe=None, tissue=None, rods=None, emulator=None, quick=False):
    """Bakes a .glb, .gltf or .vrm into a .sinew file; returns what the program says: notes and the table of parts.

    recipe: a .json file; tissue, rods, emulator: weights (.safetensors). Raises Refused with the program's line."""
    command = [os.environ.get("SINEW_BAKE", "sinew-bake"), "character", os.fspath(source), "-o", os.fspath(out)]
    for name, value in (("recipe", recipe), ("tissue", tissue), ("rods", rods), ("emulator", emulator)):
        if value is not None:
            command += [f"--{name}", os.fspath(value)]
    if quick:
        command.append("--quick")
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except FileNotFoundError:
        raise FileNotFoundError(f"sinew: no program {command[0]}; put sinew-bake on the path, or set SINEW_BAKE") from None
    if done.returncode != 0:
        raise Refused(done.returncode, done.stderr.strip() or f"sinew-bake ended with {done.returncode}")
    return done.stdout
