"""Pictures of the evaluation page."""
import json
import os

import torch

from ..model.rollout import truth
from .evaluate import SKINNING

COLOURS = ["#c2410c", "#db2777", "#7c3aed", "#0f766e", "#2563eb", "#65a30d", "#a16207", "#0891b2", "#4b5563"]
LABELS = {
    "modal_linear": "modal, linear",
    "modal_linear_fitted": "modal, linear, fitted",
    "modal_warped": "modal, warped",
    "modal_warped_fitted": "modal, warped, fitted",
    "node_springs": "one spring per node, fitted",
    "spring": "one spring per region, fitted",
    SKINNING: "skinning alone",
}


def label_of(method):
    return LABELS.get(method, method.replace("_", " "))


def _pyplot():
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    return pyplot


def _finish(figure, axes, path):
    for a in axes:
        a.grid(alpha=0.25)
        a.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    _pyplot().close(figure)


def colours_of(methods):
    return {m: COLOURS[i % len(COLOURS)] for i, m in enumerate(m for m in methods if m != SKINNING)}


def roll_outs(metrics, path):
    """Error against roll-out length, one panel per body, and the legend in a further panel."""
    bodies = list(metrics["bodies"])
    across = min(4, len(bodies) + 1)
    down = len(bodies) // across + 1
    figure, grid = _pyplot().subplots(down, across, figsize=(4.6 * across, 3.8 * down), squeeze=False)
    axes, spare = grid.flat[: len(bodies)], grid.flat[len(bodies) :]
    for a, body in zip(axes, bodies):
        rows = metrics["bodies"][body]["roll_out"]
        colours = colours_of(dict.fromkeys(m for row in rows.values() for m in row))
        for method, colour in colours.items():
            points = [(int(k), row[method]["ratio"]) for k, row in rows.items() if method in row]
            a.plot(*zip(*points), "o-", color=colour, label=label_of(method), markersize=3, linewidth=1.3)
        a.axhline(1, color="#6b7280", linewidth=1, linestyle="--")
        a.set_xscale("log"), a.set_yscale("log"), a.set_ylim(0.02, 1.6)
        a.set_xlabel("ticks from rest (60 a second)")
        seen = "" if metrics["bodies"][body]["seen_in_training"] else ", not trained on"
        a.set_title(body + seen, fontsize=10)
        a.set_ylabel("error / error of skinning alone")
    for a in spare:
        a.axis("off")
    spare[0].legend(*axes[0].get_legend_handles_labels(), frameon=False, fontsize=9, loc="upper left")
    _finish(figure, axes, path)


def trace(judged, methods, path):
    """The liveliest node of the first held-out sequence, along its liveliest axis."""
    group, predicted = judged[0]
    u = truth(group)[:, :, 0]
    node, axis = divmod(int(u.square().mean(0).argmax()), 3)
    seconds = torch.arange(len(u)) / group.trajectories[0].rate_hz
    figure, a = _pyplot().subplots(figsize=(9, 3.6))
    a.plot(seconds, 1e3 * u[:, node, axis], color="black", linewidth=2.4, label="ground truth")
    for method, colour in colours_of(m for m in methods if m in predicted).items():
        p = 1e3 * predicted[method][:, node, 0, axis]
        a.plot(seconds, p, color=colour, linewidth=1.2, label=label_of(method))
    a.set_xlabel("time (s)")
    a.set_ylabel(f"displacement along {'xyz'[axis]} (mm)")
    motion = group.trajectories[0].name
    a.set_title(f"One node of {group.name}, {motion}: roll-out from rest", fontsize=10)
    a.legend(frameon=False, fontsize=8)
    _finish(figure, [a], path)


def cost(metrics, body, ticks, path):
    """Error against operations a tick, for the models whose operations are known."""
    figure, a = _pyplot().subplots(figsize=(5.6, 4))
    figures = metrics["bodies"][body]
    row, operations = figures["roll_out"][str(ticks)], figures["operations_mflop"]
    colours = colours_of(m for m in row if m in operations)
    for method in sorted(colours, key=lambda m: -row[m]["ratio"]):
        x, y = operations[method], row[method]["ratio"]
        a.plot(x, y, "o", color=colours[method], label=f"{label_of(method)}: {y:.3f}")
    a.set_xscale("log")
    a.margins(x=0.3, y=0.1)
    a.autoscale()
    a.set_ylim(bottom=0)
    a.set_xlabel("million operations a tick, whole body")
    a.set_ylabel(f"error / skinning alone, {ticks} ticks")
    a.legend(frameon=False, fontsize=8)
    _finish(figure, [a], path)


def regions(metrics, body, path):
    """Ratio of each method in each soft region."""
    figure, a = _pyplot().subplots(figsize=(9, 3.6))
    rows = metrics["bodies"][body]["regions"]
    methods = [m for m in next(iter(rows.values())) if m != "mean_displacement_mm"]
    width = 0.8 / len(methods)
    for i, (method, colour) in enumerate(colours_of(methods).items()):
        places, heights = [x + i * width for x in range(len(rows))], [r[method] for r in rows.values()]
        a.bar(places, heights, width, color=colour, label=label_of(method))
    names = [f"{k}\n{r['mean_displacement_mm']:.1f} mm" for k, r in rows.items()]
    a.set_xticks([x + 0.4 - width / 2 for x in range(len(rows))], names, fontsize=8)
    a.set_ylabel("error / skinning alone")
    a.set_ylim(0, 1.35)
    a.legend(frameon=False, fontsize=7, ncol=3, loc="upper left")
    _finish(figure, [a], path)


def training(runs, path):
    """Validation errors of the runs while they trained; no picture where no run has a curve. runs: name -> folder."""
    curves = {}
    for name, run in runs.items():
        curve = os.path.join(run, "curve.json")
        if os.path.exists(curve):
            with open(curve) as file:
                curves[name] = json.load(file)["curve"]
    if not curves:
        return
    figure, a = _pyplot().subplots(figsize=(6, 3.6))
    for (name, points), colour in zip(curves.items(), COLOURS):
        minutes, ratios = [p["minutes"] for p in points], [p["ratio_all"] for p in points]
        a.plot(minutes, ratios, color=colour, label=label_of(name))
    a.set_xlabel("training (minutes of one core)")
    a.set_ylabel("validation error / skinning alone")
    a.legend(frameon=False, fontsize=8)
    _finish(figure, [a], path)
