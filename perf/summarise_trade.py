"""Writes perf/results/<processor>_rods_trade.csv, perf/trade/rods.png and the tables of perf/trade/README.md.

usage: summarise_trade.py TRADE.csv...      what build/release/bin/perf_trade_rods wrote
Lines of the scene `collisions` go to tables and a file of their own, <processor>_rods_contacts.csv: not all of its steps are solved.
Of files with no line of it those stay, and of files with no other line all others.
"""
import csv
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from summarise import HERE, file_name, processor, put_between, table

RESIDUALS = ["1e-02", "1e-04", "1e-06"]
PAGE = HERE / "trade" / "README.md"


def read(paths):
    """{(scene, strands, segments, young_pa, residual): {(solver, start): row}}"""
    cases = {}
    for row in (row for path in paths for row in csv.DictReader(line for line in open(path) if not line.startswith("#"))):
        case = (row["scene"], int(row["strands"]), int(row["segments"]), float(row["young_pa"]), row["residual"])
        cases.setdefault(case, {})[row["solver"], row["start"]] = row
    return cases


def write(paths, collisions, path):
    """The lines of the first file's beginning, then those of the scene or of all others."""
    lines = [line for path in paths for line in open(path)]
    wanted = [line for line in lines[2:] if line[0] != "#" and not line.startswith("scene,") and line.startswith("collisions,") == collisions]
    path.write_text("".join(lines[:2] + wanted))


def us(row):
    return float(row["us_a_strand"])


def options(cases):
    """(solver, start), in the order of the file."""
    return list(dict.fromkeys(option for of in cases.values() for option in of))


def scenes(cases):
    return list(dict.fromkeys(case[0] for case in cases))


def best(of):
    """The fastest that reached the residual in most states, or None."""
    reached = {option: us(row) for option, row in of.items() if math.isfinite(us(row))}
    return min(reached, key=reached.get) if reached else None


def wins_table(cases):
    """By residual: cases reached, cases won, and the time against the fastest, for each solver and start."""
    lines = []
    for solver, start in options(cases):
        line = [solver, start]
        for residual in RESIDUALS:
            those = [of for case, of in cases.items() if case[4] == residual and (solver, start) in of]
            reached = [of for of in those if math.isfinite(us(of[solver, start]))]
            won = sum(best(of) == (solver, start) for of in reached)
            slower = [us(of[solver, start]) / us(of[best(of)]) for of in reached]
            mean = math.exp(sum(map(math.log, slower)) / len(slower)) if slower else math.nan
            line += [f"{len(reached)} of {len(those)}", str(won), f"{mean:.2f}"]
        lines.append(line)
    columns = ["solver", "start"] + [f"{word} {r}" for r in RESIDUALS for word in ("reaches", "wins", "over the fastest, to")]
    return table(columns, lines)


def named(of):
    """Who is fastest and its time; starts that differ by less than a twentieth are one."""
    winner = best(of)
    if winner is None:
        return "none"
    near = [start for (solver, start), row in of.items() if solver == winner[0] and us(row) < 1.05 * us(of[winner])]
    return f"{winner[0]} {'/'.join(near)} {us(of[winner]):.1f}"


def fastest_table(cases, scene, strands, residual="1e-04"):
    """Who is fastest, at what time, over segments and moduli."""
    those = {case: of for case, of in cases.items() if case[0] == scene and case[1] == strands and case[4] == residual}
    moduli = sorted({case[3] for case in those})
    lines = []
    for segments in sorted({case[2] for case in those}):
        lines.append([str(segments)] + [named(those.get((scene, strands, segments, young, residual), {})) for young in moduli])
    return table(["segments"] + [f"{young:.0e} Pa" for young in moduli], lines)


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values)) if values else math.nan


def starts_table(cases):
    """Iterations and time of each start over those of `zero` with the same solver, by modulus, to 1e-4 and 1e-6."""
    lines = []
    for solver, start in options(cases):
        if start == "zero":
            continue
        for residual in RESIDUALS[1:]:
            line = [solver, start, residual]
            for young in sorted({case[3] for case in cases}):
                pairs = [(of[solver, start], of[solver, "zero"]) for case, of in cases.items()
                         if case[3] == young and case[4] == residual and (solver, start) in of and (solver, "zero") in of]
                pairs = [(a, b) for a, b in pairs if math.isfinite(us(a)) and math.isfinite(us(b))]
                work = "inner_mean" if solver == "cg" else "iterations_mean"
                steps = [float(a[work]) / float(b[work]) for a, b in pairs if float(b[work]) > 0 and float(a[work]) > 0]
                line.append(f"{geometric_mean(steps):.2f}, {geometric_mean([us(a) / us(b) for a, b in pairs]):.2f}")
            lines.append(line)
    return table(["solver", "start", "to"] + [f"{young:.0e} Pa" for young in sorted({case[3] for case in cases})], lines)


