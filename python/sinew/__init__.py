"""Sinew from Python: bake a character, step it, read it as numpy arrays.

    import sinew
    sinew.bake("fox.glb", "fox.sinew")
    world = sinew.World()
    fox = world.load("fox.sinew")
    one = world.add(fox)
    for frame in range(60):
        one.pose(fox.clip(0, frame / 60))      # [joints, 3, 4]; or one.pose(joints, root=sinew.root(position=(0, 1, 0)))
        world.step(1 / 60)
        surface = one.positions()              # [vertices, 3], metres

Needs numpy, cffi and the shared library. That and its header are looked for where the environment's SINEW_LIBRARY and
SINEW_INCLUDE say, else where pkg-config has them; sinew-bake on the path, or where SINEW_BAKE says.

What is refused raises sinew.Refused with the library's line, and nothing has changed. All of sinew.h is there as sinew.lib,
for what this module has no shorthand for. Threads: as sinew::World has it.
"""
from sinew.bake import bake
from sinew.library import Refused, ffi, lib
from sinew.world import Asset, Instance, World, root

__all__ = ["Asset", "Instance", "Refused", "World", "bake", "ffi", "lib", "root"]
