"""Sinew from Python: bake a character, step it, read it as numpy arrays.

    import sinew
    sinew.bake("fox.glb", "fox.sinew")
    world = sinew.World()
    fox = world.load("fox.sinew")
    one = world.add(fox)
    one.parameters(intensity=0.5)              # or of a part: one.parameters(region=0, stiffness=2); see docs/parameters.md
    for frame in range(60):
        one.pose(fox.clip(0, frame / 60))      # [joints, 3, 4]; or one.pose(joints, root=sinew.root(position=(0, 1, 0)))
        world.step(1 / 60)
        surface = one.positions()              # [vertices, 3], metres

Needs numpy, cffi and the shared library. That and its header are looked for where the environment's SINEW_LIBRARY and
SINEW_INCLUDE say, else where pkg-config has them; sinew-bake on the path, or where SINEW_BAKE says.

What is refused raises sinew.Refused with the library's line, and nothing has changed. All of sinew.h is there as sinew.lib,
for what this module has no shorthand for. Threads: as sinew::World has it.
"""
import importlib

from sinew.baking import bake, info
from sinew.refused import Refused

_OF = {"Asset": "world", "Instance": "world", "World": "world", "root": "world", "ffi": "library", "lib": "library"}
__all__ = ["Refused", "bake", "info", *_OF]


def __getattr__(name):
    """What needs the shared library looks for it when it is first asked for: baking does without."""
    if name not in _OF:
        raise AttributeError(f"module 'sinew' has no attribute '{name}'")
    return getattr(importlib.import_module(f"sinew.{_OF[name]}"), name)
