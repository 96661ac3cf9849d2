"""The pictures of reports, named as these are: a function of the report's rows and processor makes a figure."""
import io
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from short_tables import find, geometric_mean, us

QUANTILES = (("p50", "median", "o"), ("p99", "p99", "s"), ("p999", "p99.9", "^"), ("worst", "worst", "x"))
NOT_BUDGETED = ("hidden", "asleep", "yardstick")


def frames(rows, processor):
    rows = [row for row in rows if row["trouble"] not in NOT_BUDGETED]
    figure, axes = plt.subplots(figsize=(9, 0.3 * len(rows) + 1.8), layout="constrained")
    for quantile, label, marker in QUANTILES:
        axes.semilogx([float(row[f"cpu_{quantile}"]) for row in rows], range(len(rows)), marker, label=label)
    axes.axvline(1, color="black", linewidth=1)
    axes.set_yticks(range(len(rows)), [f"{row['trouble']}, {row['instances']} in {float(row['budget_us']) / 1e3:g} ms" for row in rows])
    axes.invert_yaxis()
    ticks = [0.3, 0.5, 1, 2, 5, 10]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_xlabel("thread CPU time of a step over its budget (logarithmic)")
    axes.set_title(f"Steps against their budget, {int(rows[0]['frames']):,} frames a scene; {processor}", fontsize=10)
    axes.grid(axis="x", alpha=0.3)
    figure.legend(*axes.get_legend_handles_labels(), loc="upper center", bbox_to_anchor=(0.5, 0), ncols=4, fontsize=8)
    return figure


def scale(rows, processor):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    for workers in (1, 2):
        of = find(rows, group="instances", quantity="wall_us", workers=workers)
        left.semilogx([int(row["instances"]) for row in of], [float(row["value"]) / int(row["instances"]) for row in of], marker="o",
                      label=f"{workers} worker{'s' * (workers > 1)}")
    left.set(xlabel="instances of the creature", ylabel="step, µs an instance", ylim=(0, None))
    for quantity, label in (("cpu_us", "step"), ("read_us", "reading positions")):
        of = find(rows, group="vertices", quantity=quantity)
        right.loglog([int(row["vertices"]) for row in of], [float(row["value"]) for row in of], marker="o", label=label)
    right.set(xlabel="vertices of one character", ylabel="µs")
    left.legend(loc="lower right")
    right.legend(loc="upper left")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.suptitle(processor, fontsize=10)
    return figure


STARTS = ("zero", "previous", "continued", "learned", "knn")
OPTIONS = [("direct", start) for start in STARTS] + [("cg", "continued"), ("local", "continued")]


def style(option):
    if option[0] == "direct":
        return dict(color=f"C{STARTS.index(option[1])}", marker="o", markersize=3)
    return dict(color="0.4", marker="s", markersize=3, linestyle="--" if option[0] == "cg" else ":")


def rod_times(axes, rows, option):
    """The mean over moduli of one rod's time to 1e-4."""
    points = {}
    for row in find(rows, strands=1, residual="1e-04", solver=option[0], start=option[1]):
        if math.isfinite(us(row)):
            points.setdefault(int(row["segments"]), []).append(us(row))
    axes.loglog(sorted(points), [geometric_mean(points[n]) for n in sorted(points)], label=f"{option[0]}, {option[1]}", **style(option))


def rod_iterations(axes, rows, option):
    those = find(rows, strands=1, segments=50, residual="1e-06", solver=option[0], start=option[1])
    points = sorted((float(row["young_pa"]), float(row["iterations_mean"])) for row in those if int(row["reached"]))
    axes.semilogx(*zip(*points), **style(option))


def rods_trade(rows, _processor):
    scenes = [scene for scene in dict.fromkeys(row["scene"] for row in rows) if scene != "collisions"]
    figure, grid = plt.subplots(2, len(scenes), figsize=(10, 6), layout="constrained", sharey="row", squeeze=False)
    for (above, below), scene in zip(grid.T, scenes):
        of = find(rows, scene=scene)
        for option in OPTIONS:
            rod_times(above, of, option)
        for option in OPTIONS[:len(STARTS)]:
            rod_iterations(below, of, option)
        above.set(title=scene, xlabel="segments")
        above.set_xticks([10, 30, 100, 200], ["10", "30", "100", "200"])
        above.minorticks_off()
        below.set(xlabel="Young's modulus, Pa")
    grid[1][0].set_ylim(0, None)
    grid[0][0].set_ylabel("one rod's step to 1e-4, µs\n(mean over moduli that reach it)")
    grid[1][0].set_ylabel("iterations of direct to 1e-6,\n50 segments")
    for axes in grid.flat:
        axes.grid(alpha=0.3)
    figure.legend(*grid[0][0].get_legend_handles_labels(), loc="upper center", bbox_to_anchor=(0.5, 0), ncols=len(OPTIONS), fontsize=8)
    return figure


def png(name, rows, processor):
    file = io.BytesIO()
    globals()[name](rows, processor).savefig(file, dpi=100, bbox_inches="tight")
    return file.getvalue()
