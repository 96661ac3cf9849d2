#!/usr/bin/env python3
"""Measures motion between ticks: writes perf/reports/between.csv and between.png, and the table of perf/README.md.

usage: perf/between.py C.sinew...      the picture is of the first; ten seconds each; needs build/release/bin/perf_between
"""
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt

import report
from short_tables import find
from summarise import summarise

BINARY = report.HERE.parent / "build/release/bin/perf_between"
CURVES = {"240 before": ("0.7", "240 frames/s, last velocity extrapolated (rejected)"), "240": ("C2", "240 frames/s"), "60": ("C1", "60 frames/s"),
          "30": ("C0", "30 frames/s")}


def measure(packs, out):
    """The program's Markdown table as CSV."""
    lines = subprocess.run([BINARY, *packs], check=True, capture_output=True, text=True).stdout.splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if not line.startswith("|---")]
    rows[0][0] = "measure"
    with open(out, "w") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def draw(pack, work):
    subprocess.run([BINARY, "--moves", work / "moves.csv", pack], check=True)
    moves = report.read(work / "moves.csv")
    figure, axes = plt.subplots(figsize=(9, 3.2), layout="constrained")
    for name, (color, label) in CURVES.items():
        of = find(moves, frames=name)
        axes.plot([float(row["t_s"]) for row in of], [float(row["heights_per_s"]) for row in of], ".-", color=color, linewidth=1, markersize=3,
                  label=label)
    axes.set(xlim=(1, 1.5), xlabel="time, s", ylabel="fastest soft vertex, heights/s", ylim=(0, None))
    axes.set_title("Speed relative to skinning in each frame; the root bobs by 5 % of the height at 2 Hz", fontsize=10)
    axes.grid(alpha=0.3)
    figure.legend(*axes.get_legend_handles_labels(), loc="upper center", bbox_to_anchor=(0.5, 0), ncols=4, fontsize=8)
    figure.savefig(report.REPORTS / "between.png", dpi=100, bbox_inches="tight")


def main(packs):
    if not packs or packs[0] in ("-h", "--help"):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        measure(packs, Path(folder) / "between.csv")
        summarise("perf/between.py", "between", Path(folder) / "between.csv")
        draw(packs[0], Path(folder))


if __name__ == "__main__":
    main(sys.argv[1:])
