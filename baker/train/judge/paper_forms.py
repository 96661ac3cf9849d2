"""The vanilla ConvLSTM in the four forms of Deng, Mu, Hu 2020 and Alt-ConvLSTM: all trained alike on one body,
judged as in their Tables 1 and 2 on its held-out motions.

CP: the network is given the drive of the last tick, NP: of this one. It predicts the displacement (Y) or its change
(ΔY), without a modal base except where one is named."""
import math
import os

import torch

from ..model.inputs import crossed_with
from ..model.rollout import roll_out, single_steps, truth
from . import plot
from .evaluate import SKINNING, Tally
from .variants import judged_on, train_variants, write_comparison

_BASE = ("base", "base_step", "turn")
ALONE = ["--without", ",".join((*_BASE, *crossed_with(*_BASE)))]
CHANGE, WHOLE = ["--output-scale", "0.15"], ["--output-scale", "1"]  # length units, for an output of 1
# name -> options of `baker/train train`
MODELS = {
    "ConvLSTM CP ΔY": ["--form", "CP_dY", *CHANGE, *ALONE],
    "ConvLSTM CP Y": ["--form", "CP_Y", *WHOLE, *ALONE],
    "ConvLSTM NP ΔY": ["--form", "NP_dY", *CHANGE, *ALONE],
    "ConvLSTM NP Y": ["--form", "NP_Y", *WHOLE, *ALONE],
    "Alt-ConvLSTM": ALONE,
}
ON_THE_BASE = {"ConvLSTM NP ΔY on the modal base": ["--form", "NP_dY"], "Alt-ConvLSTM on the modal base": []}
FORCED = ", single steps"
VARIANTS = {
    **MODELS,
    **ON_THE_BASE,
    **{name + FORCED: [*options, "--teacher-forced", "1"] for name, options in MODELS.items()},
}
SINGLE = "single step"
DIVERGED = 10  # times the error of skinning alone
HEAD = ("model", "parameters", "ticks", "mean_mm", "sd_mm", "ratio")  # ticks of roll-out, or SINGLE


def _finite(figures):
    return {k: v if v is not None and math.isfinite(v) else None for k, v in figures.items()}


def _tally(models, groups, predict, **plain):
    """ticks -> name -> figures. predict: roll_out or single_steps; plain: name -> (truth -> prediction)."""
    tally = Tally()
    for g in groups:
        u = truth(g)
        for name, model in models.items():
            tally.add(name, predict(*model, g), u)
        for name, guess in {**plain, SKINNING: torch.zeros_like}.items():
            tally.add(name.replace("_", " "), guess(u), u)
    return tally.figures()


def _judge(networks, groups):
    """name -> figures by roll-out length, and of single steps from the true displacement in the short motions."""
    models = {**{name: (n.model, n.scaling) for name, n in networks.items()}, "modal_warped": (None, None)}
    before = lambda u, k: torch.cat([u[:1].expand(k, -1, -1, -1), u[:-k]])
    velocity_kept = lambda u: 2 * before(u, 1) - before(u, 2)
    held = dict(displacement_held=lambda u: before(u, 1), velocity_kept=velocity_kept)
    steps = _tally(models, groups[:1], single_steps, **held)
    columns = {SINGLE: steps[max(steps, key=int)], **_tally(models, groups, roll_out)}
    names = columns[SINGLE]
    rows = {n: {k: _finite(c[n]) for k, c in columns.items() if n in c} for n in names}
    for name, network in networks.items():
        rows[name]["parameters"] = network.parameters
    return rows


def _csv_rows(rows):
    """Empty where a roll-out left the range of numbers."""
    for name, row in rows.items():
        for ticks, figures in row.items():
            if ticks != "parameters":
                yield [name, row.get("parameters", ""), ticks, *(figures[k] for k in HEAD[3:])]


def _draw(rows, path):
    """Ratio against roll-out length; broken lines were trained on single steps."""
    figure, a = plot._pyplot().subplots(figsize=(9, 4.8))
    kept = {n: r for n, r in rows.items() if n in VARIANTS or n == "modal_warped"}
    colours = plot.colours_of(dict.fromkeys(n.removesuffix(FORCED) for n in kept))
    for name, row in kept.items():
        points = [(int(k), c["ratio"]) for k, c in row.items() if k not in (SINGLE, "parameters")]
        drawn = [(k, min(v, DIVERGED)) for k, v in points if v is not None]
        style, colour = "o--" if name.endswith(FORCED) else "o-", colours[name.removesuffix(FORCED)]
        label = plot.label_of(name)
        a.plot(*zip(*drawn), style, color=colour, label=label, markersize=3, linewidth=1.2)
    a.axhline(1, color="#6b7280", linewidth=1)
    a.set_xscale("log"), a.set_yscale("log"), a.set_ylim(0.015, DIVERGED)
    a.set_xlabel("ticks from rest (60 a second)")
    a.set_ylabel(f"error / error of skinning alone (ends at {DIVERGED})")
    a.legend(frameon=False, fontsize=7, loc="center left", bbox_to_anchor=(1, 0.5))
    plot._finish(figure, [a], path)


def compare_forms(data, body, work, out, minutes, processes):
    """Writes out/vanilla.json, vanilla.csv and vanilla.png."""
    groups = judged_on(data, body)  # first: what is unusable is refused before training
    rows = _judge(train_variants(VARIANTS, data, body, work, minutes, processes), groups)
    os.makedirs(out, exist_ok=True)
    _draw(rows, os.path.join(out, "vanilla.png"))
    figures = {"body": body, "minutes": minutes, "diverged_above": DIVERGED, "rows": rows}
    write_comparison(out, "vanilla", figures, HEAD, _csv_rows(rows))
