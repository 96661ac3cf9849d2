"""Reports: perf/reports/NAME.csv, whose first line names the command and the processor, and short tables of them in pages."""
import csv
import os
import pathlib
import re

HERE = pathlib.Path(__file__).parent
REPORTS = HERE / "reports"
FIRST_LINE = re.compile(r"# (.+); (.+ family \S+ model \S+)\n")


def processor():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    names = {key: re.search(rf"^{key}\s*: (.*)$", text, re.MULTILINE) for key in ("model name", "cpu family", "model")}
    known = {key: match.group(1) if match else "unknown" for key, match in names.items()}
    return f"{known['model name']} family {known['cpu family']} model {known['model']}"


def rows(text):
    """Rows of a CSV text; lines that begin with # are comments."""
    return list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))


def stated(command, text):
    """The report of a measurement; a stored report is one already."""
    return text if FIRST_LINE.match(text) else f"# {command}; {processor()}\n{text}"


def replace(path, data):
    """Writes a whole file or leaves the old one."""
    part = path.with_name(f"{path.name}.part")
    part.write_bytes(data)
    os.replace(part, path)


def table(columns, rows):
    """Lines of a Markdown table."""
    lines = [columns, ["-"] * len(columns), *rows]
    return ["|" + "|".join(map(str, line)) + "|" for line in lines]


def put_block(text, block, lines):
    """The page with these lines between its markers of that block."""
    begin, end = f"<!-- {block} -->", f"<!-- end of {block} -->"
    head, rest = text.split(begin)
    return "\n".join([head + begin, *lines, end]) + rest.split(end)[1]
