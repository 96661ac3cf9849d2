"""Writes perf/results/<processor>_rods.csv and the table of rods in perf/README.md.

usage: summarise_rods.py RODS.csv      what build/release/bin/perf_rods wrote
"""
import csv
import re
import shutil
import sys

from summarise import HERE, file_name, processor, put_between, table

# Measured of others on another processor, on scenes like these.
ELSEWHERE = {("batch", 16): "Jolt 4.0-4.7 us a strand-step at 1.5 % stretch", ("batch", 32): "Jolt 8.7-9.0 at 5.8 %",
             ("single", 30): "PositionBasedDynamics 1.03-1.2 us a segment-iteration",
             ("single", 200): "PositionBasedDynamics 1.03-1.2 us a segment-iteration"}
WANTED = {("batch", 16): "3 / 1 us a strand-step", ("batch", 32): "6 / 2 us a strand-step",
          ("single", 30): "0.6 / 0.3 us a segment-iteration", ("single", 200): "0.6 / 0.3 us a segment-iteration"}
# A 2.3 GHz Xeon with AVX-512: two multiply-adds of sixteen floats a cycle.
ELSEWHERE_GFLOPS = 2.3 * 2 * 16 * 2


def read(path):
    """(the multiply-add peak, rows)"""
    lines = open(path).read().splitlines()
    peak = float(re.search(r"peak ([0-9.]+)", lines[0]).group(1))
    return peak, list(csv.DictReader(lines[1:]))


def figures(rows):
    """What the project asks for, the worst modulus of each, default settings."""
    lines = []
    for (scene, segments), wanted in WANTED.items():
        those = [r for r in rows if (r["scene"], int(r["segments"]), r["solver"], r["start"]) == (scene, segments, "direct", "previous")]
        column = "us_a_strand_step" if scene == "batch" else "us_a_segment_iteration"
        values = [float(r[column]) for r in those]
        gap = max(float(r["largest_gap"]) for r in those)
        what = "1,000 strands of" if scene == "batch" else "one rod of"
        lines.append([f"{what} {segments} segments", f"{min(values):.2f}-{max(values):.2f}", f"{100 * gap:.3f} %", wanted, ELSEWHERE[scene, segments]])
    soft = [r for r in rows if r["scene"] == "single" and r["young_pa"] == "1e+04" and r["start"] == "previous" and r["solver"] == "direct"]
    worst = max(soft, key=lambda r: abs(float(r["length_ratio"]) - 1))
    lines.append(["E=1e4, N=30-200, l/l0 over 1,000 steps", worst["length_ratio"], "", "1.01 / 1.001", "PositionBasedDynamics, 5 iterations: 1.4-1.75"])
    return table(["figure", "measured, over the moduli", "largest gap", "at least / aim", "elsewhere (another processor)"], lines)


def main(path):
    (peak, rows), machine = read(path), processor()
    shutil.copyfile(path, HERE / "results" / f"{file_name(machine)}_rods.csv")
    lines = [f"Processor: {machine}, one thread, multiply-add peak {peak:.0f} GFLOP/s in the same process; elsewhere: 2.3 GHz, AVX-512, "
             f"at most {ELSEWHERE_GFLOPS:.0f} GFLOP/s by its clock, {ELSEWHERE_GFLOPS / peak:.2f} of it.", ""] + figures(rows)
    columns = list(rows[0])
    lines += [""] + table(columns, [[row[c] for c in columns] for row in rows])
    put_between("rods", lines)
    print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1])
