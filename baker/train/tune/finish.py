"""The last stage: the candidates on the held-out motions, and the one that is baked."""

from ..safetensors import load, save
from . import tissue_beside
from .motions import RATE_HZ, SECONDS
from .run import put, say
from .verdict import BASE, TUNED, Row, best_of, pooled, reason, table

TICKS = round(SECONDS * RATE_HZ)


def _judge(run, simulation, weights):
    """Rows of the held-out motions, which nothing else reads; empty where there are none."""
    held_out = simulation.of_split("test")
    if not held_out:
        return []
    packs = {BASE: run.place("base.sinew"), run.start.name: run.place("start.sinew")}
    if TUNED in weights:
        packs[TUNED] = run.place("tuned.sinew")
        run.baker.bake(packs[TUNED], weights[TUNED])
    of = lambda path: dict(zip(packs, run.baker.judge(list(packs.values()), path, TICKS)))
    named = lambda job: f"{job.motion} #{job.seed} x{job.strength:g}"
    return [Row(named(job), of(path)) for job, path in held_out.items()]


def _stated(run, weights, error):
    """A copy of the weights that states the error on this character in the place of another body's."""
    tensors, metadata = load(weights)
    path = run.place("stated.safetensors")
    own = {"error_mm": f"{error[0]:.6g}", "error_ratio": f"{error[1]:.6g}", "error_ticks": TICKS}
    save(path, {k: v.copy() for k, v in tensors.items()}, {**metadata, **own})
    return path


def finish(run, simulation, tuned, output, keep):
    """Bakes what has the smallest error; the base, which needs no trust, where nothing is held out. tuned:
    path of weights, or None. keep: writes them beside the output whatever is baked."""
    weights = {run.start.name: run.start.path, **({TUNED: tuned} if tuned else {})}
    rows = _judge(run, simulation, weights)
    errors = pooled(rows) if rows else {}
    winner = best_of(errors) if rows else BASE
    own = None if winner == BASE else _stated(run, weights[winner], errors[winner])
    run.baker.bake(output, own, measured=True)
    for line in table(rows) if rows else []:
        say(line)
    why = reason(winner, errors) if rows else "the modal base alone; no held-out motion was simulated"
    say(f"{output}: {why}")
    if tuned and (keep or winner == TUNED):
        beside = tissue_beside(output)
        put(_stated(run, tuned, errors[TUNED]) if rows else tuned, beside)
        say(f"{beside}: the fine-tuned weights")