def reached_table(cases):
    """Of each solver and start: the states in which a residual was reached, and cases in which it was in most."""
    lines = []
    for solver, start in options(cases):
        line = [solver, start]
        for residual in RESIDUALS:
            those = [of[solver, start] for case, of in cases.items() if case[4] == residual and (solver, start) in of]
            states, reached = (sum(int(row[word]) for row in those) for word in ("states", "reached"))
            line.append(f"{100 * reached / states:.0f} % of {states}, {sum(math.isfinite(us(row)) for row in those)} of {len(those)} cases" if states else "")
        if any(line[2:]):
            lines.append(line)
    return table(["solver", "start"] + [f"reaches {residual}" for residual in RESIDUALS], lines)


def plot_time(axes, cases, scene):
    for number, (solver, start) in enumerate(options(cases)):
        points = {}
        for (name, strands, segments, _, residual), of in cases.items():
            if (name, strands, residual) == (scene, 1, "1e-04") and (solver, start) in of and math.isfinite(us(of[solver, start])):
                points.setdefault(segments, []).append(us(of[solver, start]))
        if points:
            n = sorted(points)
            line, = axes.loglog(n, [geometric_mean(points[k]) for k in n], marker="o", ms=3, color=f"C{number}", label=f"{solver}, {start}")
            axes.fill_between(n, [min(points[k]) for k in n], [max(points[k]) for k in n], alpha=0.12, color=line.get_color())
    axes.set(title=scene, xlabel="segments", xticks=[10, 30, 50, 100, 200], xticklabels=[10, 30, 50, 100, 200])
    axes.minorticks_off()


def plot_iterations(axes, cases, scene):
    for number, (solver, start) in enumerate(options(cases)):
        if solver != "direct":
            continue
        points = [(case[3], float(of[solver, start]["iterations_mean"])) for case, of in sorted(cases.items(), key=lambda c: c[0][3])
                  if case[:3] == (scene, 1, 50) and case[4] == "1e-06" and (solver, start) in of and int(of[solver, start]["reached"])]
        if points:
            axes.semilogx(*zip(*points), marker="o", ms=3, color=f"C{number}")
    axes.set(xlabel="Young's modulus, Pa", ylim=(0, None))


def plot(cases, path):
    names = scenes(cases)
    figure, rows = plt.subplots(2, len(names), figsize=(3.2 * len(names), 5.6), constrained_layout=True, squeeze=False)
    for column, scene in enumerate(names):
        plot_time(rows[0][column], cases, scene)
        plot_iterations(rows[1][column], cases, scene)
    rows[0][0].set_ylabel("us a step, to residual 1e-4\n(line: mean over moduli, band: all)")
    rows[1][0].set_ylabel("iterations of direct to 1e-6, 50 segments")
    figure.legend(*rows[0][0].get_legend_handles_labels(), loc="lower center", bbox_to_anchor=(0.5, -0.08), ncol=5, fontsize=7)
    for axes in rows.flat:
        axes.grid(alpha=0.3)
    figure.savefig(path, dpi=100, bbox_inches="tight")


def main(paths):
    everything, machine = read(paths), processor()
    contacts, cases = ({case: of for case, of in everything.items() if (case[0] == "collisions") == wanted} for wanted in (True, False))
    if contacts:
        write(paths, True, HERE / "results" / f"{file_name(machine)}_rods_contacts.csv")
        lines = [f"Processor: {machine}, one thread.", ""] + reached_table(contacts) + [""] + wins_table(contacts)
        put_between("collisions", lines, PAGE)
    if not cases:
        return
    write(paths, False, HERE / "results" / f"{file_name(machine)}_rods_trade.csv")
    plot(cases, HERE / "trade" / "rods.png")
    put_between("wins", [f"Processor: {machine}, one thread.", ""] + wins_table(cases), PAGE)
    put_between("starts", starts_table(cases), PAGE)
    lines = []
    for scene in scenes(cases):
        for strands in sorted({case[1] for case in cases if case[0] == scene}):
            many = f"{strands} strands at a time, us a strand" if strands > 1 else "one rod, us"
            lines += [f"**{scene}**, {many}:", ""] + fastest_table(cases, scene, strands) + [""]
    put_between("fastest", lines[:-1], PAGE)
    print(PAGE.read_text())


if __name__ == "__main__":
    main(sys.argv[1:])
