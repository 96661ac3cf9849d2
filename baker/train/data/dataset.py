"""Trajectories grouped into batches: control graphs padded to one size, sequences stacked."""
import json
import os

import numpy as np
import torch

from ..files.safetensors import BadData
from ..model.alt_conv_lstm import normalized_adjacency
from ..model.inputs import FELT
from ..model.limit import within
from ..model.modal_base import ModalBase
from .trajectory import read_trajectory

SHEET = "data_sheet.json"
SPLITS = ("train", "validation", "test", "long")


class Group:
    """Sequences of one body and one length. R regions, n nodes in the largest, S sequences, T ticks. limits: of each
    region, metres; the truth is held within it as the runtime's answer is."""

    def __init__(self, trajectories, name="", device="cpu", limits=None):
        body = trajectories[0].body
        self.body, self.trajectories, self.name, self.device = body, trajectories, name, device
        counts = np.bincount(body.region, minlength=len(body.radius_m))
        self.regions, self.nodes = len(counts), int(counts.max())
        first = np.concatenate([[0], np.cumsum(counts)[:-1]])
        place = np.arange(self.nodes)[None] < counts[:, None]
        self.slot = torch.as_tensor(
            np.where(place, first[:, None] + np.arange(self.nodes)[None], 0), device=device
        )  # (R, n)
        self.mask = torch.as_tensor(place, device=device)  # (R, n) real nodes
        self.P = self._graph(body, counts, first).to(device)
        tick_s = 1 / trajectories[0].rate_hz
        self.base = ModalBase(body.bases, counts, tick_s, device)
        self.radius = torch.as_tensor(np.array(body.radius_m, np.float32), device=device)[:, None, None, None]
        self.static = {
            "rest_position": self._pad(body.rest_position),
            "rest_normal": self._pad(body.rest_normal),
            "stiffness": self._pad(body.stiffness),
            "frequency": (self.base.first * tick_s)[:, None, None] * self.mask[..., None],
        }
        self.drive = self._stack([t.drive for t in trajectories])  # (S, T+1, N, 15)
        self.rotation = self._stack([t.rotation for t in trajectories])  # (S, T+1, N, 9)
        self.displacement = self._stack([t.displacement for t in trajectories])  # (S, T+1, N, 3) metres
        of = lambda r: self.displacement[:, :, torch.as_tensor(np.array(body.region) == r, device=device)]
        self.largest_m = torch.stack([of(r).norm(dim=-1).max() for r in range(self.regions)])  # (R,), before limits
        if limits is not None:
            self._hold_within(torch.as_tensor(limits, dtype=torch.float32, device=device))
        self.count, self.ticks = self.drive.shape[0], self.drive.shape[1] - 1

    def _hold_within(self, limits):
        self.base.limit = limits
        for r, limit in enumerate(limits):
            nodes = torch.as_tensor(np.array(self.body.region) == r, device=self.device)
            one = self.displacement[:, :, nodes].flatten(0, 1).transpose(0, 1)  # (n, S (T+1), 3)
            shown = within(limit[None], one[None])[0].transpose(0, 1)
            self.displacement[:, :, nodes] = shown.unflatten(0, self.displacement.shape[:2])

    def _stack(self, arrays):
        return torch.as_tensor(np.stack([np.asarray(a, np.float32) for a in arrays]), device=self.device)

    def _pad(self, values):
        """(N, w) -> (R, n, w), zero where there is no node."""
        v = torch.as_tensor(np.array(values, np.float32), device=self.device)
        return v[self.slot] * self.mask[..., None]

    def _graph(self, body, counts, first):
        P = torch.zeros(self.regions, self.nodes, self.nodes)
        for r, (n, start) in enumerate(zip(counts, first)):
            inside = body.edges[(body.edges >= start).all(1) & (body.edges < start + n).all(1)] - start
            P[r, :n, :n] = normalized_adjacency(int(n), np.array(inside)).float()
        return P

    def window(self, sequences, starts, ticks):
        """Ticks starts+1 .. starts+ticks of some sequences (B,): felt acceleration and the rest of the drive,
        each (ticks, R, n, B, .); R_t^T R_{t-1} and R_t^T R_{t-2}, each (ticks, R, n, B, 3, 3); displacement
        (ticks, R, n, B, 3) metres. What lies before a sequence is its first tick."""
        t = starts[None] + torch.arange(-1, ticks + 1, device=self.device)[:, None]
        pick = lambda a, t: self.unflatten(a[sequences[None], t.clamp(min=0)].permute(0, 2, 1, 3))
        drive, u = pick(self.drive, t[2:]), pick(self.displacement, t[2:])
        r = pick(self.rotation, t).unflatten(-1, (3, 3))
        turn = lambda before: torch.matmul(r[2:].transpose(-1, -2), before)
        return drive[..., FELT], drive, (turn(r[1:-1]), turn(r[:-2])), u

    def radius_m(self):
        """(N,) of each node's region."""
        return torch.as_tensor(np.array(self.body.radius_m)[self.body.region], device=self.device)

    def unflatten(self, a):
        """(T, N, B, w) -> (T, R, n, B, w), zero where there is no node."""
        return a[:, self.slot] * self.mask[None, :, :, None, None]

    def flatten(self, a):
        """(..., R, n, B, w) -> (..., N, B, w)."""
        return a[..., self.mask, :, :]


