"""Pictures of a network's errors and of its training."""
import json

import torch

from .rollout import truth

COLOURS = {"network": "#c2410c", "spring": "#2563eb", "two_springs": "#0f766e", "skinning": "#6b7280"}
LABELS = {
    "network": "network",
    "spring": "damped spring",
    "two_springs": "two damped springs",
    "skinning": "skinning alone",
}


def _ratios(axes, metrics):
    for method in COLOURS:
        points = [(int(k), row[method]["ratio"]) for k, row in metrics["roll_out"].items() if method in row]
        axes.plot(*zip(*points), "o-", color=COLOURS[method], label=LABELS[method], markersize=3.5)
    axes.set_xscale("log")
    axes.set_ylim(0, 1.15)
    axes.set_xlabel("ticks from rest (60 a second)")
    axes.set_ylabel("error / error of skinning alone")
    axes.set_title("Roll-outs on held-out motions")
    axes.legend(frameon=False, fontsize=8)


def _trace(axes, judged):
    """The liveliest node of the first held-out sequence, along its liveliest axis."""
    group, methods = judged[0]
    u = truth(group)[:, :, 0]
    node, axis = divmod(int(u.square().mean(0).argmax()), 3)
    seconds = torch.arange(len(u)) / group.trajectories[0].rate_hz
    axes.plot(seconds, 1e3 * u[:, node, axis], color="black", linewidth=2, label="ground truth")
    for method in ("network", "spring"):
        if method in methods:
            axes.plot(
                seconds,
                1e3 * methods[method][:, node, 0, axis],
                color=COLOURS[method],
                linewidth=1.2,
                label=LABELS[method],
            )
    axes.set_xlabel("time (s)")
    axes.set_ylabel(f"displacement along {'xyz'[axis]} (mm)")
    axes.set_title(f"One node, {group.trajectories[0].name}")
    axes.legend(frameon=False, fontsize=8)


def _training(axes, curve):
    minutes = [p["minutes"] for p in curve]
    for key, colour in (("ratio_50", "#c2410c"), ("ratio_150", "#2563eb"), ("ratio_all", "#0f766e")):
        if key in curve[0]:
            axes.plot(minutes, [p[key] for p in curve], color=colour, label=key.replace("ratio_", "ticks: "))
    axes.set_ylim(0, 1.15)
    axes.set_xlabel("training (minutes)")
    axes.set_ylabel("validation error / skinning alone")
    axes.set_title("Training")
    axes.legend(frameon=False, fontsize=8)


def draw(metrics, judged, curve_file, out):
    """out: a .png or .svg."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    with open(curve_file) as file:
        curve = json.load(file)["curve"]
    figure, axes = pyplot.subplots(1, 3, figsize=(13, 3.8))
    _ratios(axes[0], metrics)
    _trace(axes[1], judged)
    _training(axes[2], curve)
    for a in axes:
        a.grid(alpha=0.25)
        a.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(out, dpi=100)
    pyplot.close(figure)
