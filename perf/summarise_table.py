"""Writes perf/results/<processor>_NAME.csv and the table NAME of perf/README.md.

usage: summarise_table.py NAME FILE.csv      what a bench wrote; lines that begin with # are left out
"""
import csv
import sys

from summarise import HERE, file_name, processor, put_between, table


def main(name, path):
    machine = processor()
    kept = [line for line in open(path) if not line.startswith("#")]
    (HERE / "results" / f"{file_name(machine)}_{name}.csv").write_text("".join(kept))
    rows = list(csv.reader(kept))
    lines = [f"Processor: {machine}, one thread.", ""] + table(rows[0], rows[1:])
    put_between(name, lines)
    print("\n".join(lines))


if __name__ == "__main__":
    main(*sys.argv[1:])
