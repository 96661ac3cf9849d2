"""The last stage: the candidates on the held-out motions, and the one that is baked."""
import json

from ..files.safetensors import load, save
from ..files.write_file import put_copy
from . import tissue_beside
from .motions import RATE_HZ, SECONDS
from .run import say
from .verdict import BASE, TUNED, Row, best_of, reason, table

TICKS = round(SECONDS * RATE_HZ)
KEPT = 0.8  # of what a network corrects: the rest gains 2 % where it has learned and harms where it has not (docs/decisions/larger-or-generic-network.md)


def _in_part(run, tuned):
    """A copy of the weights that corrects by KEPT of what they do. A later run goes on with the whole."""
    tensors, metadata = load(tuned)
    scale = f"{KEPT * float(metadata['output_scale']):.9g}"
    path = run.place("in_part.safetensors")
    save(path, {k: v.copy() for k, v in tensors.items()}, {**metadata, "output_scale": scale, "kept": f"{KEPT:g}"})
    return path


def _judge(run, simulation, weights):
    """(a row for each held-out motion, which nothing else reads, one of all of them); ([], None) where there are none."""
    held_out = simulation.of_split("test")
    if not held_out:
        return [], None
    packs = {BASE: run.place("base.sinew"), run.start.name: run.place("start.sinew")}
    if TUNED in weights:
        packs[TUNED] = run.place("tuned.sinew")
        run.baker.bake(packs[TUNED], weights[TUNED])
    of = lambda name, paths: Row(name, dict(zip(packs, run.baker.judge(list(packs.values()), paths, TICKS))))
    named = lambda job: f"{job.motion} #{job.seed} x{job.strength:g}"
    return [of(named(job), [path]) for job, path in held_out.items()], of("all", list(held_out.values()))


def _stated(run, weights, rows, all_of_them, name):
    """A copy of the weights that states its errors on this character in the place of another body's."""
    tensors, metadata = load(weights)
    path, error = run.place("stated.safetensors"), all_of_them.errors[name]
    own = {"error_mm": f"{error.mean_mm:.6g}", "error_ratio": f"{error.ratio:.6g}", "error_ticks": TICKS}
    four = lambda e: {k: float(f"{v:.4g}") for k, v in e._asdict().items()}
    own["held_out"] = json.dumps({r.motion: {n: four(e) for n, e in r.errors.items()} for r in [*rows, all_of_them]})
    save(path, {k: v.copy() for k, v in tensors.items()}, {**metadata, **own})
    return path


def finish(run, simulation, tuned, output, keep):
    """Bakes what has the smallest error and does no harm; the base, which needs no trust, where nothing is held out. tuned:
    path of weights, or None. keep: writes them beside the output whatever is baked."""
    tuned = _in_part(run, tuned) if tuned else None
    weights = {run.start.name: run.start.path, **({TUNED: tuned} if tuned else {})}
    rows, all_of_them = _judge(run, simulation, weights)
    winner = best_of(rows, all_of_them) if rows else BASE
    own = None if winner == BASE else _stated(run, weights[winner], rows, all_of_them, winner)
    run.baker.bake(output, own, measured=True)
    for line in table(rows, all_of_them) if rows else []:
        say(line)
    why = reason(winner, rows, all_of_them) if rows else "the modal base alone; no held-out motion was simulated"
    say(f"{output}: {why}")
    if tuned and (keep or winner == TUNED):
        beside = tissue_beside(output)
        put_copy(_stated(run, tuned, rows, all_of_them, TUNED) if rows else tuned, beside)
        say(f"{beside}: the fine-tuned weights")
