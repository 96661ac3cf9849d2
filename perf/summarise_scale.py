"""Writes perf/results/<processor>_scale.csv, the tables of perf/README.md that tell of growth, and perf/scale.png.

usage: summarise_scale.py SCALE.csv      what build/release/bin/perf_scale wrote
Times are medians; cpu_us is of all threads. A share is of the multiply-add peak measured in the same process.
"""
import csv
import pathlib
import shutil
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from summarise import HERE, file_name, processor, put_between, table


def read(path):
    """{group: {(subject, vertices, instances, workers): {quantity: value}}}, in the order of the file."""
    groups = {}
    for row in csv.DictReader(open(path)):
        case = (row["subject"], int(row["vertices"]), int(row["instances"]), int(row["workers"]))
        groups.setdefault(row["group"], {}).setdefault(case, {})[row["quantity"]] = float(row["value"])
    return groups


def number(value, digits=1):
    return "" if value is None else f"{value:.{digits}f}"


def parts_table(parts):
    lines = []
    for (subject, *_), of in parts.items():
        if "us" in of:
            share = of.get("share_of_peak")
            lines.append([subject, number(of["us"]), number(of.get("mega_operations"), 2), number(share, 2)])
    return table(["of a tick of one character", "us", "mega_operations", "share_of_peak"], lines)


def vertices_table(cases):
    lines = [[str(vertices), number(of["cpu_us"]), number(of["read_us"]), number(of["state_bytes"] / 1e3, 0),
              number(of["instance_bytes"] / 1e3, 0)] for (_, vertices, *_), of in cases.items()]
    return table(["vertices", "step, us", "read positions, us", "state, kB", "instance, kB"], lines)


def instances_table(cases):
    counts = sorted({instances for (_, _, instances, _) in cases})
    wall = {(instances, workers): of["wall_us"] for (_, _, instances, workers), of in cases.items()}
    cpu = {instances: of["cpu_us"] for (_, _, instances, workers), of in cases.items() if workers == 1}
    lines = [[str(n), number(cpu[n]), number(cpu[n] / n), number(wall[n, 1]), number(wall[n, 2]),
              number(wall[n, 1] / wall[n, 2], 2)] for n in counts]
    columns = ["instances", "CPU time, us", "an instance, us", "one worker, us", "two workers, us", "one / two"]
    return table(columns, lines)


def batches_table(cases):
    lines = [[str(instances), number(of["apart_us"]), number(of["together_us"]), number(of["apart_us"] / of["together_us"], 2)]
             for (_, _, instances, _), of in cases.items()]
    return table(["instances in one network step", "apart, us each", "together, us each", "apart / together"], lines)


def sleep_table(cases):
    lines = [[subject, number(of["share_asleep"], 2), number(of["time_ratio"], 2), number(of["added_error_mean_mm"], 4),
              number(of["added_error_largest_mm"], 3)] for (subject, *_), of in cases.items()]
    return table(["clip, 15 s", "regions asleep", "time / never sleeping", "added, mean mm", "largest mm"], lines)


def figures_table(groups):
    """What the project asks for of one character and of a large network, beside what was measured."""
    tick = next(of for (subject, *_), of in groups["parts"].items() if subject == "whole tick")
    state_kb = next(of for (_, vertices, *_), of in groups["vertices"].items() if vertices > 6000)["state_bytes"] / 1e3
    lines = [["character with `creature`, share of float32 peak", number(tick["share_of_peak"], 2), "0.25", "0.50"],
             ["character with `creature`, us a tick", number(tick["us"]), "200", "80"]]
    lines += [["character, state of an instance, kB", number(state_kb, 0), "1000", "200"]]
    return table(["figure", "measured", "at least", "aim"], lines)


def plot(groups, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), constrained_layout=True)
    for workers in (1, 2):
        points = [(instances, of["wall_us"] / instances) for (_, _, instances, w), of in groups["instances"].items() if w == workers]
        left.loglog(*zip(*points), marker="o", label=f"{workers} worker{'s' if workers > 1 else ''}")
    left.set(xlabel="instances", ylabel="step, us an instance")
    left.legend()
    points = [(vertices, of["cpu_us"], of["read_us"]) for (_, vertices, *_), of in groups["vertices"].items()]
    vertices, step, read_us = zip(*points)
    right.loglog(vertices, step, marker="o", label="step")
    right.loglog(vertices, read_us, marker="o", label="read positions")
    right.set(xlabel="vertices", ylabel="us")
    right.legend()
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.savefig(path, dpi=100)


TABLES = {"parts": parts_table, "vertices": vertices_table, "instances": instances_table,
          "batches": batches_table, "sleep": sleep_table}


def main(path):
    groups, machine = read(path), processor()
    shutil.copyfile(path, HERE / "results" / f"{file_name(machine)}_scale.csv")
    plot(groups, HERE / "scale.png")
    lines = [f"Processor: {machine}.", ""] + figures_table(groups)
    for group, write in ((group, write) for group, write in TABLES.items() if group in groups):
        lines += [""] + write(groups[group])
    put_between("scale", lines)
    print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1])
