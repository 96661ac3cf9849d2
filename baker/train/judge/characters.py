"""The page of characters with networks of their own: what sinew-train stated in their weights, beside the truth's own error."""
import csv
import glob
import json
import os
import statistics

import numpy as np

from ..data import dataset
from ..data.trajectory import read_trajectory
from ..files.safetensors import BadData, load
from ..files.write_file import put_copy, write_json, write_text
from ..tune.packs import Baker
from ..tune.verdict import BASE, HARM, TUNED, Error, Row, may_win, worst
from .page import table
from .plot import COLOURS, _finish, _pyplot

WORTH = 0.9  # of the base's error on held-out motions: at most so much, or the weights are not shipped
TISSUE, GENERIC, ALL = ".tissue.safetensors", "shipped", "all"
TRACED_TICKS = 150


class Tuned:
    """One character's weights as sinew-train left them."""

    def __init__(self, path):
        self.path, self.name = path, os.path.basename(path).removesuffix(TISSUE)
        _, self.metadata = load(path)
        try:
            told = json.loads(self.metadata["held_out"])
            rows = [Row(m, {n: Error(**errors[n]) for n in (BASE, GENERIC, TUNED)}) for m, errors in told.items()]
            self.motions, self.minutes = len(self.metadata["data"].split(", ")), float(self.metadata["tuned_minutes"])
            self.all = next(row for row in rows if row.motion == ALL)
            self.rows = [row for row in rows if row.motion != ALL]
            worst(self.rows, TUNED)
        except (KeyError, ValueError, TypeError, StopIteration):
            raise BadData(
                f"{path}: states no errors of base, shipped and own network on held-out motions; run sinew-train --keep "
                "from the shipped weights"
            ) from None

    def pays(self, name=TUNED):
        return self.all.of_base(name) <= WORTH and worst(self.rows, name)[1] <= 1 + HARM


def _own_errors(path):
    """character -> (median against finer steps, against finer cells), of the truth itself."""
    with open(path) as file:
        rows = list(csv.DictReader(file))
    of = lambda name, key: [float(r[key]) for r in rows if r["character"] == name and r[key]]
    median = lambda values: statistics.median(values) if values else float("nan")
    return {r["character"]: tuple(median(of(r["character"], key)) for key in ("many", "finer")) for r in rows}


def _draw_errors(tuned, titles, path):
    figure, a = _pyplot().subplots(figsize=(8, 0.5 * len(tuned) + 1.2))
    places = np.arange(len(tuned))
    for i, (name, label) in enumerate(((BASE, "modal base"), (GENERIC, "generic network"), (TUNED, "its own network"))):
        a.barh(places + 0.27 * i, [t.all.errors[name].ratio for t in tuned], 0.25, color=COLOURS[i], label=label)
    a.set_yticks(places + 0.27, [titles.get(t.name, t.name) for t in tuned])
    a.invert_yaxis()
    a.set_xlabel("error on held-out motions / error of skinning alone")
    a.legend(frameon=False, fontsize=8)
    _finish(figure, [a], path)


