"""Writes assets/evaluation/truth/: the page, its picture, a summary and the measurements that they are made of.

usage: summarise_truth.py SOME.csv ALL.csv      what perf_truth wrote of a few clips, and of all with --slow

The two tables in assets/evaluation/truth/ are taken as well, so that page and picture can be written without measuring.
"""
import csv
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

FIELDS = ("character", "clip", "mean_mm", "slow", "many", "finer", "fault")
FOLDER = pathlib.Path(__file__).resolve().parent.parent / "assets" / "evaluation" / "truth"
WANTED = {"slow": 0.1, "many": 0.035}
LABELS = {
    "slow": "16 times slower, no gravity:\nmean displacement / at full speed",
    "many": "against 64 substeps a tick",
    "finer": "against a cage twice as fine",
}


def read(path):
    rows = list(csv.DictReader(pathlib.Path(path).read_text().splitlines(), FIELDS))
    return [row for row in rows if row["character"] != FIELDS[0]]  # without the header of a stored table


def values(rows, field):
    return [float(row[field]) for row in rows if row[field] and not row["fault"]]


def of(rows, name):
    return [row for row in rows if row["character"] == name]


def median_and_worst(rows, field):
    """The median over clips, the largest value and its clip; empty without a value."""
    found = [(float(row[field]), row["clip"]) for row in rows if row[field] and not row["fault"]]
    if not found:
        return "", "", ""
    worst, clip = max(found)
    return round(statistics.median(v for v, _ in found), 4), worst, clip


def summary(some, every):
    """Rows, one for each character; lengths other than millimetres are fractions of the mean displacement."""
    for name in dict.fromkeys(row["character"] for row in every):
        mine, all_ = of(some, name), of(every, name)
        row = {
            "character": name,
            "clips": len(mine),
            "clips_slow": len(all_),
            "mean_mm": round(statistics.median(values(mine, "mean_mm") or [0]), 3),
            "not_converged": len({r["clip"] for r in mine + all_ if r["fault"]}),
        }
        for field, rows in (("slow", all_), ("many", mine), ("finer", mine)):
            row[field], row[f"{field}_worst"], row[f"{field}_worst_clip"] = median_and_worst(rows, field)
        yield row


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
    figure.suptitle("Error of the ground truth, one point per clip, as a fraction of the mean displacement; wanted left of the dotted line", fontsize=10)
    figure.tight_layout()
    figure.savefig(FOLDER / "truth.png", dpi=110)


def spread(rows, field):
    """The least and the largest of the characters' medians."""
    medians = {row["character"]: row[field] for row in rows if row[field] != ""}
    return f"{min(medians.values()):.3f} to {max(medians.values()):.3f} ({max(medians, key=medians.get)})"


def page(rows):
    unconverged = sum(row["not_converged"] for row in rows)
    return f"""# Error of the ground truth itself

The character's own cage and time steps against smaller ones, over the vertices that tissue moves, as a fraction of the mean displacement; medians over clips of {len(rows)} characters:

- 64 substeps a tick: {spread(rows, "many")};
- cells half as large: {spread(rows, "finer")};
- 16 times slower without gravity, where inertia is a 256th: {spread(rows, "slow")}.

![one point per clip](truth.png)

An error against this truth that is smaller than these fractions says nothing about real tissue. Clips play for 1.5 s, in slow motion for half a second; {f"{unconverged} did not converge" if unconverged else "all converged"}.

`perf/truth.sh CHARACTERS` measures and writes this folder. Tables: [characters](summary.csv), [clips](some_clips.csv), [all clips in slow motion](all_clips.csv).
"""


def main(some_path, all_path):
    FOLDER.mkdir(parents=True, exist_ok=True)
    some, every = read(some_path), read(all_path)
    for name, rows in (("some_clips.csv", some), ("all_clips.csv", every), ("summary.csv", list(summary(some, every)))):
        with open(FOLDER / name, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    draw(some, every)
    text = page(list(summary(some, every)))
    (FOLDER / "README.md").write_text(text)
    print(text)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
