"""The short tables of the pages: the rows of a report that answer a section's question.

BLOCKS[report][block] makes the lines of a Markdown table from the report's rows.
"""
import math
import statistics

from report import table


def times(value, digits=2):
    return f"{value:.{digits}f}"


def find(rows, **wanted):
    """The rows whose columns have these values."""
    return [row for row in rows if all(row[key] == str(value) for key, value in wanted.items())]


def only(rows, **wanted):
    row, = find(rows, **wanted)
    return row


# Kernels

KERNELS = {  # bench: row of the page
    "alt_conv_lstm_paper": "paper's network, 6,890 vertices, float32",
    "alt_conv_lstm_fp16_paper": "fp16 states",
    "alt_conv_lstm_int8_paper": "int8",
    "deep_emulator_chains": "Deep Emulator, 1,468 vertices",
    "alt_conv_lstm_creature": "character's network, float32",
    "alt_conv_lstm_fp16_creature": "fp16 states",
    "alt_conv_lstm_int8_creature": "int8",
}
PEERS = {  # column of the page: {bench: its peer}
    "oneDNN's products ÷ it": {"alt_conv_lstm_paper": "onednn_sgemm_paper", "alt_conv_lstm_fp16_paper": "onednn_sgemm_paper",
                                         "alt_conv_lstm_int8_paper": "onednn_u8s8s32_paper", "deep_emulator_chains": "onednn_sgemm_deep_emulator"},
    "Eigen's products ÷ it": {"alt_conv_lstm_paper": "eigen_products_paper"},
    "PyTorch ÷ it": dict.fromkeys(["alt_conv_lstm_paper", "alt_conv_lstm_fp16_paper", "alt_conv_lstm_int8_paper"], "pytorch_paper"),
}


def kernels(rows):
    us = {row["bench"]: float(row["median_us"]) for row in rows}
    fraction = {row["bench"]: row["fraction_of_peak"] for row in rows}
    measured = {column: peers for column, peers in PEERS.items() if any(peer in us for peer in peers.values())}
    lines = []
    for bench, label in KERNELS.items():
        ratios = [times(us[peers[bench]] / us[bench]) if peers.get(bench) in us else "" for peers in measured.values()]
        lines.append([label, f"{us[bench]:,.0f}", fraction[bench], *ratios])
    return table(["step", "µs", "fraction of peak", *measured], lines)


# Scale

PARTS = {  # subject of the report: row of the page
    "modal base": "modal base",
    "network step": "network",
    "inputs; closing on the base; guards": "network inputs and guards",
    "embedding; skin matrices": "embedding and skin matrices",
    "whole tick": "**whole tick**",
    "read: bind-space deltas": "reading displacements, for skinning on the GPU",
    "read: positions": "reading skinned positions",
    "read: normals": "reading normals",
}


def character(rows):
    lines = []
    for subject, label in PARTS.items():
        of = {row["quantity"]: float(row["value"]) for row in find(rows, group="parts", subject=subject)}
        lines.append([label, times(of["us"], 1), times(of["share_of_peak"]) if "share_of_peak" in of else ""])
    return table(["part", "µs", "fraction of peak"], lines)


def scale(rows):
    cases = {}
    for row in rows:
        cases.setdefault((row["group"], int(row["vertices"]), int(row["instances"]), int(row["workers"])), {})[row["quantity"]] = float(row["value"])
    sizes = sorted(vertices for group, vertices, *_ in cases if group == "vertices")
    lines = []
    for vertices in sizes[1::2]:
        of = cases["vertices", vertices, 1, 1]
        lines.append([f"one of {vertices:,} vertices", times(of["cpu_us"], 0), times(of["read_us"], 0), times(of["instance_bytes"] / 1e3, 0)])
    for workers in (1, 2):
        of = next(of for (group, _, n, w), of in cases.items() if (group, n, w) == ("instances", 100, workers))
        lines.append([f"100, {workers} worker{'s' * (workers > 1)}", times(of["wall_us"] / 100, 0), "", ""])
    return table(["instances", "step, µs each", "reading positions, µs", "memory, kB"], lines)


# Crowds

FRAMES = [("steady", 100, 4000), ("steady", 500, 8000), ("entrance", 100, 4000), ("walls", 500, 4000), ("neighbour", 100, 2000), ("steady", 16, 100),
          ("yardstick", 0, 4000)]


