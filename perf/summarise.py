"""Writes measured tables to perf/reports/, their short tables to the pages, and their pictures.

usage: summarise.py [--print] COMMAND NAME=MEASURED.csv...
COMMAND is what a reader runs for the table. --print: prints the short tables and writes nothing.
"""
import sys

import report
from pictures import PICTURES
from short_tables import BLOCKS

TWO_THREADS = {"scale"}  # blocks whose rows say how many workers they had
PAGES = {report.HERE / "README.md": "reports", report.HERE / "trade" / "README.md": "../reports"}


def put_table(command, name, block, table):
    page, folder = next((page, folder) for page, folder in PAGES.items() if f"<!-- {block} -->" in page.read_text())
    threads = "" if block in TWO_THREADS else ", one thread"
    source = f"`{command}`, {report.processor()}{threads}; [all rows]({folder}/{name}.csv)"
    report.put_block(page, block, [source, "", *table])


def summarise(command, name, measured):
    report.write(name, command, measured)
    rows = report.read(measured)
    for block, short_table in BLOCKS[name].items():
        put_table(command, name, block, short_table(rows))
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
