"""Writes perf/results/<processor>.csv and the table of perf/README.md from a Google Benchmark JSON file.

usage: summarise.py MEASURED.json
Times are medians over the repetitions of thread CPU time; of_peak is the share of the multiply-add peak of the same process.
"""
import csv
import json
import pathlib
import re
import statistics
import sys

HERE = pathlib.Path(__file__).parent
COLUMNS = ["bench", "isa", "median_us", "min_us", "max_us", "mflop", "share_of_fma_peak", "fma_peak_gflops"]


def processor():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    names = {key: re.search(rf"^{key}\s*: (.*)$", text, re.MULTILINE) for key in ("model name", "cpu family", "model")}
    known = {key: match.group(1) if match else "unknown" for key, match in names.items()}
    return f"{known['model name']} family {known['cpu family']} model {known['model']}"


def rows(measured):
    """One row a benchmark, from its repetitions."""
    runs = {}
    for run in json.loads(pathlib.Path(measured).read_text())["benchmarks"]:
        if run["run_type"] == "iteration":
            runs.setdefault(run["name"], []).append(run)
    for name, repetitions in runs.items():
        times = [run["cpu_time"] for run in repetitions]
        first = repetitions[0]
        yield [name, first["label"], f"{statistics.median(times):.1f}", f"{min(times):.1f}", f"{max(times):.1f}",
               f"{first['MFLOP']:.1f}", f"{statistics.median(run['of_peak'] for run in repetitions):.2f}",
               f"{first['peak_GFLOPs']:.0f}"]


def main(measured):
    table = list(rows(measured))
    machine = processor()
    name = re.sub(r"[^a-z0-9]+", "_", machine.lower()).strip("_")
    with open(HERE / "results" / f"{name}.csv", "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS] + table)
    lines = [f"Processor: {machine}, one thread.", "", "| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    lines += ["| " + " | ".join(row) + " |" for row in table]
    readme = HERE / "README.md"
    begin, end = "<!-- table -->", "<!-- end of table -->"
    head, rest = readme.read_text().split(begin)
    readme.write_text(head + begin + "\n" + "\n".join(lines) + "\n" + end + rest.split(end)[1])
    print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1])