def _draw_trace(one, title, work, bake, path):
    """The node that the base misses most, in the held-out motion where the network mends most."""
    best = max(one.rows, key=lambda row: row.errors[BASE].mean_mm - row.errors[TUNED].mean_mm)
    motion, seed = best.motion.rsplit(" x", 1)[0].rsplit(" #", 1)
    folder = max(glob.glob(os.path.join(work, f"{one.name}.train", "*", "")), key=os.path.getmtime, default="")
    files = glob.glob(os.path.join(folder, f"test-*-{seed}.safetensors"))
    true = next((t for t in map(read_trajectory, files) if t.metadata["motion"] == motion), None)
    if true is None:
        raise BadData(f"{work}: {one.name}.train holds no {best.motion}; it lies beside the weights that sinew-train wrote")
    packs, trace = [os.path.join(folder, f"{k}.sinew") for k in ("base", "tuned")], os.path.join(work, "trace.safetensors")
    if os.path.exists(trace):
        os.remove(trace)
    ticks, baker = len(true.displacement) - 1, Baker(bake, "")
    limits = [region["displacement_limit_m"] for region in baker.describe(packs[0])["regions"]]
    (held,) = dataset.group([("", true)], limits=limits)
    baker.run("judge", *packs, "--truth", true.path, "--ticks", str(ticks), "--trace", trace)
    told = load(trace)[0]
    lines = [held.displacement[0].numpy(), np.array(told["displacement.0"]), np.array(told["displacement.1"])]
    missed = np.linalg.norm(lines[1] - lines[0], axis=-1)
    node = missed.mean(0).argmax()
    axis = np.abs(lines[0][:, node]).mean(0).argmax()
    middle = int(np.clip(missed[:, node].argmax(), TRACED_TICKS // 2, ticks - TRACED_TICKS // 2))
    span = slice(middle - TRACED_TICKS // 2, middle + TRACED_TICKS // 2)
    figure, a = _pyplot().subplots(figsize=(8, 3))
    t_s = np.arange(ticks + 1)[span] / true.rate_hz
    for line, label, colour in zip(lines, ("truth, as far as it may be shown", "modal base", "its own network"), ("#111827", *COLOURS[0:3:2])):
        a.plot(t_s, 1e3 * line[span, node, axis], label=label, color=colour, lw=1.4)
    a.set_xlabel("time, s")
    a.set_ylabel("displacement, mm")
    a.set_title(f"{title}, {motion.removeprefix('clip:')}: the node that the base misses most", fontsize=9)
    a.legend(frameon=False, fontsize=8)
    _finish(figure, [a], path)


def _cells(one, titles, truth):
    e = one.all.errors
    motion, most = worst(one.rows, TUNED)
    many, finer = truth.get(one.name, (float("nan"),) * 2)
    return [
        titles.get(one.name, one.name),
        f"{one.motions}, {len(one.rows)}",
        f"{one.minutes:.1f}",
        f"{e[BASE].mean_mm:.2f} ({e[BASE].ratio:.3f})",
        f"{e[GENERIC].mean_mm:.2f} ({one.all.of_base(GENERIC):.2f})",
        f"{e[TUNED].mean_mm:.2f} (**{one.all.of_base(TUNED):.2f}**)",
        f"{e[BASE].p95_mm:.1f}, {e[TUNED].p95_mm:.1f}",
        f"{e[BASE].velocity_ratio:.2f}, {e[TUNED].velocity_ratio:.2f}",
        f"{most:.2f} ({motion.replace('|', chr(92) + '|')})",
        f"{many:.3f}, {finer:.2f}",
        "yes" if one.pays() else "no",
    ]


def _family(path):
    """What the generic network leaves on the bodies that it was made for, after 200 ticks of motions it never saw."""
    with open(path) as file:
        metrics = json.load(file)
    network, rows = next(iter(metrics["models"])), []
    for body, figures in metrics["bodies"].items():
        at = figures["roll_out"]["200"]
        seen = "trained on" if figures["seen_in_training"] else "never trained on"
        cell = lambda m: f"{at[m]['mean_mm']:.2f} ({at[m]['ratio']:.3f})"
        of_base = at[network]["ratio"] / at["modal_warped"]["ratio"]
        rows.append([f"{body}, {seen}", cell("modal_warped"), cell(network), f"{of_base:.2f}"])
    return table(["body of the creature's family", "modal base, mm (of skinning's)", "generic, mm (of skinning's)", "of base"], rows)


HEAD = (
    "character", "motions trained on, held out", "best after, min of training", "modal base, mm (of skinning's)", "generic, mm (of base)", "its own, mm (of base)",
    "95th percentile, mm: base, own", "velocities, of skinning's: base, own", "its own, worst motion, of base",
    "truth against finer steps, cells", "shipped",
)


def _ship(one, place):
    if one.pays():
        put_copy(one.path, place)
    elif os.path.exists(place):
        os.remove(place)


def characters(work, out, assets, bake):
    """Writes out/README.md, errors.json, errors.png and trace.png from work/*.tissue.safetensors, and copies what pays into
    assets/gallery; what does not is removed there."""
    place_of = lambda *names: os.path.join(assets, *names)
    paths = sorted(glob.glob(os.path.join(work, f"*{TISSUE}")))
    if not paths:
        raise BadData(f"{work}: holds no *{TISSUE}; run sinew-train --keep first")
    tuned = [Tuned(path) for path in paths]
    try:
        with open(place_of("gallery", "characters.json")) as file:
            titles = {c["folder"]: c["title"] for c in json.load(file)}
        truth = _own_errors(place_of("evaluation", "truth", "some_clips.csv"))
        family = _family(place_of("evaluation", "metrics.json"))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadData(f"{assets}: {error}; give the folder with gallery and evaluation, as it is in the repository") from None
    os.makedirs(out, exist_ok=True)
    figures = {t.name: {row.motion: {n: e._asdict() for n, e in row.errors.items()} for row in [*t.rows, t.all]} for t in tuned}
    write_json(os.path.join(out, "errors.json"), figures)
    _draw_errors(tuned, titles, os.path.join(out, "errors.png"))
    most = min(tuned, key=lambda t: t.all.of_base(TUNED))
    _draw_trace(most, titles.get(most.name, most.name), work, bake, os.path.join(out, "trace.png"))
    write_text(os.path.join(out, "README.md"), _page(tuned, titles, truth, family))
    for one in tuned:
        _ship(one, place_of("gallery", one.name + TISSUE))
    return tuned


def _page(tuned, titles, truth, family):
    median = lambda name: statistics.median(t.all.of_base(name) for t in tuned)
    generic, paying = sum(may_win(t.rows, t.all, GENERIC) for t in tuned), [t for t in tuned if t.pays()]
    pay, size_kb = len(paying), max((os.path.getsize(t.path) for t in paying), default=0) / 1e3
    return f"""# Characters with networks of their own

Made by `baker/train/tune_gallery.sh`: `sinew-train` on the gallery's characters by their hand-written recipes. Each network was trained on one character; errors are mean distances of its control nodes from its own
finite-element truth, in closed loop as the runtime ticks, on motions that its training has not seen: whole clips where a character has two or more, random motion, leaps and shakes of the root.

{table(HEAD, [_cells(t, titles, truth) for t in tuned])}

Of {len(tuned)} characters {pay} have a network that leaves at most {WORTH} of the modal base's error and does no harm; they lie [in the gallery](../../gallery/README.md), up to {size_kb:.0f} kB each. The median over characters is {median(TUNED):.2f} of the base's error. The generic network, trained on other bodies, leaves
{median(GENERIC):.2f} in the median and would be kept on {generic}; a bake leaves it out where it is not 5 % better than the modes.
*Harm*: in some motion more than {1 + HARM:.2f} of the base's error; such a network is not shipped. *Truth against finer steps, cells*: [how far the truth is from itself](../truth/README.md), as a share of the displacement: of two errors that
both lie far below the latter neither is nearer to what real flesh does, but both are nearer to this flesh. Errors here are of control nodes; what they carry to the surface has [an error of its own](learnable.md#at-equal-cost), which no network
on them mends, so that the gallery, which measures the surface, shows smaller gains.

The recipe of `sinew-train` was chosen with held-out motions of mage, wolf and green man in sight: that [four fifths](learnable.md#what-limits-it) of what was learned are baked was asked for by harm seen there, though the share was chosen on others. They also decide
which networks are kept: what is said of these is a little too good, and that none does harm is so by choice.

![error on held-out motions](errors.png)

![a node of truth, base and network](trace.png)

Where the generic network is at home, [in full](../README.md):

{family}

Every motion's figures: [errors.json](errors.json). What there is to learn, and what limits it: [learnable.md](learnable.md).
"""
