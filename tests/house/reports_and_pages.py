"""Checks that each generated block of the pages of measurements is what perf/summarise.py makes of the stored reports.

usage: reports_and_pages.py PROJECT_ROOT
Exit 1 with a line a difference.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(ROOT / "perf"))
import report  # noqa: E402
import summarise  # noqa: E402


def differences():
    begun = {block for page in summarise.PAGES for block in re.findall(r"<!-- (?!end of )(\S+) -->", page.read_text())}
    for name in summarise.BLOCKS:
        made = summarise.blocks(name, (report.REPORTS / f"{name}.csv").read_text())
        begun -= made.keys()
        for block, (page, lines) in made.items():
            text = page.read_text()
            if report.put_block(text, block, lines) != text:
                yield f"{page.relative_to(ROOT)}: {block} is not what perf/reports/{name}.csv gives"
    for block in begun:
        yield f"{block}: no report makes this block"


found = list(differences())
for line in found:
    print(line)
sys.exit(bool(found))
