"""Runs of `sinew-bake rod-data` as what a start's network is told and what it should have answered."""
import glob
import os
from dataclasses import dataclass

import numpy as np

from ..files.safetensors import BadData, load

SPLITS = ("train", "validation", "test", "long")
TOLD, ANSWERS, TRIPLES, JOINT = 14, 12, 4, 5
KNOWN_STEPS = 5  # results before the inputs mean something: kRodStartKnown + 1 of kernels/rods/rod_start_job.hpp
LOG_SCALE = 10.0  # a joint's logarithms of compliances are told over it (rods/start/learned_start.cpp)
LARGEST_ANSWER = 20.0  # in the scales' measure; beyond it the motion had not yet begun
SHAPES = {
    "forces": lambda s, n: (s + 1, n, ANSWERS),
    "turns": lambda s, n: (s, n, 4),
    "inputs": lambda s, n: (s, n, TOLD),
    "continued": lambda s, n: (s, n, ANSWERS),
    "scales": lambda s, n: (s, TRIPLES),
    "joints": lambda s, n: (n, JOINT),
    "parents": lambda s, n: (n,),
}


@dataclass
class Run:
    """S steps of a strand of N segments, those whose inputs mean something."""

    name: str
    told: np.ndarray  # (S, N, 14)
    answers: np.ndarray  # (S, N, 12): what is to be added to the continuation, own axes, over the scales
    joints: np.ndarray  # (N - 1, 5)
    parents: np.ndarray  # (N - 1,) of segment 1 on


def to_own(turns, v):
    """Vectors (..., 3) of the world along the axes of turns (..., 4; x y z w)."""
    u, w = -turns[..., :3], turns[..., 3:]
    t = 2 * np.cross(u, v)
    return v + w * t + np.cross(u, t)


def answers(forces, continued, turns, scales):
    """(S, N, 12) of results and continuations (S, N, 12), turns (S, N, 4) and scales (S, 4)."""
    miss = (forces - continued).reshape(*forces.shape[:2], TRIPLES, 3)
    for world in (0, 2):
        miss[:, :, world] = to_own(turns, miss[:, :, world])
    miss = miss / np.maximum(scales, 1e-20)[:, None, :, None]
    return np.clip(miss, -LARGEST_ANSWER, LARGEST_ANSWER).reshape(forces.shape)


def read_run(path):
    """Throws BadData naming a missing or misshaped tensor, a NaN, a run too short to be told anything."""
    tensors, _ = load(path)
    if "turns" not in tensors or tensors["turns"].ndim != 3:
        raise BadData(f"{path}: tensor turns is missing or misshaped; make the run again")
    steps, segments = tensors["turns"].shape[:2]
    for name, shape in SHAPES.items():
        have = tensors[name].shape if name in tensors else "missing"
        if have != shape(steps, segments):
            raise BadData(f"{path}: tensor {name} is {have}, not {shape(steps, segments)}; make the run again")
        if not np.isfinite(tensors[name]).all():
            raise BadData(f"{path}: tensor {name} holds a NaN; make the run again")
    if steps <= KNOWN_STEPS:
        raise BadData(f"{path}: {steps} steps; a start has inputs after {KNOWN_STEPS}, make the run longer")
    of = {k: np.asarray(tensors[k], np.float64)[KNOWN_STEPS:] for k in ("turns", "continued", "scales")}
    forces = np.asarray(tensors["forces"], np.float64)[1 + KNOWN_STEPS :]
    return Run(
        os.path.basename(path).removesuffix(".safetensors"),
        np.array(tensors["inputs"][KNOWN_STEPS:], np.float32),
        answers(forces, of["continued"], of["turns"], of["scales"]).astype(np.float32),
        np.array(tensors["joints"][1:], np.float32),
        np.array(tensors["parents"][1:], np.int64),
    )


def read_runs(folder, split):
    paths = sorted(glob.glob(os.path.join(folder, f"*-{split}-*.safetensors")))
    if not paths:
        raise BadData(f"{folder}: no run of split {split}; make them with sinew-bake rod-data")
    return [read_run(p) for p in paths]
