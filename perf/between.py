#!/usr/bin/env python3
"""Draws perf/between.png: how far a frame moves flesh at several frame rates, and the same moments of a hop as each rate shows them.

usage: perf/between.py C.sinew build/release
"""
import csv
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.image
import matplotlib.pyplot as plt

RATES = [24, 30, 60, 144, 240, 960]
MOMENTS = [3, 4, 5, 6, 7, 8]  # pictures at 6 a second
LABELS = {"240 before": "240, last velocity carried on (before)", "slow": "at 1/50 of the speed"}


def moves(binaries, pack, work):
    table = work / "moves.csv"
    subprocess.run([binaries / "perf_between", "--moves", table, pack], check=True)
    out = defaultdict(lambda: ([], []))
    with table.open() as rows:
        for row in csv.DictReader(rows):
            t, speed = out[row["frames"]]
            t.append(float(row["t_s"]))
            speed.append(float(row["heights_per_s"]))
    return out


def strip(binaries, pack, work, fps):
    folder = work / str(fps)
    subprocess.run([binaries / "sinew-demo", pack, "--clip", "hop", "--fps", str(fps), "--seconds", "1.6", "--picture-fps", "6", "--width", "190", "--height", "220",
                    "--view", "side", "--frames", folder], check=True, stdout=subprocess.DEVNULL)
    pictures = [matplotlib.image.imread(folder / f"frame_{moment:04d}.png") for moment in MOMENTS]
    return [picture[:, picture.shape[1] - 200:] for picture in pictures]  # with secondary motion, beside skinning


def draw(series, strips, out):
    figure = plt.figure(figsize=(13, 15))
    grid = figure.add_gridspec(2, 1, height_ratios=[1, 2.6], hspace=0.12)
    plot = figure.add_subplot(grid[0])
    for name, (t, speed) in series.items():
        style = dict(marker=".", markersize=3, linewidth=0.8)
        if name == "240 before":
            style = dict(color="0.6", linewidth=0.8, zorder=0)
        plot.plot(t, speed, label=LABELS.get(name, f"{name} frames a second"), **style)
    plot.set_xlim(1, 1.5)
    plot.set_xlabel("time, s")
    plot.set_ylabel("largest move beside skinning, heights/s")
    plot.set_title("The creature bobs by 5 % of its height at 2 Hz: what each frame moves")
    plot.legend(fontsize=8, ncol=2)
    rows = grid[1].subgridspec(len(RATES), len(MOMENTS), wspace=0.02, hspace=0.04)
    for r, (fps, pictures) in enumerate(strips.items()):
        for c, picture in enumerate(pictures):
            axes = figure.add_subplot(rows[r, c])
            axes.imshow(picture)
            axes.set_xticks([])
            axes.set_yticks([])
            if c == 0:
                axes.set_ylabel(f"{fps} frames/s" + ("\n(1/16 speed)" if fps == 960 else ""), fontsize=9)
            if r == 0:
                axes.set_title(f"{MOMENTS[c] / 6:.2f} s", fontsize=9)
    figure.savefig(out, dpi=72, bbox_inches="tight")


def main():
    if len(sys.argv) != 3 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    pack, binaries = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve() / "bin"
    if not pack.is_file() or not (binaries / "perf_between").is_file():
        sys.exit(f"between.py: {pack} or {binaries}/perf_between is missing")
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        draw(moves(binaries, pack, work), {fps: strip(binaries, pack, work, fps) for fps in RATES}, Path(__file__).with_name("between.png"))


if __name__ == "__main__":
    main()
