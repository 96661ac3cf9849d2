"""Writes perf/results/<processor>_frames.csv, the table of frames in perf/README.md, and perf/frames.png.

usage: summarise_frames.py FRAMES.csv      what build/release/bin/perf_frames wrote; times are shares of the budget
"""
import csv
import shutil
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from summarise import HERE, file_name, processor, put_between, table

# These hardly do anything: what matters is what an instance costs them.
IDLE = ("hidden", "asleep")
YARDSTICK = "yardstick"
TAILS = (("p50", "median", "o"), ("p99", "p99", "s"), ("p999", "p99.9", "^"), ("worst", "worst", "x"))


def name_of(row):
    return f"{row['trouble']}, {row['instances']} in {float(row['budget_us']) / 1e3:g} ms"


def shares(row, clock):
    return [f"{float(row[f'{clock}_{tail}']):.2f}" for tail, *_ in TAILS]


def frames_table(rows):
    tiers = ("network", "modal", "extrapolated", "skinned", "hidden")
    lines = [[row["trouble"], row["instances"], f"{float(row['budget_us']):g}", row["frames"], *shares(row, "cpu"),
              *shares(row, "wall"), f"{float(row['schedule_us_p50']):.1f}",
              *[f"{100 * float(row[tier]):.0f}" for tier in tiers], f"{100 * float(row['unspent_p50']):.1f}",
              f"{float(row['expected_error']):.2f}"] for row in rows]
    heads = [f"{clock} {label}" for clock in ("CPU", "wall") for _, label, _ in TAILS]
    return table(["trouble", "characters", "budget, us", "frames", *heads, "schedule, us", *[f"{t} %" for t in tiers], "unspent %",
                  "error expected"], lines)


def idle_table(rows):
    def an_instance(row, tail):
        return float(row[f"cpu_{tail}"]) * float(row["budget_us"]) / int(row["instances"])

    lines = [[row["trouble"], row["instances"], f"{an_instance(row, 'p50'):.2f}", f"{an_instance(row, 'p99'):.2f}", "1", "0.1"]
             for row in rows]
    return table(["all are", "characters", "us an instance, median", "p99", "at least", "aim"], lines)


def yardstick_table(rows):
    lines = [[f"{float(row['budget_us']):g}", row["frames"],
              *[f"{float(row[f'{clock}_{tail}']) / float(row[f'{clock}_p50']):.2f}" for clock in ("cpu", "wall") for tail in ("p99", "p999", "worst")]]
             for row in rows]
    heads = [f"{clock} {label}" for clock in ("CPU", "wall") for label in ("p99", "p99.9", "worst")]
    return table(["multiply-adds of 0.9 of, us", "times", *[f"{head}, of its median" for head in heads]], lines)


def draw(rows, machine):
    figure, axes = plt.subplots(figsize=(10, 0.36 * len(rows) + 1.6))
    places = range(len(rows))
    for tail, label, marker in TAILS:
        axes.plot([float(row[f"cpu_{tail}"]) for row in rows], places, marker, label=label, linestyle="none")
    axes.axvline(1, color="black", linewidth=1)
    axes.set_yticks(list(places), [name_of(row) for row in rows])
    axes.invert_yaxis()
    axes.set_xlim(left=0)
    axes.set_xlabel("thread CPU time of a step, share of the budget")
    axes.set_title(f"Steps against their budget, {rows[0]['frames']} frames each\n{machine}", fontsize=10)
    axes.grid(axis="x", alpha=0.3)
    axes.legend(loc="upper left", bbox_to_anchor=(0, -0.09), ncols=4, fontsize=8)
    figure.tight_layout()
    figure.savefig(HERE / "frames.png", dpi=110)


def main(path):
    machine = processor()
    shutil.copyfile(path, HERE / "results" / f"{file_name(machine)}_frames.csv")
    rows = list(csv.DictReader(open(path)))
    busy = [row for row in rows if row["trouble"] not in (*IDLE, YARDSTICK)]
    fixed = [row for row in rows if row["trouble"] == YARDSTICK]
    idle = [row for row in rows if row["trouble"] in IDLE]
    frames = sum(int(row["frames"]) for row in busy)
    lines = [f"Processor: {machine}; one thread, but for the lost worker's two. {frames:,} frames in the first table.", ""] + frames_table(busy) + [""] + yardstick_table(fixed) + [""] + idle_table(idle)
    put_between("frames", lines)
    draw(busy, machine)
    print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1])
