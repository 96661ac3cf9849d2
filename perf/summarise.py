"""Writes measured tables to perf/reports/, their short tables to the pages, and their pictures.

usage: summarise.py [--print] COMMAND NAME=MEASURED.csv...
COMMAND is what a reader runs for the table. --print: prints the short tables and writes nothing.
"""
import sys

import report
from pictures import PICTURES
from short_tables import BLOCKS

TWO_THREADS = {"scale"}  # blocks whose rows say how many workers they had
PAGES = [report.HERE / "README.md", report.HERE / "trade" / "README.md"]


def page_of(block):
    return next(page for page in PAGES if f"<!-- {block} -->" in page.read_text())


def summarise(command, name, measured):
    report.write(name, command, measured)
    rows = report.read(measured)
    for block, short_table in BLOCKS[name].items():
        threads = "" if block in TWO_THREADS else ", one thread"
        report.put_table(block, name, f"`{command}`, {report.processor()}{threads}", short_table(rows), page_of(block))
    if name in PICTURES:
        PICTURES[name](rows)


def main(arguments):
    only_print = arguments[0] == "--print"
    command, *named = arguments[only_print:]
    for name, measured in (argument.split("=", 1) for argument in named):
        if only_print:
            for short_table in BLOCKS[name].values():
                print("\n".join(short_table(report.read(measured))))
        else:
            summarise(command, name, measured)


if __name__ == "__main__":
    main(sys.argv[1:])
