"""Ablations: small variants of the recipe, trained alike on one body and judged on its held-out motions."""
import os

from ..model.inputs import CROSSED, crossed_with
from ..model.rollout import error_ratio, truth
from . import plot
from .evaluate import ratio
from .variants import judged_on, train_variants, write_comparison

_without = lambda *names: ["--without", ",".join((*names, *crossed_with(*names)))]

# name -> options of `baker/train train`
VARIANTS = {
    "as shipped": [],
    "no modal base": _without("base", "base_step", "turn"),
    "displacement not fed back": _without("displacement", "velocity"),
    "no inertial acceleration": _without("felt_step"),
    "no bend": _without("bend"),
    "no crossed inputs": ["--without", ",".join(CROSSED)],
    "no leak in hidden layers": ["--hidden-leak", "0"],
    "gradients over 5 ticks": ["--window", "5"],
    "channels 3": ["--channels", "3"],
    "channels 16, 3": ["--channels", "16,3"],
    "channels 32, 3": ["--channels", "32,3"],
    "channels 8, 8, 3": ["--channels", "8,8,3"],
}
TICKS = (10, 50, 200)


def _judge(network, groups):
    row = {}
    for g in groups:
        p, u = network.predict(g), truth(g)
        if g.ticks <= 600:
            row.update({str(k): round(error_ratio(p, u, k), 4) for k in TICKS})
        else:
            row[str(g.ticks)] = ratio(p, u)
    return {"parameters": network.parameters, **row}


def _draw(rows, path):
    figure, a = plot._pyplot().subplots(figsize=(8, 0.45 * len(rows) + 1))
    keys = [k for k in next(iter(rows.values())) if k != "parameters"]
    height = 0.8 / len(keys)
    for i, (k, colour) in enumerate(zip(keys, plot.COLOURS)):
        places, lengths = [y + i * height for y in range(len(rows))], [min(r[k], 2) for r in rows.values()]
        a.barh(places, lengths, height, color=colour, label=f"{int(k):,} ticks")
    a.set_yticks([y + 0.3 for y in range(len(rows))], list(rows), fontsize=8)
    a.invert_yaxis()
    a.set_xlabel("error / error of skinning alone (bars end at 2)")
    a.legend(frameon=False, fontsize=8, loc="lower right")
    plot._finish(figure, [a], path)


def ablate(data, body, work, out, minutes, processes):
    """Writes out/ablations.json, ablations.csv and ablations.png."""
    groups = judged_on(data, body)  # first: what is unusable is refused before training
    variants = {**VARIANTS, "a quarter of the time": ["--minutes", f"{minutes / 4:g}"]}
    networks = train_variants(variants, data, body, work, minutes, processes)
    rows = {name: _judge(network, groups) for name, network in networks.items()}
    keys = list(next(iter(rows.values())))
    head = ["variant", *(k if k == "parameters" else f"error_ratio_{k}_ticks" for k in keys)]
    os.makedirs(out, exist_ok=True)
    _draw(rows, os.path.join(out, "ablations.png"))
    figures = {"body": body, "minutes": minutes, "rows": rows}
    write_comparison(out, "ablations", figures, head, [[name, *(row[k] for k in keys)] for name, row in rows.items()])
