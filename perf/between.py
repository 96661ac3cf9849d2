#!/usr/bin/env python3
"""Measures motion between ticks: writes perf/reports/between.csv and between.png, and the table of perf/README.md.

usage: perf/between.py C.sinew...      the picture is of the first; ten seconds each; needs build/release/bin/perf_between
"""
import csv
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SYSTEM_PYTHON = "/usr/bin/python3"
try:
    import matplotlib
except ImportError as missing:  # a Python without Debian's packages
    if os.path.realpath(sys.executable) == os.path.realpath(SYSTEM_PYTHON):
        print(f"between.py: {missing}; apt-get install python3-matplotlib", file=sys.stderr)
        sys.exit(2)
    os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, *sys.argv])

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

import report  # noqa: E402
from short_tables import find  # noqa: E402
from summarise import summarise  # noqa: E402

BINARY = report.HERE.parent / "build/release/bin/perf_between"
CURVES = {"240 before": ("0.7", "240 frames/s, last velocity extrapolated (rejected)"), "240": ("C2", "240 frames/s"), "60": ("C1", "60 frames/s"),
          "30": ("C0", "30 frames/s")}


def measure(packs, out):
    """The program's Markdown table as CSV."""
    lines = subprocess.run([BINARY, *packs], check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if not line.startswith("|---")]
    rows[0][0] = "measure"
    with open(out, "w") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def draw(pack, work):
    """The path of the picture."""
    subprocess.run([BINARY, "--moves", work / "moves.csv", pack], check=True)
    moves = report.rows((work / "moves.csv").read_text())
    figure, axes = plt.subplots(figsize=(9, 3.2), layout="constrained")
    for name, (color, label) in CURVES.items():
        of = find(moves, frames=name)
        axes.plot([float(row["t_s"]) for row in of], [float(row["heights_per_s"]) for row in of], ".-", color=color, linewidth=1, markersize=3,
                  label=label)
    axes.set(xlim=(1, 1.5), xlabel="time, s", ylabel="fastest soft vertex, heights/s", ylim=(0, None))
    axes.set_title("Speed relative to skinning in each frame; the root bobs by 5 % of the height at 2 Hz", fontsize=10)
    axes.grid(alpha=0.3)
    figure.legend(*axes.get_legend_handles_labels(), loc="upper center", bbox_to_anchor=(0.5, 0), ncols=4, fontsize=8)
    figure.savefig(work / "between.png", dpi=100, bbox_inches="tight")
    return work / "between.png"


def main(packs):
    if not packs or packs[0] in ("-h", "--help"):
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    for needed in (BINARY, *packs):
        if not os.path.isfile(needed):
            print(f"between.py: no {needed}", file=sys.stderr)
            sys.exit(2)
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        try:
            measure(packs, work / "between.csv")
            picture = draw(packs[0], work).read_bytes()
        except subprocess.CalledProcessError as failed:  # the program has named the problem
            sys.exit(failed.returncode)
        summarise("perf/between.py", [("between", work / "between.csv")])
        report.replace(report.REPORTS / "between.png", picture)


if __name__ == "__main__":
    main(sys.argv[1:])
