"""The stages of sinew-train, in order."""
import os
import time

import torch

from .finish import finish
from .learn import train
from .motions import SECONDS, motions_of
from .packs import Baker
from .progress_line import ProgressLine
from .run import Run, prepare, say
from .simulate import Simulation
from .start import read_start
from .stop import Stop
from .time_budget import TimeBudget, in_words


def _tell_of(simulation):
    train_on, choose_by, held_out = (len(simulation.of_split(s)) for s in ("train", "validation", "test"))
    new = len(simulation.seconds)
    say(
        f"motions of {SECONDS:g} s: {train_on} to train on, {choose_by} to choose by, {held_out} held out "
        f"({new} simulated now, {len(simulation.done) - new} there already)"
    )
    if simulation.failed:
        job, why = next(iter(simulation.failed.items()))
        say(f"note: {len(simulation.failed)} motions cannot be used; {job.motion}: {why}")


def simulate(run, processes):
    """The motions that there is time for."""
    line, end_s = ProgressLine(), run.budget.simulation_end_s()

    def report(s):
        line.update(
            lambda: f"simulating: {len(s.done)} motions, {in_words(end_s - time.monotonic())} to go; "
            f"all ends in {in_words(run.budget.left_s())}"
        )

    jobs = motions_of(os.path.basename(run.folder), run.clips)
    simulation = Simulation(run.baker, run.cache, processes, run.stop, report).run(jobs, end_s)
    line.clear()
    run.budget.motion_s = simulation.mean_s() or run.budget.motion_s
    _tell_of(simulation)
    return simulation


def tune(a):
    """The whole of sinew-train, of its arguments. Throws BadData."""
    torch.set_num_threads(1)
    baker = Baker(a.bake, a.character, a.recipe, a.rods)
    cache = os.path.splitext(a.output)[0] + ".train"
    run = Run(baker, read_start(a.tissue), TimeBudget(a.minutes), Stop().listen(), cache)
    prepare(run)
    simulation = simulate(run, a.processes)
    tuned = train(run, simulation, a.seed)
    finish(run, simulation, tuned, a.output, a.keep)
