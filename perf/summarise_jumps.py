"""Writes perf/results/<processor>_jumps.csv and the table of jumps in perf/README.md: of each tier that is changed from, the worst change.

usage: summarise_jumps.py JUMPS.csv      what build/release/bin/perf_jumps wrote
"""
import csv
import pathlib
import sys

from summarise import HERE, file_name, processor, put_between, table

MEASURES = ("beyond_both_percent", "at_once_percent")
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
    chosen = [row for row in rows if row["chosen"] == "1"]
    simulated = {row["to"] for row in chosen if row["to"] != LEFT}
    back = [row for row in chosen if row["from"] not in simulated]
    return {"between tiers that are simulated": [row for row in chosen if row not in back and row["to"] != LEFT],
            "to being left alone": [row for row in chosen if row["to"] == LEFT], "coming back": back}


def lines_of(rows):
    heads = ["from", "worst beyond both, %", "to", "worst at once, %", "to"]
    lines = []
    chosen = [row for row in rows if row["chosen"] == "1"]
    for name in dict.fromkeys(row["from"] for row in chosen):
        worst = [(measure, largest([row for row in chosen if row["from"] == name], measure)) for measure in MEASURES]
        lines.append([name] + [cell for measure, row in worst for cell in (row[measure], row["to"])])
    return heads, lines


def summary(rows):
    out = []
    for label, measure in (("Beyond both", MEASURES[0]), ("At once", MEASURES[1])):
        parts = [f"{kind} {told(of, measure)}" for kind, of in kinds(rows).items()]
        parts.append(f"with rates that it does not buy {told([row for row in rows if row['chosen'] == '0'], measure)}")
        out.append(f"{label}, the largest of what the scheduler may choose: " + "; ".join(parts) + ".")
    return "  \n".join(out)


def main(path):
    machine = processor()
    text = pathlib.Path(path).read_text()
    (HERE / "results" / f"{file_name(machine)}_jumps.csv").write_text(text)
    rows = list(csv.DictReader(text.splitlines()))
    lines = [f"Processor: {machine}, one thread.", "", summary(rows), ""] + table(*lines_of(rows))
    put_between("jumps", lines)
    print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1])
