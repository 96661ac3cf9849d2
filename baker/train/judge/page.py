"""The files of one evaluation: metrics.json, errors.csv with every figure in rows, pictures and README.md."""
import csv
import io
import json
import os

from ..files.write_file import write_json, write_text
from . import plot

TICKS = ("50", "200", "600", "3600")  # columns of the page's table
BASE, SPRINGS, SKINNING = "modal_warped", ("spring", "node_springs"), "skinning"
HEAD = ("table", "body", "method", "case", "measure", "value")
# name of a file or folder -> what the page calls it, where it exists
LINKS = {
    "errors.csv": "every figure",
    "cost.png": "error against operations",
    "training.png": "training",
    "data_sheet.json": "data set",
    "ablations.csv": "ablations",
    "vanilla.csv": "the paper's vanilla ConvLSTM",
    "characters": "networks of single characters",
    "truth": "the ground truth's own error",
}


def table(head, rows):
    """Markdown."""
    row = lambda cells: "| " + " | ".join(str(c) for c in cells) + " |"
    return "\n".join([row(head), row("---" for _ in head)] + [row(r) for r in rows])


def write_csv(path, head, rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([head, *rows])
    write_text(path, text.getvalue())


def _read(folder):
    with open(os.path.join(folder, "metrics.json")) as file:
        return json.load(file)


def _network_rows(name, model):
    for key in ("parameters", "channels", "seed", "trained_minutes", "validation_ratio"):
        value = model[key]
        yield "network", "", name, "", key, " ".join(map(str, value)) if isinstance(value, list) else value
    for alone in model["left_alone"]:
        for key in alone.keys() - {"gain"}:
            yield "left_alone", "", name, f"drive x {alone['gain']:g}", key, alone[key]


def _by_method(name, body, case, row):
    """Rows of method -> figure, or of method -> measure -> figure."""
    for method, value in row.items():
        for measure, figure in (value if isinstance(value, dict) else {"ratio": value}).items():
            yield name, body, method, case, measure, "" if figure is None else figure


def _body_rows(body, figures):
    for name in ("roll_out", "motions"):
        for case, row in figures[name].items():
            yield from _by_method(name, body, case, row)
    for region, row in figures["regions"].items():
        of = lambda m: "mean_displacement_mm" if m == "mean_displacement_mm" else "ratio"
        for method, value in row.items():
            yield "regions", body, "truth" if of(method) != "ratio" else method, region, of(method), value
    for name in ("single_step", "surface", "energy"):
        yield from _by_method(name, body, "", figures[name] or {})
    for method, value in figures["operations_mflop"].items():
        yield "operations", body, method, "", "mflop_per_tick", value


def error_rows(metrics):
    """Every figure of an evaluation, one a row, sorted within a table as metrics.json is."""
    for name, model in metrics["models"].items():
        yield from sorted(_network_rows(name, model), key=lambda r: r[:5])
    for body, figures in metrics["bodies"].items():
        yield from _body_rows(body, figures)
    yield from _by_method("training_motions", next(iter(metrics["bodies"])), "", metrics.get("known_motions", {}))


def _ratio(figures, ticks, method):
    return figures["roll_out"].get(ticks, {}).get(method, {}).get("ratio")


def _longest(figures):
    """The largest of TICKS that a body was judged over, or None."""
    return max((k for k in TICKS if k in figures["roll_out"]), key=int, default=None)


def _best_spring(metrics):
    """The method of SPRINGS with the smaller error on the first body over _longest ticks; None where none was fitted."""
    figures = next(iter(metrics["bodies"].values()))
    ticks = _longest(figures)
    ratios = {m: _ratio(figures, ticks, m) for m in SPRINGS}
    return min((m for m in SPRINGS if ratios[m] is not None), key=ratios.get, default=None)


def _main_table(metrics):
    bodies = metrics["bodies"]
    columns = [(b, k) for b, f in bodies.items() for k in TICKS if k in f["roll_out"]]
    spring = _best_spring(metrics)
    labels = {SKINNING: "skinning", spring: f"best spring ({plot.label_of(spring or SPRINGS[0])})", BASE: "modal base"}
    labels.update({name: f"network `{name}`" for name in metrics["models"]})
    cell = lambda value: "–" if value is None else f"{value:.3f}"
    rows = [[label, *(cell(_ratio(bodies[b], k, m)) for b, k in columns)] for m, label in labels.items() if m]
    first = {next(i for i, c in enumerate(columns) if c[0] == b): b for b in bodies if b in dict(columns)}
    head = [f"{first[i]}, {int(k):,}" if i in first else f"{int(k):,}" for i, (_, k) in enumerate(columns)]
    return table(["body, ticks", *head], rows)


def _seen(metrics):
    """Which bodies the networks were trained on."""
    names = lambda seen: [f"`{b}`" for b, f in metrics["bodies"].items() if f["seen_in_training"] is seen]
    known, unseen = names(True), names(False)
    parts = [f"Training had {' and '.join(known)} in other motions"] if known else []
    parts += [f"{'never ' if known else 'Training never had '}{' and '.join(unseen)}"] if unseen else []
    springs = "; springs are fitted on the judged body's training motions" if _best_spring(metrics) else ""
    return ", ".join(parts) + springs + "."


def _where_the_base_is_as_good(metrics):
    name, parts = next(iter(metrics["models"])), []
    for body, figures in metrics["bodies"].items():
        both = {k: (_ratio(figures, k, name), _ratio(figures, k, BASE)) for k in figures["roll_out"]}
        ticks = [f"{int(k):,}" for k, pair in both.items() if None not in pair and pair[0] >= pair[1]]
        parts += [f"on `{body}` over {', '.join(ticks)} ticks"] if ticks else []
    return f"The modal base alone is at least as good {'; '.join(parts)}." if parts else ""


def _size_of_errors(metrics):
    body, figures = next(iter(metrics["bodies"].items()))
    ticks = _longest(figures)
    if ticks is None:
        return ""
    row, name = figures["roll_out"][ticks], next(iter(metrics["models"]))
    return (
        f"On `{body}` the error over {int(ticks):,} ticks is {row[SKINNING]['mean_mm']:.1f} mm for skinning, "
        f"{row[name]['mean_mm']:.1f} mm for the network."
    )


def _left_alone(metrics):
    alone = next(iter(metrics["models"].values()))["left_alone"][-1]
    return (
        f"After 200 ticks of {alone['gain']:g} times the drive and a minute of rest, at most "
        f"{max(alone['residue_largest_mm'], 1e-4):.2g} mm remain."
    )


def _confirmed(folder):
    """Errors on motions that were drawn after the recipe was decided, where they were judged."""
    folder = os.path.join(folder, "confirmation")
    if not os.path.exists(os.path.join(folder, "metrics.json")):
        return ""
    metrics = _read(folder)
    name, parts = next(iter(metrics["models"])), []
    for body, figures in metrics["bodies"].items():
        ticks = _longest(figures)
        if ticks:
            cells = f"{_ratio(figures, ticks, name):.3f} (modal base {_ratio(figures, ticks, BASE):.3f})"
            parts.append(f"{cells} on `{body}` over {int(ticks):,} ticks")
    return (
        "The recipe was developed with these test motions visible. On motions drawn after it was decided the "
        f"network leaves {' and '.join(parts)} ([figures](confirmation/errors.csv))."
    )


def _links(metrics, folder):
    there = lambda name: os.path.exists(os.path.join(folder, name))
    links = [f"[{title}]({name}{'/README.md' if '.' not in name else ''})" for name, title in LINKS.items() if there(name)]
    regions = ", ".join(f"[{b}](regions_{b}.png)" for b in metrics["bodies"] if there(f"regions_{b}.png"))
    return "Also: " + ", ".join(links) + (f"; regions of {regions}." if regions else ".")


def page(metrics, folder):
    """The text of README.md; links lead to what exists in folder."""
    name, model = next(iter(metrics["models"].items()))
    channels, seed = ", ".join(map(str, model["channels"])), model["seed"]
    paragraphs = [
        "# Errors of the soft-tissue models",
        "Mean distances of control nodes from the finite-element ground truth on held-out motions, as a fraction of the "
        "error of skinning alone. Roll-outs start at rest and run on their own output for so many ticks (60 a second).",
        _main_table(metrics),
        " ".join(p for p in (_seen(metrics), _size_of_errors(metrics), _where_the_base_is_as_good(metrics), _left_alone(metrics)) if p),
        "![error against roll-out length](roll_outs.png)",
        "![displacement of one node over time](trace.png)",
        "**Held out.** The plan's held-out clip occurs in no training or validation motion, not inside random ones either; "
        "test seeds and test bodies are used for nothing else. " + _confirmed(folder),
        "**Make it again.** `baker/train/retrain.sh` simulates data, trains and writes this folder. For given weights and "
        "data of `baker/train generate`:\n\n"
        f"    python3 baker/train evaluate DATA --run {name}=assets/weights/{name}.safetensors --out assets/evaluation",
        f"**Limits.** One network ({channels} channels, {model['parameters']:,} parameters, seed {seed}), bodies of one "
        "family, a simulated truth on one voxel cage: a finer cage swings otherwise by more than these errors "
        "([its own error](truth/README.md)). Deng, Mu, Hu 2020 report 0.12 after 10 and 0.40 after 50 steps on captured bodies, "
        "which are not available here.",
        _links(metrics, folder),
    ]
    return "\n\n".join(p.strip() for p in paragraphs) + "\n"


def write_page_text(folder):
    """README.md of a folder, from its metrics.json."""
    write_text(os.path.join(folder, "README.md"), page(_read(folder), folder))


def _draw(metrics, judged, runs, folder):
    bodies, place = list(metrics["bodies"]), lambda name: os.path.join(folder, name)
    rows = metrics["bodies"][bodies[0]]["roll_out"]
    longest = max((int(k) for k in rows if len(rows[k]) > 3), default=50)
    shown = [next(iter(metrics["models"])), BASE, "node_springs"]
    plot.roll_outs(metrics, place("roll_outs.png"))
    plot.trace(judged[bodies[0]], shown, place("trace.png"))
    plot.cost(metrics, bodies[0], min(longest, 600), place("cost.png"))
    plot.training(runs, place("training.png"))
    for body in bodies:
        plot.regions(metrics, body, place(f"regions_{body}.png"))


def write_evaluation(metrics, judged, runs, folder, with_page=True):
    """metrics.json and errors.csv in folder; pictures and README.md unless the figures belong to another page."""
    os.makedirs(folder, exist_ok=True)
    write_json(os.path.join(folder, "metrics.json"), metrics)
    write_csv(os.path.join(folder, "errors.csv"), HEAD, error_rows(metrics))
    if with_page:
        _draw(metrics, judged, runs, folder)
        write_page_text(folder)
