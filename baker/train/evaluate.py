"""Judges a network on held-out motions, beside springs and skinning alone."""
import json
import math
import os

import numpy as np
import torch

from . import dataset
from .baselines import fit_springs
from .rollout import roll_out, truth
from .safetensors import BadData
from .weights import read_weights

TICKS = (10, 20, 30, 40, 50, 100, 200, 600, 3600)
METHODS = ("network", "spring", "two_springs", "skinning")


class Tally:
    """Sums of errors over many roll-outs, by ticks; millimetres."""

    def __init__(self):
        self.sums = {}

    def add(self, method, predicted, true):
        """(T+1, N, B, 3) metres both."""
        error = 1e3 * (predicted[1:] - true[1:]).norm(dim=-1).double()
        size = 1e3 * true[1:].norm(dim=-1).double()
        for k in [k for k in TICKS if k <= len(error)]:
            e, s = error[:k], size[:k]
            add = np.array([e.numel(), float(e.sum()), float(e.square().sum()), float(s.sum())])
            self.sums[method, k] = self.sums.get((method, k), 0) + add

    def figures(self):
        """ticks -> method -> mean and standard deviation in mm, ratio to skinning alone."""
        out = {}
        for (method, k), (n, e, square, size) in sorted(self.sums.items(), key=lambda item: item[0][1]):
            mean = e / n
            out.setdefault(str(k), {})[method] = {
                "mean_mm": round(mean, 4),
                "sd_mm": round(math.sqrt(max(0, square / n - mean * mean)), 4),
                "ratio": round(e / size, 4) if size > 0 else None,
            }
        return out


def predictions(model, scaling, springs, group):
    """method -> displacement (T+1, N, B, 3) metres."""
    out = {"network": roll_out(model, scaling, group)}
    if group.body.same_as(springs[0]):
        out.update(spring=springs[1].predict(group), two_springs=springs[2].predict(group))
    out["skinning"] = torch.zeros_like(truth(group))
    return out


def single_step(model, scaling, group):
    """Error of one tick from the true state, as a share of skinning's, beside holding the displacement and
    keeping its velocity."""
    u, size = truth(group), truth(group)[2:].norm(dim=-1).mean()
    share = lambda p: round(float((p - u[2:]).norm(dim=-1).mean() / size), 4)
    return {"hold": share(u[1:-1]), "constant_velocity": share(2 * u[1:-1] - u[:-2])}


def _cut(drive, gain, silent_from):
    """Drive times gain (angular velocity by its root, as its square drives), then none."""
    out = drive * gain
    out[..., 15:18] = drive[..., 15:18] * gain**0.5
    out[silent_from:] = 0
    return out


def stability(model, scaling, group, gain):
    """Driven for 200 ticks at `gain`, then left alone for 600: largest displacement and what is left, mm;
    largest |c|."""
    s = torch.arange(min(8, group.count))
    driven = min(200, group.ticks)
    drive = group.window(s, torch.zeros(len(s), dtype=torch.long), driven)[0]
    drive = torch.cat([drive, torch.zeros_like(drive[:1]).expand(600, *drive.shape[1:])])
    watch = {}
    y = 1e3 * roll_out(
        model, scaling, group, drive=_cut(drive, gain, driven + 1), sequences=s, watch=watch
    ).norm(dim=-1)
    radius = group.radius_m() * 1e3
    return {
        "gain": gain,
        "largest_mm": round(float(y.max()), 2),
        "residue_mean_mm": round(float(y[-1].mean()), 4),
        "residue_largest_mm": round(float(y[-1].max()), 4),
        "largest_cell": round(watch["cell"], 2),
        "largest_share_of_radius": round(float((y / radius[None, :, None]).max()), 3),
        "limit_share_of_radius": scaling.displacement_limit,
    }


def surface_error(group, methods):
    """Mean error over all carried vertices in mm and as a share of skinning's; `carried_truth`: the nodes'
    true displacement carried, the best that any method on these nodes can do. None where the trajectories
    hold no surface."""
    if any("surface" not in t.tensors for t in group.trajectories):
        return None
    sums = {}
    for i, t in enumerate(group.trajectories):
        true, at = np.asarray(t.tensors["surface"], np.float32), 0
        for r, count in enumerate(t.tensors["region.vertex_count"]):
            carry = np.asarray(t.tensors[f"carry.{r}"])
            nodes = np.asarray(group.body.region) == r
            u = true[1:, at : at + count]
            at += count
            for name, p in {**methods, "carried_truth": truth(group)}.items():
                e = np.linalg.norm(np.einsum("nv,tnd->tvd", carry, p[1:, nodes, i].numpy()) - u, axis=-1)
                sums[name] = sums.get(name, 0) + np.array([e.size, e.sum()])
    return {
        k: {"mean_mm": round(1e3 * e / n, 4), "ratio": round(e / sums["skinning"][1], 4)}
        for k, (n, e) in sums.items()
    }


