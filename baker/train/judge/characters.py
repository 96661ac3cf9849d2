"""The page of networks trained for one character: the errors that sinew-train stated in their weights, and the truth's own error."""
import csv
import glob
import json
import os
import statistics

import numpy as np

from ..data import dataset
from ..data.trajectory import read_trajectory
from ..files.safetensors import BadData, load
from ..files.write_file import put_copy, write_text
from ..tune.packs import Baker
from ..tune.verdict import BASE, HARM, TUNED, Error, Row, worst
from .page import table, write_csv
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
            stated = json.loads(self.metadata["held_out"])
            rows = [Row(m, {n: Error(**errors[n]) for n in (BASE, GENERIC, TUNED)}) for m, errors in stated.items()]
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
    """The node with the largest error of the base, in the held-out motion where the network corrects most."""
    best = max(one.rows, key=lambda row: row.errors[BASE].mean_mm - row.errors[TUNED].mean_mm)
    motion, seed = best.motion.rsplit(" x", 1)[0].rsplit(" #", 1)
    folder = max(glob.glob(os.path.join(work, f"{one.name}.train", "*", "")), key=os.path.getmtime, default="")
    files = glob.glob(os.path.join(folder, f"test-*-{seed}.safetensors"))
    true = next((t for t in map(read_trajectory, files) if t.metadata["motion"] == motion), None)
    if true is None:
        raise BadData(f"{work}: {one.name}.train holds no {best.motion}; it lies next to the weights that sinew-train wrote")
    packs, trace = [os.path.join(folder, f"{k}.sinew") for k in ("base", "tuned")], os.path.join(work, "trace.safetensors")
    if os.path.exists(trace):
        os.remove(trace)
    ticks, baker = len(true.displacement) - 1, Baker(bake, "")
    limits = [region["displacement_limit_m"] for region in baker.describe(packs[0])["regions"]]
    (held,) = dataset.group([("", true)], limits=limits)
    baker.run("judge", *packs, "--truth", true.path, "--ticks", str(ticks), "--trace", trace)
    rolled = load(trace)[0]
    lines = [held.displacement[0].numpy(), np.array(rolled["displacement.0"]), np.array(rolled["displacement.1"])]
    missed = np.linalg.norm(lines[1] - lines[0], axis=-1)
    node = missed.mean(0).argmax()
    axis = np.abs(lines[0][:, node]).mean(0).argmax()
    middle = int(np.clip(missed[:, node].argmax(), TRACED_TICKS // 2, ticks - TRACED_TICKS // 2))
    span = slice(middle - TRACED_TICKS // 2, middle + TRACED_TICKS // 2)
    figure, a = _pyplot().subplots(figsize=(8, 3))
    t_s = np.arange(ticks + 1)[span] / true.rate_hz
    for line, label, colour in zip(lines, ("truth, within the limit", "modal base", "its own network"), ("#111827", *COLOURS[0:3:2])):
        a.plot(t_s, 1e3 * line[span, node, axis], label=label, color=colour, lw=1.4)
    a.set_xlabel("time, s")
    a.set_ylabel("displacement, mm")
    a.set_title(f"{title}, {motion.removeprefix('clip:')}: the node with the largest error of the modal base", fontsize=9)
    a.legend(frameon=False, fontsize=8)
    _finish(figure, [a], path)


SUMMARY = (
    "character", "title", "kept", "motions_trained_on", "motions_held_out", "best_after_minutes", "base_mm", "generic_mm", "own_mm", "base_ratio", "generic_ratio",
    "own_ratio", "base_p95_mm", "own_p95_mm", "base_velocity_ratio", "own_velocity_ratio", "own_worst_motion", "own_worst_of_base", "truth_against_finer_steps",
    "truth_against_finer_cells", "weights_kb",
)


def _summary(one, titles, truth):
    """A row of SUMMARY. Ratios are to skinning's error."""
    base, generic, own = (one.all.errors[n] for n in (BASE, GENERIC, TUNED))
    steps, cells = truth.get(one.name, (float("nan"),) * 2)
    return [
        one.name, titles.get(one.name, one.name), "yes" if one.pays() else "no", one.motions, len(one.rows), one.minutes, base.mean_mm, generic.mean_mm, own.mean_mm,
        base.ratio, generic.ratio, own.ratio, base.p95_mm, own.p95_mm, base.velocity_ratio, own.velocity_ratio, worst(one.rows, TUNED)[0],
        round(worst(one.rows, TUNED)[1], 4), round(steps, 4), round(cells, 4), round(os.path.getsize(one.path) / 1e3, 1),
    ]


def _error_rows(tuned):
    for one in tuned:
        for row in [*one.rows, one.all]:
            for method, error in row.errors.items():
                yield [one.name, row.motion, method, *error]


def _ship(one, place):
    if one.pays():
        put_copy(one.path, place)
    elif os.path.exists(place):
        os.remove(place)


def characters(work, out, assets, bake):
    """Writes out/README.md, summary.csv, errors.csv, errors.png and trace.png from work/*.tissue.safetensors, copies weights that
    pay into assets/gallery and removes others there."""
    place_of = lambda *names: os.path.join(assets, *names)
    paths = sorted(glob.glob(os.path.join(work, f"*{TISSUE}")))
    if not paths:
        raise BadData(f"{work}: holds no *{TISSUE}; run sinew-train --keep first")
    tuned = [Tuned(path) for path in paths]
    try:
        with open(place_of("gallery", "characters.json")) as file:
            titles = {c["folder"]: c["title"] for c in json.load(file)}
        truth = _own_errors(place_of("evaluation", "truth", "some_clips.csv"))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadData(f"{assets}: {error}; give the folder with gallery and evaluation, as it is in the repository") from None
    os.makedirs(out, exist_ok=True)
    most = min(tuned, key=lambda t: t.all.of_base(TUNED))
    _draw_trace(most, titles.get(most.name, most.name), work, bake, os.path.join(out, "trace.png"))
    _draw_errors(tuned, titles, os.path.join(out, "errors.png"))
    write_csv(os.path.join(out, "errors.csv"), ("character", "motion", "method", *Error._fields), _error_rows(tuned))
    write_csv(os.path.join(out, "summary.csv"), SUMMARY, [_summary(t, titles, truth) for t in tuned])
    write_page(out)
    for one in tuned:
        _ship(one, place_of("gallery", one.name + TISSUE))
    return tuned


def write_page(out):
    """out/README.md, from summary.csv."""
    with open(os.path.join(out, "summary.csv")) as file:
        rows = list(csv.DictReader(file))
    write_text(os.path.join(out, "README.md"), _page(rows))


def _page(rows):
    of_base = lambda row, name: float(row[f"{name}_ratio"]) / float(row["base_ratio"])
    median = lambda name: statistics.median(of_base(row, name) for row in rows)
    kept = [row for row in rows if row["kept"] == "yes"]
    size_kb = max((float(row["weights_kb"]) for row in kept), default=0)
    cells = lambda row: [row["title"], *(f"{float(row[f'{n}_ratio']):.3f}" for n in ("base", "generic", "own")), row["kept"]]
    return f"""# Networks trained for one character

Mean distances of control nodes from the character's finite-element truth over held-out motions, as a fraction of skinning's error.

{table(("character", "modes", "generic network", "own network", "kept"), map(cells, rows))}

Of the modes' error the [generic network](../README.md), trained on other bodies, leaves {median("generic"):.2f} in the median, an own network {median("own"):.2f}. An own network is kept where it leaves at most {WORTH} and in no motion more than {1 + HARM:.2f}: {len(kept)} of {len(rows)}, [in the gallery](../../gallery/README.md),
up to {size_kb:.0f} kB each. Errors of the surface fall less: embedding has its own error.

![error on held-out motions](errors.png)

![displacement of one node over time](trace.png)

Training uses none of these clips, random motions, leaps and shakes. They do decide which networks are kept, and `sinew-train` was developed with those of mage, wolf and green man: the figures are slightly too good.

`baker/train/tune_gallery.sh CHARACTERS` trains and writes this folder.

Also: [each character](summary.csv), [each motion](errors.csv).
"""
