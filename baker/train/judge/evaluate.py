"""Judges networks on held-out motions and bodies, with plain models and skinning alone for comparison."""
import json
import math
import os
import time

import numpy as np
import torch

from ..data import dataset
from ..files.safetensors import BadData
from ..model.inputs import DRIVE
from ..model.modal_base import turned
from ..model.rollout import roll_out, single_steps, truth
from ..model.weights import read_weights
from .baselines import plain_models, single_step

TICKS = (10, 20, 30, 40, 50, 100, 200, 600, 3600, 36000)
SKINNING = "skinning"
STILL_TICKS = 3600  # a minute
OVERDRIVE = 3.0
ENDURANCE_TICKS = 3600  # longer roll-outs are left to the models named in `enduring`


class Tally:
    """Sums of errors over many roll-outs, by ticks; millimetres."""

    def __init__(self):
        self.sums = {}

    def add(self, method, predicted, true, above=0):
        """(T+1, N, B, 3) metres both. Figures of `above` ticks and fewer do not change."""
        error = 1e3 * (predicted[1:] - true[1:]).norm(dim=-1).double()
        size = 1e3 * true[1:].norm(dim=-1).double()
        for k in [k for k in TICKS if above < k <= len(error)]:
            e, s = error[:k], size[:k]
            add = np.array([e.numel(), float(e.sum()), float(e.square().sum()), float(s.sum())])
            self.sums[k, method] = self.sums.get((k, method), 0) + add

    def figures(self):
        """ticks -> method -> mean and standard deviation in mm, ratio to skinning alone."""
        out = {}
        for (k, method), (n, e, square, size) in sorted(self.sums.items(), key=lambda item: item[0][0]):
            mean = e / n
            out.setdefault(str(k), {})[method] = {
                "mean_mm": round(mean, 4),
                "sd_mm": round(math.sqrt(max(0, square / n - mean * mean)), 4),
                "ratio": round(e / size, 4) if size > 0 else None,
            }
        return out


class Network:
    """A trained network as a model of baselines.py. run: the folder of a run, or weights as .safetensors."""

    def __init__(self, run):
        path = run if run.endswith(".safetensors") else os.path.join(run, "weights.safetensors")
        self.model, self.scaling, self.metadata = read_weights(path)
        self.parameters = sum(p.numel() for p in self.model.parameters())

    def predict(self, group):
        return roll_out(self.model, self.scaling, group)


def ratio(p, u):
    """Mean distance after the start as a fraction of the mean displacement, four digits."""
    return round(float((p[1:] - u[1:]).norm(dim=-1).mean() / u[1:].norm(dim=-1).mean()), 4)


def by_region(group, methods):
    """region -> method -> ratio over whole sequences, and the mean displacement in mm."""
    u, out = truth(group), {}
    for r, name in enumerate(group.body.region_names):
        nodes = torch.as_tensor(np.asarray(group.body.region) == r)
        out[name] = {"mean_displacement_mm": round(float(u[1:, nodes].norm(dim=-1).mean()) * 1e3, 3)}
        out[name].update({m: ratio(p[:, nodes], u[:, nodes]) for m, p in methods.items() if m != SKINNING})
    return out


def by_motion(group, methods):
    """motion#seed T ticks -> method -> ratio over the whole sequence."""
    u = truth(group)
    return {
        f"{t.name} {group.ticks} ticks": {
            m: ratio(p[:, :, i], u[:, :, i]) for m, p in methods.items() if m != SKINNING
        }
        for i, t in enumerate(group.trajectories)
    }


def _along_tissue(group, p):
    """(T+1, N, B, 3) along the nodes' frames -> along the rotated axes of their tissue, which the surface is embedded in."""
    bend = group.drive[..., DRIVE["bend"]].permute(1, 2, 0, 3)
    return turned(bend[: len(p)], p, transposed=True)


