"""Runs of `sinew-bake patch-data` as patches: what an emulator is fed of a node and its neighbours, and its answer.

Positions are seen along the axes of the newest pose, from a frame that moves on as the centre node did in its last tick
(Galileo), so that only what departs from going on is learned. Where the paper's network is told a third tick, it is told
where going on leads back to, so that the runtime keeps two. Cells and ticks.
"""
import glob
import os
from dataclasses import dataclass

import numpy as np
import torch

from ..files.safetensors import BadData, load

SPLITS = ("train", "validation", "test")


@dataclass
class Run:
    """T ticks after the start of a body of n nodes."""

    name: str
    metadata: dict
    rest: torch.Tensor  # (n, 3)
    place: torch.Tensor  # (T + 1, 3)
    turn: torch.Tensor  # (T + 1, 3, 3), world from body
    displacement: torch.Tensor  # (T + 1, n, 3), along the body's axes
    material: torch.Tensor  # (n, 3)
    free: torch.Tensor  # (nodes,) indices
    constrained: torch.Tensor  # (n,) 1.0 or 0.0
    rows: torch.Tensor  # (n + 1,) CSR of both directions
    columns: torch.Tensor
    tensors: dict  # of the file

    @property
    def ticks(self):
        return len(self.place) - 1

    def __post_init__(self):
        axes = self.turn.transpose(1, 2)
        self._posed = self.place[:, None] + self.rest @ axes
        self._moved = self._posed + self.displacement @ axes

    def posed(self, t):
        """(n, 3): skinned places at tick t; of a time before the start, where it starts."""
        return self._posed[max(t, 0)]

    def moved(self, t):
        """(n, 3): the truth's dynamic places."""
        return self._moved[max(t, 0)]

    def moving(self, t):
        """The truth's u_t, u_{t-1}."""
        return [self.moved(t), self.moved(t - 1)]


def _csr(edges, n):
    both = np.concatenate([edges, edges[:, ::-1]])
    both = both[np.lexsort((both[:, 1], both[:, 0]))]
    rows = np.zeros(n + 1, np.int64)
    np.add.at(rows, both[:, 0] + 1, 1)
    return np.cumsum(rows), np.array(both[:, 1], np.int64)


def read_run(path):
    """Throws BadData naming a missing or misshaped tensor, or a NaN."""
    tensors, metadata = load(path)
    if "displacement" not in tensors or tensors["displacement"].ndim != 3:
        raise BadData(f"{path}: tensor displacement is missing or misshaped; make the run again")
    ticks, n = tensors["displacement"].shape[:2]
    shapes = {"rest": (n, 3), "place": (ticks, 3), "turn": (ticks, 9), "displacement": (ticks, n, 3)}
    shapes |= {"material": (n, 3), "constrained": (n,)}
    for name, shape in shapes.items():
        have = tensors[name].shape if name in tensors else "missing"
        if have != shape:
            raise BadData(f"{path}: tensor {name} is {have}, not {shape}; make the run again")
        if not np.isfinite(tensors[name]).all():
            raise BadData(f"{path}: tensor {name} holds a NaN; make the run again")
    of = {k: torch.as_tensor(np.array(v, np.float64)) for k, v in tensors.items() if k in shapes}
    rows, columns = _csr(np.array(tensors["edges"]), n)
    return Run(
        os.path.basename(path).removesuffix(".safetensors"),
        metadata,
        of["rest"],
        of["place"],
        of["turn"].reshape(ticks, 3, 3),
        of["displacement"],
        of["material"].float(),
        torch.nonzero(of["constrained"] == 0)[:, 0],
        of["constrained"].float(),
        torch.as_tensor(rows),
        torch.as_tensor(columns),
        {k: np.array(v) for k, v in tensors.items() if k.startswith("explicit.")},
    )


def read_runs(folder, split):
    paths = sorted(glob.glob(os.path.join(folder, f"*-{split}-*.safetensors")))
    if not paths:
        raise BadData(f"{folder}: no run of split {split}; make them with sinew-bake patch-data")
    return [read_run(p) for p in paths]


@dataclass
class Patches:
    centre: torch.Tensor  # (n, 15)
    material: torch.Tensor  # (n, 3)
    patch: torch.Tensor  # (m, 37)
    owner: torch.Tensor  # (m,)
    answer: torch.Tensor  # (n, 3): of the truth, what is to be added to going on

    @staticmethod
    def join(parts):
        first = np.cumsum([0] + [len(p.centre) for p in parts])
        owner = torch.cat([p.owner + int(f) for p, f in zip(parts, first)])
        cat = lambda name: torch.cat([getattr(p, name) for p in parts])
        return Patches(cat("centre"), cat("material"), cat("patch"), owner, cat("answer"))


def edges_of(run, nodes):
    """(owner among nodes, neighbour) of nodes (k,)."""
    count = run.rows[nodes + 1] - run.rows[nodes]
    owner = torch.repeat_interleave(torch.arange(len(nodes)), count)
    within = torch.arange(len(owner)) - torch.repeat_interleave(torch.cumsum(count, 0) - count, count)
    return owner, run.columns[run.rows[nodes][owner] + within]


def patches_of(run, t, nodes, dynamic=None):
    """Of the step from tick t to t + 1. dynamic: u_t, u_{t-1} (n, 3) each, else the truth's."""
    u = list(dynamic or run.moving(t))
    u.append(2 * u[1] - u[0])
    x = [run.posed(t + 1 - k) for k in range(3)]
    axes = run.turn[t + 1]
    origin, on = x[1][nodes], (u[0] - u[1])[nodes]
    owner, other = edges_of(run, nodes)

    def seen(places, of, i, ahead):
        """Along the axes, `ahead` ticks after t."""
        return (places[of] - origin[i] - ahead * on[i]) @ axes

    here = torch.arange(len(nodes))
    told = ((u[0], 0), (u[1], -1), (u[2], -2), (x[0], 1), (x[2], -1))
    of_neighbour = ((u[0], 0), (u[1], -1), (u[2], -2), (x[0], 1), (x[1], 0), (x[2], -1))
    centre = torch.cat([seen(p, nodes, here, k) for p, k in told], 1).float()
    neighbour = torch.cat([seen(p, other, owner, k) for p, k in of_neighbour], 1).float()
    patch = torch.cat([centre[owner], neighbour, run.material[other], run.constrained[other, None]], 1)
    answer = ((run.moved(t + 1) - u[0])[nodes] - on) @ axes
    return Patches(centre, run.material[nodes], patch, owner, answer.float())


def take_step(run, t, answer, dynamic):
    """u_{t+1} (n, 3) of answers (free, 3); constrained nodes follow the pose."""
    out = run.posed(t + 1).clone()
    on = (dynamic[0] - dynamic[1])[run.free]
    out[run.free] = dynamic[0][run.free] + on + answer.double() @ run.turn[t + 1].T
    return out
