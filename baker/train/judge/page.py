"""The evaluation page: tables and pictures of one evaluation, as Markdown."""
import json
import os

from ..files.write_file import write_json, write_text
from . import plot

# Deng, Mu, Hu 2020, D-FAUST: mm, ratio
PAPER = {10: (2.32, 0.12), 20: (3.4, 0.17), 30: (5.18, 0.27), 50: (7.9, 0.40)}
SHEET = "../pictures/hop_sheet.jpg"
SECTIONS = {  # of other commands: what they wrote -> its title
    "ablations.md": "What each part of the recipe is worth",
    "vanilla.md": "The paper's comparison: vanilla ConvLSTM",
}


def _row(cells):
    return "| " + " | ".join(str(c) for c in cells) + " |"


def table(head, rows):
    return "\n".join([_row(head), _row("---" for _ in head)] + [_row(r) for r in rows])


def _methods(rows):
    return list(dict.fromkeys(m for row in rows.values() for m in row))


def roll_out_table(figures):
    """Mean and standard deviation in mm and the ratio to skinning alone, by ticks and method."""
    rows = figures["roll_out"]
    cell = lambda c: f"{c['mean_mm']:.2f} ± {c['sd_mm']:.2f} ({c['ratio']:.3f})" if c else ""
    methods = _methods(rows)
    body = [[plot.label_of(m)] + [cell(row.get(m)) for row in rows.values()] for m in methods]
    return table(["error, mm (ratio)"] + [f"{int(k):,}" for k in rows], body)


def single_step_table(figures):
    names = {"hold": "displacement held", "constant_velocity": "velocity kept"}
    rows = [[names.get(k, plot.label_of(k)), f"{v:.3f}"] for k, v in figures["single_step"].items()]
    return table(["one tick from the true state", "ratio to skinning alone"], rows)


def motion_table(figures):
    rows, first = figures["motions"], next(iter(figures["motions"].values()))
    methods = list(first)
    body = [[k] + [f"{row[m]:.3f}" if m in row else "" for m in methods] for k, row in rows.items()]
    return table(["motion"] + [plot.label_of(m) for m in methods], body)


def energy_table(figures):
    row = lambda method, sums: [plot.label_of(method)] + [f"{sums[c]:.2f}" for c in ("min", "mean", "max")]
    rows = [row(*item) for item in figures["energy"].items()]
    return table(["sum of (w q)² / 2 over the modes, truth's mean = 1", "least", "mean", "largest"], rows)


def surface_line(figures):
    if not figures["surface"]:
        return ""
    part = lambda method, v: f"{plot.label_of(method)} {v['mean_mm']:.2f} mm ({v['ratio']:.3f})"
    parts = [part(*item) for item in figures["surface"].items()]
    return "On the whole carried surface: " + "; ".join(parts) + ".\n"


def model_table(metrics, body):
    operations = metrics["bodies"][body]["operations_mflop"]
    columns = {
        "network": lambda k, m: k,
        "parameters": lambda k, m: f"{m['parameters']:,}",
        "channels": lambda k, m: ", ".join(map(str, m["channels"])),
        f"MFLOP a tick, {body}": lambda k, m: operations.get(k, ""),
        "minutes of one core": lambda k, m: m["trained_minutes"],
        "validation": lambda k, m: m["validation_ratio"],
        "seed": lambda k, m: m["seed"],
    }
    return table(columns, [[cell(*item) for cell in columns.values()] for item in metrics["models"].items()])


def stability_table(metrics):
    columns = {
        "network": lambda m: m["network"],
        "drive": lambda m: f"x {m['gain']:g}",
        "largest, mm": lambda m: m["largest_mm"],
        "largest cell": lambda m: m["largest_cell"],
        "left after a minute, mean mm": lambda m: m["residue_mean_mm"],
        "largest mm": lambda m: m["residue_largest_mm"],
        "share of height": lambda m: f"{100 * m['residue_share_of_height']:.4f} %",
    }
    rows = [{"network": name, **row} for name, m in metrics["models"].items() for row in m["left_alone"]]
    return table(columns, [[cell(m) for cell in columns.values()] for m in rows])