def frames(rows):
    lines = []
    for trouble, instances, budget_us in FRAMES:
        row = only(rows, trouble=trouble, instances=instances, budget_us=budget_us)
        scene = f"{trouble}, {instances} in {budget_us / 1000:g} ms" if instances else trouble
        chosen = [f"{100 * float(row['network']):.0f}", times(float(row["expected_error"]))] if instances else ["", ""]
        lines.append([scene, *[times(float(row[f"cpu_{quantile}"])) for quantile in ("p50", "p99", "p999", "worst")],
                      times(float(row["wall_p99"])), *chosen])
    return table(["scene", "median", "p99", "p99.9", "worst", "p99 by the wall", "network, %", "expected error"], lines)


def crowd_error(rows):
    lines = []
    for motion in dict.fromkeys(row["motion"] for row in rows):
        in_4_ms, unlimited = (only(rows, motion=motion, budget_us=budget_us) for budget_us in ("4000", "inf"))
        lines.append([motion, times(float(in_4_ms["expected"])), times(float(in_4_ms["measured"])), times(float(unlimited["measured"]))])
    return table(["clip", "expected, 4 ms", "measured, 4 ms", "measured, no budget"], lines)


def gaps(rows):
    tier = [row["tier"] for row in rows][-1]
    lines = [[row["gap_ticks"], *[times(float(row[key])) for key in ("in_gap", "to_4", "to_12", "to_40", "without_gap", "beyond_both_percent")]]
             for row in find(rows, motion="hop", tier=tier)]
    return table(["ticks not simulated", "error in the gap", "ticks 1-4 after", "5-12", "13-40", "without a gap", "excess motion, % of height"], lines)


EXTRAPOLATE = "extrapolate"  # the tier that stops simulation


def largest(rows, measure):
    return times(max(float(row[measure]) for row in rows)) if rows else ""


def jumps(rows):
    """For each clip the largest excess motion of changes between simulated tiers, of stopping, and of resuming."""
    simulated = {row["to"] for row in rows} - {EXTRAPOLATE}
    lines = []
    for clip in dict.fromkeys(row["clip"] for row in rows):
        of = find(rows, clip=clip)
        between = [row for row in of if row["from"] in simulated and row["to"] != EXTRAPOLATE]
        resuming = [row for row in of if row["from"] not in simulated]
        lines.append([clip, times(float(of[0]["own_step_percent"])), largest(between, "beyond_both_percent"),
                      largest(find(of, to=EXTRAPOLATE), "beyond_both_percent"), largest(resuming, "beyond_both_percent"),
                      largest(resuming, "beyond_all_percent")])
    return table(["clip", "fastest vertex without a change", "between simulated tiers", "simulation stops", "simulation resumes", "beyond the earlier tier too"], lines)


BETWEEN = {  # measure of the report: row of the page
    "judder at 144 frames a second": "144, judder",
    "judder at 240 frames a second": "240, judder",
    "judder at 240 with the last velocity extrapolated": "240, judder if the last velocity is extrapolated (rejected)",
    "30 frames a second, off 60": "30 against 60, difference over motion",
    "240 frames a second, off 60": "240 against 60",
}


def between(rows):
    worst = {row["measure"]: times(float(row["worst"])) for row in rows}
    lines = [[label, worst[f"bob, {name}"], worst[f"liveliest clip, {name}"]] for name, label in BETWEEN.items()]
    return table(["frames a second", "bob", "clip"], lines)


# Contacts

def contacts(rows):
    lines = [[f"{row['motion']}, {row['with']}", row["us_a_step"], row["over_rods"], row["iterations_a_strand"], row["contacts"], row["deepest"]]
             for row in rows if row["with"] != "nothing"]
    return table(["head, collider", "µs a step", "added over rods", "iterations", "contacts", "depth, radii"], lines)


def ropes(rows):
    lines = []
    for obstacle in ("cylinder", "box"):
        for rope, label in (("sinew", "Sinew"), ("btSoftBody_10", "Bullet, 10"), ("btSoftBody_40", "Bullet, 40"), ("btSoftBody_160", "Bullet, 160")):
            row = only(rows, obstacle=obstacle, rope=rope, ropes=16)
            lines.append([f"{obstacle}: {label}", row["us_a_rope"], times(float(row["deepest"])), f"{float(row['piece_stretch']):.1e}", f"{float(row['rope_stretch']):.1e}"])
    return table(["obstacle: solver", "µs a rope", "depth, radii", "stretch of a segment", "of the rope"], lines)


