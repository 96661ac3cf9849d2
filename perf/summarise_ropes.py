"""Writes perf/results/<processor>_ropes.csv and the table of ropes in perf/README.md.

usage: summarise_ropes.py ROPES.csv      what build/release/bin/perf_ropes wrote
"""
import csv
import shutil
import sys

from summarise import HERE, file_name, processor, put_between, table


def main(path):
    machine = processor()
    shutil.copyfile(path, HERE / "results" / f"{file_name(machine)}_ropes.csv")
    rows = list(csv.DictReader(open(path)))
    lines = [f"Processor: {machine}, one thread.", ""]
    lines += table(list(rows[0]), [list(row.values()) for row in rows])
    put_between("ropes", lines)
    print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1])
