"""The page's tables and plot of what a start is worth, from the CSV of perf_rod_starts.

python3 perf/summarise_rod_starts.py CSV PNG   prints Markdown
"""
import csv
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ORACLES = ("oracle", "oracle5", "oracle20")


def read(path):
    with open(path) as file:
        lines = [line for line in file if line.strip()]
    costs = [line[2:].strip().split(",") for line in lines if line.startswith("# cost,")]
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return costs, rows


def keyed(rows):
    """(solver, scene, segments, young_pa, horizon) -> start -> row."""
    out = defaultdict(dict)
    for r in rows:
        out[r["solver"], r["scene"], int(r["segments"]), r["young_pa"], r["horizon"]][r["start"]] = r
    return out


def label(key):
    _, scene, segments, young, _ = key
    return f"{scene.replace('_', ' ')} N={segments} E={young.replace('e+0', 'e')}"


def table(rows, solver, column, base, starts, horizon):
    """Markdown: the base's own figure, then ratios to it."""
    print(f"| scene | {base} | " + " | ".join(starts) + " |\n|---|" + "---|" * (len(starts) + 1))
    for key, of in keyed(rows).items():
        if key[0] != solver or key[4] != horizon:
            continue
        first = float(of[base][column])
        ratios = [float(of[s][column]) / first for s in starts]
        print(f"| {label(key)} | {first:.4g} | " + " | ".join(f"{r:.2f}" for r in ratios) + " |")
    print()


def plot(rows, starts, path):
    wanted = [("cg", "cg_iterations", "CG iterations, one rod alone"), ("direct", "us_a_strand_step", "direct: time with the start's own, 16 at once")]
    by = keyed(rows)
    figure, axes = plt.subplots(len(wanted), 1, figsize=(13, 9), layout="constrained")
    for axis, (solver, column, title) in zip(axes, wanted):
        keys = [k for k in by if k[0] == solver and k[4] == "within"]
        for n, start in enumerate(starts):
            ratios = [float(by[k][start][column]) / float(by[k]["zero"][column]) for k in keys]
            at = [i + (n - len(starts) / 2) * 0.8 / len(starts) for i in range(len(keys))]
            axis.bar(at, ratios, 0.8 / len(starts), label=start)
        axis.set_xticks(range(len(keys)), [label(k).replace(" N", "\nN").replace(" E", "\nE") for k in keys], fontsize=8)
        axis.set_ylabel("ratio to start zero")
        axis.set_title(title + " (steps 5 to 50)")
        axis.axhline(1, color="black", linewidth=0.6)
        axis.grid(axis="y", alpha=0.3)
        axis.set_xlim(-0.6, len(keys) - 0.4)
    axes[0].legend(ncol=len(starts), fontsize=9, loc="upper right")
    figure.savefig(path, dpi=90)


def main(source, picture):
    costs, rows = read(source)
    starts = list(dict.fromkeys(r["start"] for r in rows))
    others = [s for s in starts if s != "zero"]
    for horizon, text in (("within", "steps 5 to 50"), ("beyond", "steps 50 on")):
        print(f"CG iterations of a strand's step, and ratios to them, {text}:\n")
        table(rows, "cg", "cg_iterations", "zero", others, horizon)
    print("CG's time, us a strand-step, and ratios to it with the start's own cost, steps 5 to 50:\n")
    table(rows, "cg", "us_a_strand_step", "zero", others, "within")
    print("`direct`: Newton's iterations of a strand's step from `previous`, and ratios to them, steps 5 to 50:\n")
    others = [s for s in starts if s != "previous"]
    table(rows, "direct", "newton", "previous", others, "within")
    print("`direct`: time, us a strand-step, and ratios to it with the start's own cost, steps 5 to 50:\n")
    table(rows, "direct", "us_a_strand_step", "previous", others, "within")
    print("Cost, us a segment of a strand in a group of 16:\n")
    names = list(dict.fromkeys(c[2] for c in costs))
    print("| segments | " + " | ".join(names) + " |\n|---|" + "---|" * len(names))
    for segments in dict.fromkeys(c[1] for c in costs):
        print(f"| {segments} | " + " | ".join(c[3] for c in costs if c[1] == segments) + " |")
    plot(rows, [s for s in starts if s != "zero"], picture)


main(*sys.argv[1:3])