def by_region(group, methods):
    """region -> method -> ratio over whole sequences, and the mean displacement in mm."""
    u, out = truth(group), {}
    for r in range(group.regions):
        nodes = torch.as_tensor(np.asarray(group.body.region) == r)
        size = u[1:, nodes].norm(dim=-1).mean()
        name = group.body.region_names[r] if r < len(group.body.region_names) else str(r)
        out[name] = {"mean_displacement_mm": round(float(size) * 1e3, 3)}
        out[name].update(
            {
                m: round(float((p[1:, nodes] - u[1:, nodes]).norm(dim=-1).mean() / size), 4)
                for m, p in methods.items()
                if m != "skinning"
            }
        )
    return out


def by_motion(groups_and_methods):
    """motion#seed -> method -> ratio over the whole sequence."""
    out = {}
    for g, methods in groups_and_methods:
        u = truth(g)
        for i, t in enumerate(g.trajectories):
            size = u[1:, :, i].norm(dim=-1).mean()
            out[f"{t.name} {g.ticks} ticks"] = {
                m: round(float((p[1:, :, i] - u[1:, :, i]).norm(dim=-1).mean() / size), 4)
                for m, p in methods.items()
                if m != "skinning"
            }
    return out


def _read(data, split, needed=True):
    try:
        return dataset.group(dataset.read_split(data, split))
    except BadData as error:
        if needed or "no " + split not in str(error):
            raise
        return []


def evaluate(weights, data, out=None):
    """The metrics as a dict, written to out/metrics.json; and what plot.py draws."""
    model, scaling, metadata = read_weights(weights)
    train_groups = _read(data, "train")
    springs = (train_groups[0].body, fit_springs(train_groups[0], False), fit_springs(train_groups[0], True))
    groups = _read(data, "test") + _read(data, "long", needed=False)
    judged = [(g, predictions(model, scaling, springs, g)) for g in groups]
    tally = Tally()
    for g, methods in judged:
        for name, p in methods.items():
            tally.add(name, p, truth(g))
    first, methods = judged[0]
    metrics = {
        "model": {
            "parameters": sum(p.numel() for p in model.parameters()),
            "channels": list(model.options.channels),
            "seed": metadata.get("seed"),
            "trained_minutes": metadata.get("trained_minutes"),
            "recipe": json.loads(metadata.get("recipe", "{}")),
        },
        "held_out": [t.name for g in groups for t in g.trajectories],
        "roll_out": tally.figures(),
        "single_step": single_step(model, scaling, first),
        "rest": stability(model, scaling, first, 1.0),
        "overdrive": stability(model, scaling, first, 3.0),
        "regions": by_region(first, methods),
        "motions": by_motion(judged),
        "surface": surface_error(first, methods),
    }
    if out:
        with open(os.path.join(out, "metrics.json"), "w") as file:
            json.dump(metrics, file, indent=1)
    return metrics, judged


def table(metrics):
    """The roll-out figures as text a person reads."""
    lines = [f"{'ticks':>6}" + "".join(f"{m:>26}" for m in METHODS)]
    for k, row in metrics["roll_out"].items():
        cell = (
            lambda m: f"{row[m]['mean_mm']:.2f} +- {row[m]['sd_mm']:.2f} mm {row[m]['ratio']:.3f}"
            if m in row
            else ""
        )
        lines.append(f"{k:>6}" + "".join(f"{cell(m):>26}" for m in METHODS))
    rest, over = metrics["rest"], metrics["overdrive"]
    lines.append(
        f"at rest: {rest['residue_mean_mm']} mm left (largest {rest['residue_largest_mm']}); driven x3: "
        f"largest {over['largest_mm']} mm, {over['largest_share_of_radius']} of a radius, "
        f"{over['residue_mean_mm']} mm left; largest |c| {over['largest_cell']}"
    )
    return "\n".join(lines)
