"""Prints one CSV row for each benchmark in files of Google Benchmark's JSON.

usage: benchmark_rows.py MEASURED.json...
Times are thread CPU time over the repetitions. A fraction is of the peak measured in the same process.
"""
import csv
import json
import pathlib
import statistics
import sys

COLUMNS = ["bench", "runs", "median_us", "min_us", "max_us", "mega_operations", "giga_a_second", "fraction_of_peak"]


def repetitions(files):
    """{bench: its runs}, sorted by name."""
    runs = {}
    for file in files:
        for run in json.loads(pathlib.Path(file).read_text())["benchmarks"]:
            if run["run_type"] == "iteration" and not run.get("error_occurred"):
                runs.setdefault(run["name"], []).append(run)
    return dict(sorted(runs.items()))


def median_us(runs):
    return statistics.median(run["cpu_time"] for run in runs)


def speed(runs):
    return runs[0]["mega_operations"] / median_us(runs) * 1e3


def rows(benches):
    for name, runs in benches.items():
        times = [run["cpu_time"] for run in runs]
        peak = benches.get("int8_peak" if "u8s8" in name or "int8" in name else "fma_peak")
        yield [name, runs[0]["label"], f"{median_us(runs):.1f}", f"{min(times):.1f}", f"{max(times):.1f}",
               f"{runs[0]['mega_operations']:.4g}", f"{speed(runs):.1f}", f"{speed(runs) / speed(peak):.2f}" if peak else ""]


def refuse(problem):
    print(f"benchmark_rows.py: {problem}", file=sys.stderr)
    sys.exit(2)


if __name__ == "__main__":
    if not sys.argv[1:]:
        refuse("usage: benchmark_rows.py MEASURED.json...")
    try:
        lines = [COLUMNS, *rows(repetitions(sys.argv[1:]))]
    except (OSError, ValueError, LookupError, TypeError) as problem:
        refuse(f"not tables of Google Benchmark: {type(problem).__name__}: {problem}")
    csv.writer(sys.stdout, lineterminator="\n").writerows(lines)
