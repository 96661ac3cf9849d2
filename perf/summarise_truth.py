"""Writes the tables and the picture of assets/evaluation/truth/, and its page's block `truth`.

usage: summarise_truth.py SOME.csv ALL.csv      what perf_truth wrote of a few clips, and of all with --slow
"""
import csv
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

import report

FIELDS = ("character", "clip", "mean_mm", "slow", "many", "finer", "fault")
FOLDER = pathlib.Path(__file__).resolve().parent.parent / "assets" / "evaluation" / "truth"
WANTED = {"slow": 0.1, "many": 0.035}
LABELS = {
    "slow": "16 times slower, no gravity:\nmean displacement / at full speed",
    "many": "against 64 substeps a tick",
    "finer": "against a cage twice as fine",
}


def read(path):
    return list(csv.DictReader(pathlib.Path(path).read_text().splitlines(), FIELDS))


def values(rows, field):
    return [float(row[field]) for row in rows if row[field] and not row["fault"]]


def of(rows, name):
    return [row for row in rows if row["character"] == name]


def median_and_worst(rows, field):
    found = [(float(row[field]), row["clip"]) for row in rows if row[field] and not row["fault"]]
    if not found:
        return "-"
    worst, clip = max(found)
    name = clip.replace("|", "\\|")
    return f"{statistics.median(v for v, _ in found):.3f}, {worst:.3f} ({name})"


def table(some, every):
    columns = ["character", "clips", "mean displacement, mm", "16 times slower, all clips", "against 64 substeps", "against a cage twice as fine", "did not converge"]
    lines = []
    for name in dict.fromkeys(row["character"] for row in every):
        mine, all_ = of(some, name), of(every, name)
        lines.append([name, f"{len(mine)} of {len(all_)}", f"{statistics.median(values(mine, 'mean_mm') or [0]):.2f}", median_and_worst(all_, "slow"),
                      median_and_worst(mine, "many"), median_and_worst(mine, "finer"), len({row["clip"] for row in mine + all_ if row["fault"]})])
    return report.table(columns, lines)


def draw(some, every):
    names = list(dict.fromkeys(row["character"] for row in every))
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.6), sharey=True)
    for axis, (field, label) in zip(axes, LABELS.items()):
        for at, name in enumerate(names):
            rows = of(every if field == "slow" else some, name)
            found = [max(v, 1e-4) for v in values(rows, field)]
            axis.plot(found, [at] * len(found), "o", alpha=0.6, markersize=5)
        if field in WANTED:
            axis.axvline(WANTED[field], color="black", linewidth=1, linestyle=":")
        axis.set_xscale("log")
        axis.set_xlabel(label)
        axis.set_yticks(range(len(names)), names)
        axis.grid(alpha=0.3)
    axes[0].invert_yaxis()
    figure.suptitle("Error of the ground truth, one point a clip, over the mean displacement; the dotted line is the limit", fontsize=10)
    figure.tight_layout()
    figure.savefig(FOLDER / "truth.png", dpi=110)


def main(some_path, all_path):
    FOLDER.mkdir(parents=True, exist_ok=True)
    some, every = read(some_path), read(all_path)
    for name, path in (("some_clips.csv", some_path), ("all_clips.csv", all_path)):
        (FOLDER / name).write_text(",".join(FIELDS) + "\n" + pathlib.Path(path).read_text())
    draw(some, every)
    lines = [f"`perf/truth.sh`, {report.processor()}", "", *table(some, every)]
    report.put_block(FOLDER / "README.md", "truth", lines)


if __name__ == "__main__":
    main(*sys.argv[1:])