# Rods

def rods(rows):
    lines = []
    for scene, segments, column, unit in (("batch", 16, "us_a_strand_step", "µs a strand"), ("batch", 32, "us_a_strand_step", "µs a strand"),
                                          ("single", 30, "us_a_segment_iteration", "µs a segment and iteration"),
                                          ("single", 200, "us_a_segment_iteration", "µs a segment and iteration")):
        those = find(rows, scene=scene, segments=segments, solver="direct", start="previous")
        values = [float(row[column]) for row in those]
        label = "1,000 strands" if scene == "batch" else "one rod"
        lines.append([f"{label} of {segments} segments", f"{min(values):.2f} to {max(values):.2f} {unit}", f"{max(float(row['iterations']) for row in those):.1f}",
                      f"{max(float(row['largest_gap']) for row in those):.0e}", f"{max(float(row['length_ratio']) for row in those):.6f}"])
    return table(["", "time, over the moduli", "iterations, at most", "largest joint gap, segments", "length over rest length"], lines)


def us(row):
    return float(row["us_a_strand"])


def by_case(rows):
    """{(scene, strands, segments, modulus, residual): {(solver, start): row}}"""
    cases = {}
    for row in rows:
        cases.setdefault(tuple(row[key] for key in ("scene", "strands", "segments", "young_pa", "residual")), {})[row["solver"], row["start"]] = row
    return cases


def reached(of):
    return {option: us(row) for option, row in of.items() if math.isfinite(us(row))}


def geometric_mean(values):
    return math.exp(statistics.fmean(map(math.log, values))) if values else math.nan


def compared(rows, options, residuals):
    """For each solver and start: the cases in which most states reached a residual, those in which it was fastest, and its time over the fastest."""
    cases = by_case(rows)
    lines = []
    for option in options:
        line = [f"{option[0]}, {option[1]}"]
        for residual in residuals:
            those = [reached(of) for case, of in cases.items() if case[4] == residual and option in of]
            mine = [of for of in those if option in of]
            line += [f"{len(mine)} of {len(those)}", str(sum(min(of, key=of.get) == option for of in mine)),
                     times(geometric_mean([of[option] / min(of.values()) for of in mine]))]
        lines.append(line)
    columns = [f"{word} {residual}" for residual in residuals for word in ("reaches", "fastest to", "time ÷ the fastest to")]
    return table(["solver, start", *columns], lines)


DIRECT = [("direct", start) for start in ("zero", "previous", "continued", "learned", "knn")]


def rods_trade(rows):
    free = [row for row in rows if row["scene"] != "collisions"]
    return compared(free, [*DIRECT, ("cg", "continued"), ("local", "continued")], ["1e-04"])


def rod_contacts(rows):
    return compared(find(rows, scene="collisions"), [*DIRECT, ("cg", "previous")], ["1e-02", "1e-04"])


# Tiers

TIERS = ["skinning", "extrapolate", "modal, 10 nodes a region", "modal, 20 nodes a region", "modal", "network, 20 nodes a region", "network",
         "network, 60 nodes a region"]


def tiers(rows):
    lines = []
    for name in TIERS:
        row = only(rows, name=name)
        lines.append([name, *[times(float(row[key]), 1) for key in ("warm_p50_us", "warm_p99_us", "cold_p50_us", "mean_mm")], times(float(row["ratio"]), 3)])
    return table(["tier", "warm median, µs", "warm p99", "cold median", "mean error, mm", "÷ skinning's"], lines)


BLOCKS = {
    "kernels": {"kernels": kernels},
    "scale": {"character": character, "scale": scale},
    "frames": {"frames": frames},
    "crowd_error": {"crowd_error": crowd_error},
    "gaps": {"gaps": gaps},
    "jumps": {"jumps": jumps},
    "between": {"between": between},
    "contacts": {"contacts": contacts},
    "ropes": {"ropes": ropes},
    "surfaces": {},
    "rods": {"rods": rods},
    "rods_trade": {"rods_trade": rods_trade, "rod_contacts": rod_contacts},
    "tiers": {"tiers": tiers},
}
