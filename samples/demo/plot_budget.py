#!/usr/bin/env python3
# plot_budget.py  A report of sinew-demo as a picture: time by stage against the budget, and what the instances got.
"""Usage: plot_budget.py REPORT.json [-o OUT.png]

Writes OUT.png and OUT.svg (next to the report if -o is left out).
"""
import argparse
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator

STAGES = [("schedule_us", "schedule", "#8d99ae"), ("drive_us", "drive", "#4f9d8c"),
          ("tissue_us", "tissue", "#2c6fbb"), ("rods_us", "rods", "#c88a5a"), ("publish_us", "publish", "#b07aa1")]
REST = ("rest of the step", "#cfd4dc")
TIERS = [("network", "network", "#2c6fbb"), ("modal", "modal", "#7db3e0"),
         ("extrapolated", "extrapolated", "#eebc3c"), ("skinning", "skinning", "#b9bfc9")]
LIMIT = "#c0392b"
HEADROOM = 1.25          # over the tallest ordinary frame
MOST_OF_BUDGET = 2.0     # a frame far over its budget is marked at the edge: it must not flatten the others
ORDINARY_PERCENTILE = 98


class Unusable(Exception):
    """One line: what, where, how to mend."""


def read_report(path):
    try:
        report = json.loads(Path(path).read_text())
    except OSError as error:
        raise Unusable(f"{path}: cannot be read ({error.strerror}); make it with: sinew-demo C.sinew --report {path}")
    except ValueError:
        raise Unusable(f"{path}: is not JSON; make it with: sinew-demo C.sinew --report {path}")
    if not isinstance(report, dict) or not report.get("frames") or "total_us" not in report["frames"][0]:
        raise Unusable(f"{path}: holds no frames of sinew-demo; make it with: sinew-demo C.sinew --report {path}")
    return report


def column(frames, key):
    return np.array([frame[key] for frame in frames], dtype=float)


def stage_layers(frames):
    """Wall time of every stage. Stages that threads share are sums over threads: scaled to the wall time they took."""
    total = column(frames, "total_us")
    schedule = column(frames, "schedule_us")
    shared = np.array([column(frames, key) for key, _, _ in STAGES[1:]])
    scale = np.minimum(1, (total - schedule) / np.maximum(shared.sum(axis=0), 1e-9))
    return total, np.vstack([schedule, shared * scale])


def draw_times(axes, report):
    frames = report["frames"]
    seconds = column(frames, "time_s")
    total, layers = stage_layers(frames)
    rest = np.maximum(0, total - layers.sum(axis=0))
    axes.stackplot(seconds, *layers, rest, step="mid", linewidth=0,
                   labels=[name for _, name, _ in STAGES] + [REST[0]],
                   colors=[color for _, _, color in STAGES] + [REST[1]])
    budget = report["budget_us"]
    top = HEADROOM * np.percentile(total, ORDINARY_PERCENTILE)
    if budget is not None:
        top = min(max(top, HEADROOM * budget), MOST_OF_BUDGET * budget)
    if budget is not None:
        axes.axhline(budget, color=LIMIT, linewidth=1.4, label=f"budget {budget:g} \N{MICRO SIGN}s")
    over = total > top
    if over.any():
        axes.plot(seconds[over], np.full(over.sum(), 0.985 * top), "^", color=LIMIT, markersize=5, clip_on=False,
                  label=f"higher: {over.sum()}, worst {total.max():.0f} \N{MICRO SIGN}s")
    axes.set_ylim(0, top)
    axes.set_ylabel("time a frame (\N{MICRO SIGN}s)")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False)


def draw_tiers(axes, report):
    frames = report["frames"]
    counts = [column(frames, key) for key, _, _ in TIERS]
    axes.stackplot(column(frames, "time_s"), *counts, step="mid", linewidth=0,
                   labels=[name for _, name, _ in TIERS], colors=[color for _, _, color in TIERS])
    cut = column(frames, "cut") > 0
    if cut.any():
        axes.plot(column(frames, "time_s")[cut], np.full(cut.sum(), 1.04 * report["instances"]), "v", color=LIMIT,
                  markersize=4, clip_on=False, label=f"cut short ({int(column(frames, 'cut').sum())})")
    axes.set_ylim(0, report["instances"])
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, integer=True))
    axes.set_ylabel("instances")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.05), frameon=False)


def shade_tiers(axes, frames, seconds):
    """Behind the errors: when the measured instance was not on the network."""
    step = seconds[1] - seconds[0] if len(seconds) > 1 else 0
    for key, name, color in TIERS[1:]:
        here = np.array([frame["first"]["tier"] == key for frame in frames])
        if here.any():
            axes.fill_between(seconds + step / 2, 0, 1, where=here, transform=axes.get_xaxis_transform(), step="mid",
                              color=color, alpha=0.35, linewidth=0, label=f"then {name}")


def draw_errors(axes, report):
    frames = report["frames"]
    seconds = column(frames, "time_s")
    for key, name, color in (("skinning", "skinning alone", "#c45428"), ("sinew", "Sinew", "#1c68a8")):
        axes.plot(seconds, [frame["error_mm"][key] for frame in frames], color=color, linewidth=1.4, label=name)
    shade_tiers(axes, frames, seconds)
    axes.set_ylim(bottom=0)
    axes.set_ylabel("mean error (mm)")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.05), frameon=False)


def title_of(report):
    instances, threads = report["instances"], report["threads"]
    return (f"{instances} {report['character']}{'s' if instances > 1 else ''}, {report['fps']:g} frames a second, "
            f"{threads} thread{'s' if threads > 1 else ''}")


def draw(report):
    plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False,
                         "svg.hashsalt": "sinew", "svg.fonttype": "none"})
    panels = [(draw_times, 3), (draw_tiers, 1.2)]
    if "error_mm" in report["frames"][0]:
        panels.append((draw_errors, 1.6))
    heights = [height for _, height in panels]
    figure, axes = plt.subplots(len(panels), 1, sharex=True, figsize=(10, 1.3 + 1.05 * sum(heights)),
                                gridspec_kw={"height_ratios": heights}, constrained_layout=True)
    for (draw_panel, _), panel_axes in zip(panels, axes):
        draw_panel(panel_axes, report)
        panel_axes.margins(x=0)
    axes[0].set_title(title_of(report), loc="left", fontweight="bold")
    axes[-1].set_xlabel("simulated time (s)")
    return figure


def main():
    parser = argparse.ArgumentParser(description="Plots a report of sinew-demo: time by stage, budget, tiers.")
    parser.add_argument("report", help="report.json, as sinew-demo --report writes it")
    parser.add_argument("-o", "--output", help="picture; .svg is written next to it (default: next to the report)")
    arguments = parser.parse_args()
    output = Path(arguments.output or arguments.report)
    try:
        figure = draw(read_report(arguments.report))
        for suffix in (".png", ".svg"):
            picture = output.with_suffix(suffix)
            if picture.exists() and picture.samefile(arguments.report):
                raise Unusable(f"{picture} is the input; give another name")
        for suffix, metadata in ((".png", {"Software": None}), (".svg", {"Date": None})):
            figure.savefig(output.with_suffix(suffix), dpi=150, metadata=metadata)
    except Unusable as error:
        print(f"plot_budget.py: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"plot_budget.py: {output}: cannot be written ({error.strerror})", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