def surface_error(group, methods):
    """Mean error over all embedded vertices in mm and as a fraction of skinning's; `carried_truth`: the nodes'
    true displacement embedded, the best that any method on these nodes can do. None where the trajectories
    hold no surface."""
    if any("surface" not in t.tensors for t in group.trajectories):
        return None
    sums = {}
    along_tissue = {k: _along_tissue(group, p) for k, p in {**methods, "carried_truth": truth(group)}.items()}
    for i, t in enumerate(group.trajectories):
        true, at = np.asarray(t.tensors["surface"], np.float32), 0
        for r, count in enumerate(t.tensors["region.vertex_count"]):
            carry = np.asarray(t.tensors[f"carry.{r}"])
            nodes = np.asarray(group.body.region) == r
            u = true[1:, at : at + count]
            at += count
            for name, p in along_tissue.items():
                carried = np.einsum("nv,tnd->tvd", carry, p[1:, nodes, i].numpy(), optimize=True)
                e = np.linalg.norm(carried - u, axis=-1)
                sums[name] = sums.get(name, 0) + np.array([e.size, e.sum()])
    return {
        k: {"mean_mm": round(1e3 * e / n, 4), "ratio": round(e / sums[SKINNING][1], 4)}
        for k, (n, e) in sums.items()
    }


def energy(group, methods):
    """Sum of (w q)^2 / 2 over the modes, weighted alike: smallest, mean and largest of a method's roll-outs as
    fractions of the truth's mean."""
    def of(p):
        u = group.unflatten(p)
        q = torch.stack([group.base.unwarped(step, torch.zeros_like(step))[1] for step in u[1::4]])
        return (0.5 * (group.base.rad_per_s[None, :, :, None] * q).square()).sum((1, 2))

    with torch.no_grad():
        true = of(truth(group))
        mean = float(true.mean())
        row = lambda e: {k: round(float(getattr(e, k)()) / mean, 4) for k in ("min", "mean", "max")}
        return {"truth": row(true), **{m: row(of(p)) for m, p in methods.items() if m != SKINNING}}


def stability(network, group, gain):
    """Driven for 200 ticks at `gain`, then at rest for a minute: the largest displacement, the remaining one and the
    largest |c|."""
    s, watch, driven = torch.arange(min(3, group.count)), {}, min(200, group.ticks)
    u = roll_out(
        network.model, network.scaling, group, driven + STILL_TICKS, s, gain, still_after=driven, watch=watch
    ).norm(dim=-1)
    height_m = float(group.trajectories[0].metadata["height_m"])
    return {
        "gain": gain,
        "largest_mm": round(1e3 * float(u.max()), 2),
        "residue_mean_mm": round(1e3 * float(u[-1].mean()), 5),
        "residue_largest_mm": round(1e3 * float(u[-1].max()), 5),
        "residue_share_of_height": float(f"{float(u[-1].max()) / height_m:.2e}"),
        "largest_cell": round(watch.get("cell", 0.0), 2),
    }


def operations(network, group):
    """Millions of floating-point operations per tick for the whole body, multiply and add counted separately: the
    network, its graph and its modal base."""
    nodes = len(group.body.region)
    edges = nodes + 2 * len(group.body.edges)
    multiply_adds = 0
    if network is not None:
        multiply_adds += nodes * network.parameters
        widths = [network.model.options.input_width, *network.model.options.channels]
        multiply_adds += edges * (sum(widths[:-1]) + sum(widths[1:]) + 2 * widths[-1])
    for r, b in enumerate(group.body.bases):
        floats = 3 * int((group.body.region == r).sum())
        multiply_adds += floats * floats + (3 if network is None else 4) * floats * len(b["rad_per_s"])
    return round(2e-6 * multiply_adds, 3)


def operations_of_plain(names, group):
    """name -> millions of operations per tick, of plain models."""
    nodes, modes = len(group.body.region), operations(None, group)
    # A recurrence for each of three axes; before it one factor, or two matrices, per node.
    springs = {"spring": 2e-6 * nodes * 12, "node_springs": 2e-6 * nodes * 27}
    return {name: round(springs.get(name, modes), 4) for name in names}


def _read(data, split, body=None, needed=True):
    try:
        return dataset.group(dataset.read_split(data, split, body))
    except BadData as error:
        if needed or "no " + split not in str(error):
            raise
        return []


