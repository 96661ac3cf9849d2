"""Writes perf/results/<processor>.csv and the tables of perf/README.md from files of Google Benchmark's JSON.

usage: summarise.py MEASURED.json...
Times are medians over the repetitions of thread CPU time. A share is of the peak measured in the same process.
"""
import csv
import json
import pathlib
import re
import statistics
import sys

HERE = pathlib.Path(__file__).parent
COLUMNS = ["bench", "runs", "median_us", "min_us", "max_us", "mega_operations", "giga_a_second", "share_of_peak"]
# what, of what, the figure wanted at least and the aim; below 1 is faster for the first half, above for the second
RATIOS = [
    ("alt_conv_lstm_paper", "onednn_sgemm_paper", "1.25", "1.05"),
    ("alt_conv_lstm_fp16_paper", "onednn_sgemm_paper", "", ""),
    ("alt_conv_lstm_int8_paper", "onednn_u8s8s32_paper", "1.6", "1.15"),
    ("alt_conv_lstm_int8_paper", "alt_conv_lstm_paper", "", ""),
    ("alt_conv_lstm_control_graph", "onednn_sgemm_control_graph", "", ""),
    ("alt_conv_lstm_fp16_creature", "alt_conv_lstm_creature", "", ""),
    ("alt_conv_lstm_int8_creature", "alt_conv_lstm_creature", "", ""),
    ("alt_conv_lstm_fp16_wide", "alt_conv_lstm_wide", "", ""),
    ("alt_conv_lstm_int8_wide", "alt_conv_lstm_wide", "", ""),
    ("deep_emulator_chains", "onednn_sgemm_deep_emulator", "1.3", "1.1"),
    ("deep_emulator_step", "onednn_sgemm_deep_emulator", "", ""),
    ("eigen_products_paper", "alt_conv_lstm_paper", "", ""),
    ("pytorch_paper", "alt_conv_lstm_paper", "5", "6"),
    ("pytorch_paper", "alt_conv_lstm_int8_paper", "14", "20"),
]


def processor():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    names = {key: re.search(rf"^{key}\s*: (.*)$", text, re.MULTILINE) for key in ("model name", "cpu family", "model")}
    known = {key: match.group(1) if match else "unknown" for key, match in names.items()}
    return f"{known['model name']} family {known['cpu family']} model {known['model']}"


def repetitions(files):
    """{bench: its runs}, in the order of the files."""
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


def ratios(benches):
    for what, of, least, aim in RATIOS:
        if what in benches and of in benches:
            yield [f"{what} / {of}", f"{median_us(benches[what]) / median_us(benches[of]):.2f}", least, aim]


def table(columns, lines):
    rule = "|" + "---|" * len(columns)
    return ["| " + " | ".join(columns) + " |", rule] + ["| " + " | ".join(line) + " |" for line in lines]


def file_name(machine):
    return re.sub(r"[^a-z0-9]+", "_", machine.lower()).strip("_")


def put_between(name, lines, readme=HERE / "README.md"):
    """Into a page, in the place of what stands between its marks of that name."""
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    head, rest = readme.read_text().split(begin)
    readme.write_text(head + begin + "\n" + "\n".join(lines) + "\n" + end + rest.split(end)[1])


def main(files):
    benches, machine = repetitions(files), processor()
    measured, compared = list(rows(benches)), list(ratios(benches))
    (HERE / "results").mkdir(exist_ok=True)
    with open(HERE / "results" / f"{file_name(machine)}.csv", "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS] + measured)
    lines = [f"Processor: {machine}, one thread.", ""] + table(COLUMNS, measured)
    lines += [""] + table(["ratio of medians", "measured", "at least", "aim"], compared)
    put_between("table", lines)
    print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1:])