class Union:
    """Several bodies side by side along R, so that one batch moves them all: a Group to whoever rolls it out.
    Sequences are (groups, B)."""

    def __init__(self, groups):
        self.groups, self.device = groups, groups[0].device
        self.nodes, self.regions = max(g.nodes for g in groups), sum(g.regions for g in groups)
        self.ticks = min(g.ticks for g in groups)
        self.mask = torch.cat([self._wide(g.mask, 1) for g in groups])
        self.P = torch.cat([self._wide(self._wide(g.P, 1), 2) for g in groups])
        self.radius = torch.cat([g.radius for g in groups])
        self.static = {k: torch.cat([self._wide(g.static[k], 1) for g in groups]) for k in groups[0].static}
        self.base = ModalBase.union([g.base for g in groups])
        nodes = self.mask.sum(1, keepdim=True)
        self.share = (self.mask / nodes / self.regions)[..., None]  # (R, n, 1) of each node in a mean: regions alike

    def _wide(self, a, axis):
        """Zeros at the end of an axis, up to the largest region's nodes."""
        missing = list(a.shape)
        missing[axis] = self.nodes - a.shape[axis]
        return torch.cat([a, a.new_zeros(missing)], axis) if missing[axis] else a

    def draw(self, batch):
        """Random sequences of each body, (groups, B)."""
        pick = lambda g: torch.cat([torch.randperm(g.count) for _ in range(-(-batch // g.count))])[:batch]
        return torch.stack([pick(g) for g in self.groups]).to(self.device)

    def window(self, sequences, starts, ticks):
        parts = [g.window(s, starts, ticks) for g, s in zip(self.groups, sequences)]
        join = lambda values: torch.cat([self._wide(v, 2) for v in values], 1)
        felt, drive, turn, u = zip(*parts)
        return join(felt), join(drive), tuple(join(t) for t in zip(*turn)), join(u)


def _read_sheet(folder):
    path = os.path.join(folder, SHEET)
    try:
        with open(path) as file:
            entries = json.load(file)["sequences"]
        return [(e["split"], e.get("body", ""), os.path.join(folder, e["file"])) for e in entries]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadData(f"{path}: unusable data sheet ({error}); run `baker/train generate` again") from None


def list_split(folder, split):
    """(body's name, path) of a split's sequences."""
    return [(b, p) for s, b, p in _read_sheet(folder) if s == split]


def read_split(folder, split, body=None):
    """(body's name, trajectory) of a split's sequences, of one body if it is named, all checked; throws
    BadData naming the first unusable file."""
    found = [(b, p) for b, p in list_split(folder, split) if body in (None, b)]
    if not found:
        raise BadData(
            f"{os.path.join(folder, SHEET)}: no {split} sequences; run `baker/train generate` again"
        )
    out = [(b, read_trajectory(p)) for b, p in found]
    rates = {t.rate_hz for _, t in out}
    if len(rates) > 1:
        raise BadData(f"{folder}: sequences of several rate_hz ({sorted(rates)}); one data set has one")
    return out


def _alike(one, other):
    """Whether two (body's name, trajectory) can share a Group."""
    (name, a), (other_name, b) = one, other
    return name == other_name and len(a.drive) == len(b.drive) and a.body.same_as(b.body)


def group(named, device="cpu", limits=None):
    """One Group for each body and length of (body's name, trajectory) pairs; limits as of a Group, for all of them."""
    groups = []
    for name, t in named:
        mates = next((g for g in groups if _alike(g[0], (name, t))), None)
        mates.append((name, t)) if mates else groups.append([(name, t)])
    return [Group([t for _, t in g], g[0][0], device, limits) for g in groups]
