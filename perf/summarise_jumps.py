"""Writes perf/results/<processor>_jumps.csv and the table of jumps in perf/README.md: of each tier that is changed from, the worst change.

usage: summarise_jumps.py [--print] JUMPS.csv      what build/release/bin/perf_jumps wrote; --print: writes nothing, prints the table
"""
import csv
import pathlib
import sys

from summarise import HERE, file_name, processor, put_between, table

MEASURES = ("beyond_both_percent", "at_once_percent")
BEYOND_ALL = "beyond_all_percent"
LEFT = "extrapolate"  # what left alone is changed to


def largest(rows, measure):
    return max(rows, key=lambda row: float(row[measure]))


def told(rows, measure):
    if not rows:
        return "none"
    row = largest(rows, measure)
    return f"{float(row[measure]):.2f} % ({row['from']} to {row['to']})"


def kinds(rows):
    """What the scheduler may choose: between tiers that are simulated, to being left alone, and back."""
    simulated = {row["to"] for row in rows if row["to"] != LEFT}
    back = [row for row in rows if row["from"] not in simulated]
    return {"between tiers that are simulated": [row for row in rows if row not in back and row["to"] != LEFT],
            "to being left alone": [row for row in rows if row["to"] == LEFT], "coming back": back}


def clips(rows):
    return list(dict.fromkeys(row["clip"] for row in rows))


def of_clip(rows, clip):
    return [row for row in rows if row["clip"] == clip]


def lines_of(rows):
    heads = ["from"] + [f"{clip}: worst beyond both, %" for clip in clips(rows)]
    lines = []
    for name in dict.fromkeys(row["from"] for row in rows):
        of = [row for row in rows if row["from"] == name]
        worst = [largest(of_clip(of, clip), MEASURES[0]) for clip in clips(rows)]
        lines.append([name] + [f"{row[MEASURES[0]]} to {row['to']}" for row in worst])
    return heads, lines


def summary(rows):
    """For each clip the largest of what the scheduler may choose, beside how far a tier itself moves a vertex in a frame."""
    beyond = "coming back, beyond the tier before too"
    heads = ["clip", "a tier itself moves a vertex in a frame by up to, %", "measure", *kinds(rows), beyond]
    lines = []
    for clip in clips(rows):
        of = of_clip(rows, clip)
        for label, measure in (("beyond both", MEASURES[0]), ("at once", MEASURES[1])):
            cells = [told(kind, measure) for kind in kinds(of).values()]
            cells.append(told(kinds(of)["coming back"], BEYOND_ALL) if measure == MEASURES[0] else "")
            lines.append([clip, of[0]["own_step_percent"], label] + cells)
    return table(heads, lines)


def main(path, only_print):
    machine = processor()
    text = pathlib.Path(path).read_text()
    rows = list(csv.DictReader(text.splitlines()))
    lines = [f"Processor: {machine}, one thread.", "", *summary(rows), "", *table(*lines_of(rows))]
    if not only_print:
        (HERE / "results" / f"{file_name(machine)}_jumps.csv").write_text(text)
        put_between("jumps", lines)
    print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[-1], "--print" in sys.argv)
