"""Trajectories grouped into batches: control graphs padded to one size, sequences stacked."""
import glob
import json
import os

import numpy as np
import torch

from .inputs import DRIVE, DRIVE_START, FEEDBACK_START, STATIC, Scaling
from .model import normalized_adjacency
from .safetensors import BadData
from .trajectory import read_trajectory

SHEET = "data_sheet.json"
LENGTH_UNIT_M = 0.01
SCALED_SIZE = 0.3  # mean size of a scaled input
ENVELOPE_MARGIN = 1.2  # of the largest input and displacement seen in training
LEAST_LIMIT = 0.75  # share of a region's radius


class Group:
    """Sequences of one body and one length. R regions, n nodes in the largest, S sequences, T ticks."""

    def __init__(self, trajectories, device="cpu"):
        body = trajectories[0].body
        self.body, self.trajectories, self.device = body, trajectories, device
        counts = np.bincount(body.region, minlength=len(body.radius_m))
        self.regions, self.nodes = len(counts), int(counts.max())
        first = np.concatenate([[0], np.cumsum(counts)[:-1]])
        place = np.arange(self.nodes)[None] < counts[:, None]
        self.slot = torch.as_tensor(
            np.where(place, first[:, None] + np.arange(self.nodes)[None], 0), device=device
        )  # (R, n)
        self.mask = torch.as_tensor(place, device=device)  # (R, n) real nodes
        self.P = self._graph(body, counts, first).to(device)
        self.static = {
            "rest_position": self._pad(body.rest_position),
            "rest_normal": self._pad(body.rest_normal),
            "stiffness": self._pad(body.stiffness),
        }
        self.drive = self._stack([t.drive for t in trajectories])  # (S, T+1, N, 21)
        self.displacement = self._stack([t.displacement for t in trajectories])  # (S, T+1, N, 3) metres
        self.count, self.ticks = self.drive.shape[0], self.drive.shape[1] - 1

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
        """Ticks starts..starts+ticks of some sequences: drive (ticks+1, R, n, B, 21), displacement (ticks+1,
        R, n, B, 3) metres. sequences, starts (B,)."""
        t = starts[None] + torch.arange(ticks + 1, device=self.device)[:, None]
        pick = lambda a: self.unflatten(a[sequences[None], t].permute(0, 2, 1, 3))
        return pick(self.drive), pick(self.displacement)

    def radius_m(self):
        """(N,) of each node's region."""
        return torch.as_tensor(np.array(self.body.radius_m)[self.body.region], device=self.device)

    def unflatten(self, a):
        """(T, N, B, w) -> (T, R, n, B, w), zero where there is no node."""
        return a[:, self.slot] * self.mask[None, :, :, None, None]

    def flatten(self, a):
        """(..., R, n, B, w) -> (..., N, B, w)."""
        return a[..., self.mask, :, :]

    def static_columns(self, scaling, batch):
        """(R, n, B, 7), scaled and held in the envelope."""
        parts = [bounded(self.static[k], k, scaling) for k in STATIC]
        return torch.cat(parts, -1)[:, :, None].expand(-1, -1, batch, -1)


def bounded(values, name, scaling):
    """value x scale, clamped as the runtime clamps it."""
    return (values * scaling.scale[name]).clamp(-scaling.envelope[name], scaling.envelope[name])


def drive_columns(drive, scaling):
    """(..., 21) raw -> (..., 21) scaled and held in the envelope."""
    return torch.cat([bounded(drive[..., columns], k, scaling) for k, columns in DRIVE.items()], -1)


def input_columns(static, drive, y, y_before, scaling):
    """One tick's z (R, n, B, 34): statics, scaled drive, then y and its change (length units), scaled and
    bounded."""
    return torch.cat(
        [static, drive, bounded(y, "displacement", scaling), bounded(y - y_before, "velocity", scaling)], -1
    )


def _round(value, digits=2):
    return float(f"{value:.{digits - 1}e}")


def measure_scaling(groups):
    """Scales from the mean size of the training data (a few violent motions would rule a mean square),
    envelopes from its largest values."""

    def both(pick):  # mean size and largest
        parts = [pick(g).abs() for g in groups]
        return sum(float(p.double().sum()) for p in parts) / sum(p.numel() for p in parts), max(
            float(p.max()) for p in parts
        )

    measured = {k: both(lambda g, c=c: g.drive[..., c]) for k, c in DRIVE.items()}
    measured["displacement"] = both(lambda g: g.displacement / LENGTH_UNIT_M)
    measured["velocity"] = both(lambda g: (g.displacement[:, 1:] - g.displacement[:, :-1]) / LENGTH_UNIT_M)
    scale = {k: 1.0 for k in STATIC}
    scale.update({k: _round(SCALED_SIZE / size) if size > 1e-6 else 1.0 for k, (size, _) in measured.items()})
    largest = {k: max(float(g.static[k].abs().max()) for g in groups) for k in STATIC}
    largest.update({k: top * scale[k] for k, (_, top) in measured.items()})
    reach = max(float((g.displacement.norm(dim=-1).amax((0, 1)) / g.radius_m()).max()) for g in groups)
    return Scaling(
        scale,
        LENGTH_UNIT_M,
        {k: max(1e-3, _round(ENVELOPE_MARGIN * v, 4)) for k, v in largest.items()},
        max(LEAST_LIMIT, _round(ENVELOPE_MARGIN * reach)),
    )


def _check_sheet(folder):
    path = os.path.join(folder, SHEET)
    try:
        with open(path) as file:
            sheet = json.load(file)
        return {
            split: [os.path.join(folder, e["file"]) for e in sheet["sequences"] if e["split"] == split]
            for split in ("train", "validation", "test", "long")
        }
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadData(f"{path}: unusable data sheet ({error}); run `baker/train generate` again") from None


def read_split(folder, split):
    """Trajectories of a split, all checked; throws BadData naming the first unusable file."""
    paths = _check_sheet(folder)[split]
    if not paths:
        raise BadData(
            f"{os.path.join(folder, SHEET)}: no {split} sequences; run `baker/train generate` again"
        )
    out = [read_trajectory(p) for p in paths]
    rates = {t.rate_hz for t in out}
    if len(rates) > 1:
        raise BadData(f"{folder}: sequences of several rates ({sorted(rates)} Hz); one data set has one rate")
    return out


def group(trajectories, device="cpu"):
    """One Group for each body and length."""
    groups = []
    for t in trajectories:
        mates = next(
            (g for g in groups if len(g[0].drive) == len(t.drive) and g[0].body.same_as(t.body)), None
        )
        mates.append(t) if mates else groups.append([t])
    return [Group(g, device) for g in groups]


def find_trajectories(folder):
    return sorted(glob.glob(os.path.join(folder, "*.safetensors")))
