"""Writes perf/results/<processor>_tiers.csv, perf/trade/tiers.png, .svg and the table of tiers in perf/trade/README.md.

usage: summarise_tiers.py DIR      what sinew-trade wrote
"""
import json
import pathlib
import shutil
import sys

from summarise import HERE, file_name, processor, put_between, table

PAGE = HERE / "trade" / "README.md"
ERRORS = ["error mm", "sd", "p95", "worst", "of skinning's"]
COLUMNS = ["", "p50, us", "p99", "cold p50", "cold p99", *ERRORS, *(f"50 ticks: {name}" for name in ERRORS), ""]


def costs(row):
    if row["kind"] == "baseline":
        return [""] * 4
    warm, cold = row["warm"], row["cold"]
    return [f"{us:.1f}" for us in (warm["p50_us"], warm["p99_us"], cold["p50_us"], cold["p99_us"])]


def verdict(row):
    if row["kind"] == "baseline":
        return "baseline"
    words = ["variant"] if row["kind"] == "variant" else []
    return "; ".join(words + ([f"dominated by {row['dominated_by']}"] if row["dominated_by"] else []))


def errors(spread):
    return [f"{spread[key]:.2f}" for key in ("mean_mm", "sd_mm", "p95_mm")] + [f"{spread['worst_mm']:.1f}", f"{spread['ratio']:.3f}"]


def line(row):
    return [row["name"]] + costs(row) + errors(row) + errors(row["in_50"]) + [verdict(row)]


def main(folder):
    measured = json.loads((folder / "trade.json").read_text())
    name = file_name(processor())
    shutil.copy(folder / "trade.csv", HERE / "results" / f"{name}_tiers.csv")
    for kind in ("png", "svg"):
        shutil.copy(folder / f"trade.{kind}", HERE / "trade" / f"tiers.{kind}")
    text = [f"Processor: {processor()}, one thread; {measured['vertices']} vertices; {'; '.join(measured['motions'])}.", ""]
    put_between("tiers", text + table(COLUMNS, [line(row) for row in measured["rows"]]), PAGE)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
