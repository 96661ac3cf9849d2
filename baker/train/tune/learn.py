"""The training stage: from the given weights, or an earlier run's, to tuned.safetensors."""
import json
import os
import time

from ..data import dataset
from ..data.trajectory import read_trajectory
from ..model.weights import save_weights
from .finetune import FineTuner, tuning_options
from .motions import SECONDS
from .progress_line import ProgressLine
from .run import say
from .start import hash_of, read_start
from .time_budget import in_words


def _groups(run, simulation, split):
    named = [("", read_trajectory(p)) for p in simulation.of_split(split).values()]
    return dataset.group(named, limits=run.limits or None)


def _begin(run, path):
    """An earlier run's weights, if it began with the given ones; else these."""
    earlier = read_start(path) if os.path.exists(path) else run.start
    if earlier.metadata.get("parent_sha256") != hash_of(run.start.path):
        return run.start
    say(f"goes on from {path}, trained for {earlier.metadata['tuned_minutes']} minutes")
    return earlier


def provenance(run, tuner, jobs, begun):
    """Metadata: where tuned weights come from. begun: the Start that they were trained from."""
    before = 0.0 if tuner.anew else float(begun.metadata.get("tuned_minutes", 0))
    minutes = before + tuner.elapsed_s / 60
    return {
        "seed": tuner.options.seed,
        "recipe": json.dumps(vars(tuner.options)),
        "parent": os.path.basename(run.start.path),
        "parent_sha256": hash_of(run.start.path),
        "tuned_for": os.path.basename(run.baker.character),
        "tuned_for_sha256": hash_of(run.baker.character),
        "tuned_minutes": f"{minutes:.2f}",
        "updates": tuner.updates,
        "data": f"{len(jobs)} motions of {SECONDS:g} s: "
        + ", ".join(f"{j.motion} seed {j.seed} strength {j.strength:g}" for j in jobs),
        "validation_of_base": f"{tuner.best:.4f}",
    }


def _can_train(run, simulation):
    """Whether there is what training needs; says so where there is not."""
    if run.stop.asked:
        return False
    if not (simulation.of_split("train") and simulation.of_split("validation")):
        say("not trained: no motion to train on, or none to choose by, could be simulated")
        return False
    if run.budget.training_end_s() <= time.monotonic():
        say("not trained: simulation took all the time; give more --minutes, its motions are kept")
        return False
    return True


def train(run, simulation, seed):
    """Path of the tuned weights, of an earlier run where this one cannot train; None where none are better
    than the given ones. They are written whenever better ones are found."""
    path = run.place("tuned.safetensors")
    begun = _begin(run, path)
    if not _can_train(run, simulation):
        return None if begun is run.start else path
    groups, validation = (_groups(run, simulation, split) for split in ("train", "validation"))
    options = tuning_options(begun.model, seed)
    tuner = FineTuner(groups, validation, (begun.model, begun.scaling), options, run.stop)
    given = run.start.name if begun is run.start else "an earlier run's"
    jobs, line, end_s = list(simulation.of_split("train")), ProgressLine(), run.budget.training_end_s()

    def report(t):
        line.update(
            lambda: f"training: {in_words(end_s - time.monotonic())} to go, error on the validation motions over the "
            f"modal base's: {given} {t.given_ratio:.3f}, fine-tuned {t.best:.3f}; all ends in "
            f"{in_words(run.budget.left_s())}"
        )

    def keep(t):
        t.model.load_state_dict(t.best_model)  # they are the current ones
        save_weights(path, t.model, t.scaling, t.rate_hz, provenance(run, t, jobs, begun))

    tuner.tune(end_s, report, keep)
    line.clear()
    say(
        f"trained for {in_words(tuner.elapsed_s)}, {tuner.updates} updates: error on the validation motions over the modal "
        f"base's {tuner.given_ratio:.3f} before, {tuner.best:.3f} now"
    )
    if tuner.anew:
        say("started again: the given weights know too little of this character")
    if tuner.hopeless:
        say("stopped early: after two fifths of the time it was hardly better than the modal base")
    return path if tuner.improved or begun is not run.start else None
