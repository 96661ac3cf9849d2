"""Writes measured tables to perf/reports/, their short tables to the pages, and their pictures.

usage: summarise.py [--print] COMMAND NAME=MEASURED.csv...
COMMAND is what a reader runs for the table; a stored report as MEASURED keeps its own. --print: prints the short tables and writes nothing.
"""
import pathlib
import sys

import report
from short_tables import BLOCKS

WORKERS_IN_ROWS = {"scale"}  # blocks whose rows say where there are several; the rows of all others are of one thread
PAGES = {report.HERE / "README.md": "reports", report.HERE / "trade" / "README.md": "../reports"}
PICTURES = {"frames": "frames.png", "scale": "scale.png", "rods_trade": "rods.png"}


def refuse(problem):
    print(f"summarise.py: {problem}", file=sys.stderr)
    sys.exit(2)


def blocks(name, text):
    """{block: (its page, its lines)} of a report's text."""
    command, processor = report.FIRST_LINE.match(text).groups()
    rows = report.rows(text)
    if not rows:
        raise ValueError("no rows")
    made = {}
    for block, short_table in BLOCKS[name].items():
        page, folder = next((page, folder) for page, folder in PAGES.items() if f"<!-- {block} -->" in page.read_text())
        threads = "" if block in WORKERS_IN_ROWS else ", one thread"
        made[block] = page, [f"`{command}`, {processor}{threads}; [all rows]({folder}/{name}.csv)", "", *short_table(rows)]
    return made


def picture(name, text):
    import pictures  # needs matplotlib

    return pictures.png(name, report.rows(text), report.FIRST_LINE.match(text).group(2))


def summarise(command, named, only_print=False):
    """named: pairs of a report's name and the path of its measurement."""
    files, pages = {}, {page: page.read_text() for page in PAGES}
    for name, measured in named:
        try:
            text = report.stated(command, pathlib.Path(measured).read_text())
            made = blocks(name, text)
            if name in PICTURES and not only_print:
                files[report.REPORTS / PICTURES[name]] = picture(name, text)
        except Exception as problem:  # the table of another program fails anywhere
            refuse(f"{name}={measured}: {type(problem).__name__}: {problem}")
        files[report.REPORTS / f"{name}.csv"] = text.encode()
        for block, (page, lines) in made.items():
            pages[page] = report.put_block(pages[page], block, lines)
            if only_print:
                print("\n".join(lines[2:]))
    if not only_print:
        for path, data in (files | {page: text.encode() for page, text in pages.items()}).items():
            report.replace(path, data)


def main(arguments):
    only_print = arguments[:1] == ["--print"]
    command, *named = arguments[only_print:] or [""]
    if not named:
        refuse("usage: summarise.py [--print] COMMAND NAME=MEASURED.csv...")
    pairs = [argument.partition("=")[::2] for argument in named]
    for argument, (name, measured) in zip(named, pairs):
        if name not in BLOCKS or not measured:
            refuse(f"{argument}: not NAME=MEASURED.csv with a NAME of {', '.join(BLOCKS)}")
    summarise(command, pairs, only_print)


if __name__ == "__main__":
    main(sys.argv[1:])