def body_section(metrics, body):
    figures = metrics["bodies"][body]
    seen = "trained on, other motions" if figures["seen_in_training"] else "never trained on"
    return (
        f"## {body} ({seen})\n\n{roll_out_table(figures)}\n\n{surface_line(figures)}\n"
        f"{single_step_table(figures)}\n\n"
        f"![error in each region](regions_{body}.png)\n\n{motion_table(figures)}\n\n{energy_table(figures)}\n"
    )


def _draw(metrics, judged, runs, folder):
    bodies, place = list(metrics["bodies"]), lambda name: os.path.join(folder, name)
    rows = metrics["bodies"][bodies[0]]["roll_out"]
    longest = max((int(k) for k in rows if len(rows[k]) > 3), default=50)
    shown = [next(iter(metrics["models"])), "modal_warped", "node_springs"]
    plot.roll_outs(metrics, place("roll_outs.png"))
    plot.trace(judged[bodies[0]], shown, place("trace.png"))
    plot.cost(metrics, bodies[0], min(longest, 600), place("cost.png"))
    plot.training(runs, place("training.png"))
    for body in bodies:
        plot.regions(metrics, body, place(f"regions_{body}.png"))


def _known(metrics):
    known = metrics.get("known_motions", {})
    figures = ", ".join(f"{plot.label_of(k)} {v:.3f}" for k, v in known.items())
    return f"Whole training motions, for comparison: {figures}.\n" if known else ""


def _beside(folder):
    """What other commands and pictures add to the page, where they are there."""
    parts = []
    if os.path.exists(os.path.join(folder, SHEET)):
        parts.append(f"![skinning, Sinew, truth and errors in a hop that was never trained on]({SHEET})\n")
    if os.path.exists(os.path.join(folder, "data_sheet.json")):
        sheet = "[data_sheet.json](data_sheet.json)"
        parts.append(f"What the networks were trained and judged on, in figures: {sheet}.\n")
    if os.path.exists(os.path.join(folder, "every_vertex", "README.md")):
        parts.append("The paper's own network, on every vertex: [every_vertex](every_vertex/README.md).\n")
    if os.path.exists(os.path.join(folder, "confirmation", "README.md")):
        parts.append(
            "The recipe was developed with these test motions in sight. On motions drawn after it was decided: "
            "[confirmation](confirmation/README.md).\n"
        )
    if os.path.exists(os.path.join(folder, "characters", "README.md")):
        parts.append("Characters of others, and what networks of their own are worth: [characters](characters/README.md).\n")
    for name, title in SECTIONS.items():
        if os.path.exists(os.path.join(folder, name)):
            with open(os.path.join(folder, name)) as file:
                parts.append(f"## {title}\n\n{file.read()}")
    return parts


def write_page_text(folder):
    """folder/README.md, from metrics.json and what lies beside it."""
    with open(os.path.join(folder, "metrics.json")) as file:
        metrics = json.load(file)
    bodies = list(metrics["bodies"])
    paper = ", ".join(f"{k} steps {mm} mm ({r})" for k, (mm, r) in PAPER.items())
    parts = [
        "# How far the tissue is from the truth\n",
        "Made by `baker/train evaluate`; figures in `metrics.json`. Errors are distances between control "
        "nodes and the finite-element truth, mean ± standard deviation over nodes, ticks and sequences; a "
        "ratio is to the error of skinning alone. Every roll-out starts at rest and feeds on its own output. "
        "No weights were trained or chosen on test motions and bodies; plain models are fitted on the training "
        "motions of the body they are judged on.\n",
        "![error against roll-out length](roll_outs.png)\n",
        model_table(metrics, bodies[0]) + "\n",
        "![a node](trace.png)\n\n![error against cost](cost.png) ![training](training.png)\n",
        _known(metrics),
        "The paper's own figures, on captured bodies that are not available here (Deng, Mu, Hu 2020): "
        f"{paper}.\n",
        f"## Driven, then left alone for a minute\n\n{stability_table(metrics)}\n",
        *_beside(folder),
        *(body_section(metrics, b) for b in bodies),
    ]
    write_text(os.path.join(folder, "README.md"), "\n".join(p for p in parts if p))


def write_page(metrics, judged, runs, folder):
    """folder/README.md, its pictures, and metrics.json."""
    os.makedirs(folder, exist_ok=True)
    write_json(os.path.join(folder, "metrics.json"), metrics)
    _draw(metrics, judged, runs, folder)
    write_page_text(folder)