def judge_body(data, body, networks, enduring, log):
    """Figures of one body's test and long sequences, and what plot.py draws: [(group, method -> roll-out)]."""
    fit_on = next(iter(_read(data, "train", body, needed=False)), None)
    groups = _read(data, "test", body) + _read(data, "long", body, needed=False)
    plain = plain_models(groups[0], fit_on)
    tally, judged = Tally(), []
    for g in groups:
        started = time.monotonic()
        models = {**networks, **plain}
        if g.ticks > ENDURANCE_TICKS:
            models = {k: m for k, m in models.items() if k in enduring}
        methods = {k: m.predict(g) for k, m in models.items()}
        methods[SKINNING] = torch.zeros_like(truth(g))
        for name, p in methods.items():
            tally.add(name, p, truth(g), ENDURANCE_TICKS if g.ticks > ENDURANCE_TICKS else 0)
        judged.append((g, methods))
        log(f"{body}: {g.count} sequences of {g.ticks} ticks judged in {time.monotonic() - started:.0f} s", flush=True)
    first, methods = judged[0]
    steps = {k: ratio(single_steps(n.model, n.scaling, first), truth(first)) for k, n in networks.items()}
    steps["modal_warped"] = ratio(single_steps(None, None, first), truth(first))
    figures = {
        "seen_in_training": fit_on is not None,
        "held_out": [t.name for g in groups for t in g.trajectories],
        "roll_out": tally.figures(),
        "single_step": {**single_step(first), **steps},
        "regions": by_region(first, methods),
        "motions": {k: v for g, m in judged for k, v in by_motion(g, m).items()},
        "surface": surface_error(first, methods),
        "energy": energy(first, methods),
        "operations_mflop": {
            **{k: operations(n, first) for k, n in networks.items()},
            **operations_of_plain(plain, first),
        },
    }
    return figures, judged


def known_motions(data, body, networks):
    """Ratios on the training motions of a body, over whole sequences, to compare the held-out figures with."""
    group = _read(data, "train", body)[0]
    u = truth(group)
    out = {k: ratio(n.predict(group), u) for k, n in networks.items()}
    return {**out, "modal_warped": ratio(roll_out(None, None, group), u)}


def evaluate(runs, data, bodies=None, enduring=(), log=print):
    """runs: name -> folder of a run or weights as .safetensors; the first is the one that is shipped. bodies: those
    to judge, default all with test sequences. Returns the metrics and, for each body, what plot.py draws."""
    networks = {name: Network(run) for name, run in runs.items()}
    named = bodies or list(dict.fromkeys(b for b, _ in dataset.list_split(data, "test")))
    metrics = {"models": {}, "bodies": {}}
    for name, network in networks.items():
        m = network.metadata
        metrics["models"][name] = {
            "parameters": network.parameters,
            "channels": list(network.model.options.channels),
            "seed": m.get("seed"),
            "trained_minutes": m.get("trained_minutes"),
            "validation_ratio": m.get("validation_ratio"),
            "recipe": json.loads(m.get("recipe", "{}")),
        }
    judged = {}
    for body in named:
        metrics["bodies"][body], judged[body] = judge_body(data, body, networks, enduring, log)
    first = judged[named[0]][0][0]
    if metrics["bodies"][named[0]]["seen_in_training"]:
        metrics["known_motions"] = known_motions(data, named[0], networks)
    for name, network in networks.items():
        metrics["models"][name]["left_alone"] = [stability(network, first, gain) for gain in (1.0, OVERDRIVE)]
    return metrics, judged


def _cell(figures):
    if figures is None:
        return ""
    return f"{figures['mean_mm']:.2f} mm" + ("" if figures["ratio"] is None else f" {figures['ratio']:.3f}")


def table(metrics, body):
    """A body's roll-out figures as text for a terminal."""
    rows = metrics["bodies"][body]["roll_out"]
    methods = list(dict.fromkeys(m for row in rows.values() for m in row))
    lines = [f"{body:>12}" + "".join(f"{m:>22}" for m in methods)]
    for k, row in rows.items():
        lines.append(f"{k:>12}" + "".join(f"{_cell(row.get(m)):>22}" for m in methods))
    return "\n".join(lines)
