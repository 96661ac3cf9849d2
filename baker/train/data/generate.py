"""Makes a data set: runs `sinew-bake truth` over a plan of bodies and motions. Goes on where it was cut;
files appear whole or not at all.

    DATA/<body>/{body.glb,creature.json,tissue.json,made_from,<split>-<motion>-<seed>.safetensors}
    DATA/data_sheet.json
"""
import concurrent.futures
import os
import subprocess
import sys

from ..files.safetensors import BadData
from ..files.write_file import put_copy, write_json, write_text
from .data_sheet import statistics
from .dataset import SHEET, SPLITS
from .plan import clip_names, jobs_of, read_bodies, read_plan
from .trajectory import read_trajectory

MOST_FAILURES = 0.1  # of a data set; a truth that fails more often is broken
STAMP = "made_from"


def _run(command):
    """None, or the last line of what went wrong."""
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise BadData(f"{command[0]}: {error.strerror}; give the path of sinew-bake") from None
    if done.returncode:
        return (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
    return None


def _check_folder(folder, body):
    """Sequences of another body are not mixed in."""
    stamp = os.path.join(folder, STAMP)
    if os.path.exists(stamp):
        with open(stamp) as file:
            same = file.read() == body.stamp()
    else:
        same = not os.path.isdir(folder) or not any(f.endswith(".safetensors") for f in os.listdir(folder))
    if not same:
        raise BadData(
            f"{folder}: holds sequences of another recipe of {body.name}; delete it or give another folder"
        )


def _prepare(bake, folder, body):
    """The body's folder with everything a simulation needs."""
    glb, recipe = os.path.join(folder, "body.glb"), os.path.join(folder, "creature.json")
    if os.path.exists(os.path.join(folder, STAMP)) and os.path.exists(glb):
        return
    os.makedirs(folder, exist_ok=True)
    write_json(os.path.join(folder, "tissue.json"), body.tissue)
    if body.creature:
        write_json(recipe, body.creature)
        why = _run([bake, "creature", recipe, "-o", glb])
        if why:
            raise BadData(f"body '{body.name}' cannot be made: {why}")
    else:
        put_copy(body.character, glb)
    write_text(os.path.join(folder, STAMP), body.stamp())


def is_done(path, job):
    """A finished file of this very job and of this version of trajectories."""
    if not os.path.exists(path):
        return False
    try:
        have = read_trajectory(path)
    except BadData:
        return False
    numbers = {"seed": job.seed, "strength": job.strength, "seconds": job.seconds}
    if job.substeps:
        numbers["substeps"] = job.substeps
    texts = {"motion": job.motion, "held_out": ",".join(job.held_out)}
    return (
        all(have.metadata.get(k) == f"{v:g}" for k, v in numbers.items())
        and all(have.metadata.get(k, "") == v for k, v in texts.items())
        and (not job.surface or "surface" in have.tensors)
    )


def truth_command(bake, character, recipe, job, out):
    """The command that simulates a job. recipe: a path, or None."""
    command = [bake, "truth", character, "-o", out]
    options = {
        "motion": job.motion,
        "seed": job.seed,
        "strength": f"{job.strength:g}",
        "seconds": f"{job.seconds:g}",
        **({"substeps": job.substeps} if job.substeps else {}),
        **({"recipe": recipe} if recipe else {}),
    }
    command += [text for key, value in options.items() for text in (f"--{key}", str(value))]
    command += [text for clip in job.held_out for text in ("--hold-out", clip)]
    return command + (["--surface"] if job.surface else [])


def what_is_wrong(path):
    """None, or why a trajectory cannot be used."""
    try:
        read_trajectory(path)
    except BadData as error:
        return str(error)
    return None


def _simulate(bake, out, job):
    """None, or why there is no file."""
    folder, path = os.path.join(out, job.body), os.path.join(out, job.file)
    body, recipe = (os.path.join(folder, name) for name in ("body.glb", "tissue.json"))
    return _run(truth_command(bake, body, recipe, job, path)) or what_is_wrong(path)


class _Progress:
    """One line on a terminal: sequences and simulated seconds done."""

    def __init__(self, todo, stream):
        self.todo, self.stream, self.done = todo, stream, []

    def update(self, job):
        self.done.append(job)
        if self.stream.isatty():
            seconds = [sum(j.seconds for j in jobs) for jobs in (self.done, self.todo)]
            print(
                f"\rtruth {len(self.done)} of {len(self.todo)} sequences, "
                f"{seconds[0]:.0f} of {seconds[1]:.0f} s",
                end="\n" if len(self.done) == len(self.todo) else "",
                file=self.stream,
                flush=True,
            )


def _sheet(plan, bodies, finished, failed, left):
    return {
        "plan": plan,
        "made_from": {name: body.stamp() for name, body in bodies.items()},
        "counts": {s: sum(j.split == s for j in finished) for s in SPLITS},
        "seconds_simulated": sum(j.seconds for j in finished),
        "left": left,
        "failed": failed,
        "sequences": [
            {
                "file": j.file,
                "body": j.body,
                "split": j.split,
                "motion": j.motion,
                "seed": j.seed,
                "strength": j.strength,
                "seconds": j.seconds,
            }
            for j in finished
        ],
    }


def _check_failures(out, failed, jobs):
    if len(failed) > MOST_FAILURES * len(jobs):
        name, why = next(iter(failed.items()))
        raise BadData(f"{out}: {len(failed)} of {len(jobs)} simulations failed; {name}: {why}")


def _run_all(bake, out, todo, processes, report):
    """Calls report(job, why it failed or None) as simulations end; what waits is dropped on an interrupt."""
    pool = concurrent.futures.ThreadPoolExecutor(processes)
    try:
        running = {pool.submit(_simulate, bake, out, job): job for job in todo}
        for future in concurrent.futures.as_completed(running):
            report(running[future], future.result())
    finally:
        pool.shutdown(cancel_futures=True)


def generate(bake, plan_path, out, characters=None, processes=2, progress=sys.stderr, splits=SPLITS):
    """Writes the bodies, their trajectories and data_sheet.json; returns the sheet. characters: name -> path
    of those the plan leaves open. splits: those to simulate now; what is there of others stays in the sheet.
    The sheet is there, without figures, as soon as all sequences of a body's split are: training can begin
    while the long ones run. Throws BadData: before simulating where plan or bodies are unusable, during it
    where too many simulations failed."""
    plan = read_plan(plan_path)
    bodies = read_bodies(plan_path, plan, characters or {})
    clips = {
        n: [c["name"] for c in b.creature.get("clips", [])] if b.creature else clip_names(b.character)
        for n, b in bodies.items()
    }
    jobs = jobs_of(plan_path, plan, clips)
    for body in bodies.values():
        _check_folder(os.path.join(out, body.name), body)
    for body in bodies.values():
        _prepare(bake, os.path.join(out, body.name), body)

    finished = {j for j in jobs if is_done(os.path.join(out, j.file), j)}
    todo, failed = [j for j in jobs if j not in finished and j.split in splits], {}
    waiting, bar = set(todo), _Progress(todo, progress)

    def write_sheet(figures):
        ordered = [j for j in jobs if j in finished]
        sheet = {**_sheet(plan, bodies, ordered, failed, len(waiting)), **figures}
        write_json(os.path.join(out, SHEET), sheet)
        return sheet

    def report(job, why):
        waiting.discard(job)
        bar.update(job)
        failed.update({job.file: why} if why else {})
        _check_failures(out, failed, jobs)
        finished.update([] if why else [job])
        if not any((j.body, j.split) == (job.body, job.split) for j in waiting):
            write_sheet({})

    _run_all(bake, out, todo, processes, report)
    return write_sheet({"bodies": statistics(out, [j for j in jobs if j in finished])})
