"""Reports: perf/reports/NAME.csv, whose first line names the command and the processor, and short tables of them in pages."""
import csv
import pathlib
import re

HERE = pathlib.Path(__file__).parent
REPORTS = HERE / "reports"


def processor():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    names = {key: re.search(rf"^{key}\s*: (.*)$", text, re.MULTILINE) for key in ("model name", "cpu family", "model")}
    known = {key: match.group(1) if match else "unknown" for key, match in names.items()}
    return f"{known['model name']} family {known['cpu family']} model {known['model']}"


def read(path):
    """Rows of a CSV file; lines that begin with # are comments."""
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def write(name, command, measured):
    REPORTS.mkdir(exist_ok=True)
    text = pathlib.Path(measured).read_text()
    (REPORTS / f"{name}.csv").write_text(f"# {command}; {processor()}\n{text}")


def table(columns, rows):
    """Lines of a Markdown table."""
    lines = [columns, ["-"] * len(columns), *rows]
    return ["|" + "|".join(map(str, line)) + "|" for line in lines]


def put_block(page, block, lines):
    """Replaces the text between the page's markers of that block."""
    begin, end = f"<!-- {block} -->", f"<!-- end of {block} -->"
    head, rest = page.read_text().split(begin)
    page.write_text("\n".join([head + begin, *lines, end]) + rest.split(end)[1])
