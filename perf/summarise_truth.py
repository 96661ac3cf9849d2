"""Writes assets/evaluation/truth/: the page, its picture, a summary and the measurements that they are made of.

usage: summarise_truth.py SOME.csv ALL.csv      what perf_truth wrote of a few clips, and of all with --slow

The two tables in assets/evaluation/truth/ are taken as well, so that page and picture can be written without measuring.
"""
import csv
import io
import pathlib
import re
import statistics
import subprocess
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
    rows = list(csv.DictReader(pathlib.Path(path).read_text().splitlines(), FIELDS))
    rows = [row for row in rows if row["character"] != FIELDS[0]]  # without the header of a stored table
    if not rows:
        raise ValueError(f"no rows in {path}")
    return rows


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
    file = io.BytesIO()
    figure.savefig(file, dpi=110)
    return file.getvalue()


def spread(rows, field):
    """The least and the largest of the characters' medians."""
    medians = {row["character"]: row[field] for row in rows if row[field] != ""}
    return f"{min(medians.values()):.3f} to {max(medians.values()):.3f} ({max(medians, key=medians.get)})"


def code(paths):
    """The commit that measured: today's, or of the stored tables what the page says."""
    if [pathlib.Path(path).resolve() for path in paths] == [FOLDER / "some_clips.csv", FOLDER / "all_clips.csv"]:
        return re.search(r"these figures are of ([^.;]+)", (FOLDER / "README.md").read_text()).group(1)
    status, commit = subprocess.getstatusoutput(f"git -C '{FOLDER}' log -1 --format='%h (%as)'")
    return "an unknown commit" if status else commit


def page(rows, commit):
    unconverged = sum(row["not_converged"] for row in rows)
    return f"""# Error of the ground truth itself

The character's own cage and time steps against smaller ones, over the vertices that tissue moves, as a fraction of the mean displacement; medians over clips of {len(rows)} characters:

- 64 substeps a tick: {spread(rows, "many")};
- cells half as large: {spread(rows, "finer")};
- 16 times slower without gravity, where inertia is a 256th: {spread(rows, "slow")}.

![one point per clip](truth.png)

An error against this truth that is smaller than these fractions says nothing about real tissue. Clips play for 1.5 s, in slow motion for half a second; {f"{unconverged} did not converge" if unconverged else "all converged"}.

`perf/truth.sh CHARACTERS` measures and writes this folder; these figures are of {commit}. Tables: [characters](summary.csv), [clips](some_clips.csv), [all clips in slow motion](all_clips.csv).
"""


def table(rows):
    file = io.StringIO()
    writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return file.getvalue().encode()


def files(paths):
    some, every = map(read, paths)
    rows = list(summary(some, every))
    return {"some_clips.csv": table(some), "all_clips.csv": table(every), "summary.csv": table(rows), "truth.png": draw(some, every),
            "README.md": page(rows, code(paths)).encode()}


def refuse(problem):
    print(f"summarise_truth.py: {problem}", file=sys.stderr)
    sys.exit(2)


def main(paths):
    if len(paths) != 2:
        refuse("usage: summarise_truth.py SOME.csv ALL.csv")
    try:
        made = files(paths)
    except Exception as problem:  # a table of another program fails anywhere
        refuse(f"{' '.join(paths)}: {type(problem).__name__}: {problem}")
    for name, data in made.items():
        report.replace(FOLDER / name, data)
    print(made["README.md"].decode())


if __name__ == "__main__":
    main(sys.argv[1:])
