"""Makes a data set: runs `sinew-bake truth` over a list of motions. Goes on where it was cut; files appear
whole or not at all."""
import concurrent.futures
import hashlib
import json
import os
import struct
import subprocess
import sys
from dataclasses import dataclass, field

from .dataset import SHEET
from .safetensors import BadData
from .trajectory import read_trajectory

STRENGTHS = (0.5, 0.8, 1.0, 1.25)
MOST_FAILURES = 0.1  # of a data set; a truth that fails more often is broken


@dataclass
class Plan:
    """How much of what. Held out of training and of choosing: one clip, and all seeds of test and long."""

    train_random: int = 56
    train_clips: int = 6  # variants of each clip that is not held out
    validation_random: int = 6
    test_random: int = 5
    test_clips: int = 3  # variants of the held-out clip
    long_sequences: int = 2  # one random, one of the held-out clip
    seconds: float = 4.5
    long_seconds: float = 60.0
    substeps: int = 4
    held_out_clip: str = ""  # empty: 'hop', or else the last clip


@dataclass
class Job:
    split: str
    motion: str
    seed: int
    strength: float
    seconds: float
    flags: list = field(default_factory=list)

    @property
    def file(self):
        return f"{self.split}-{self.motion.replace(':', '-')}-{self.seed}.safetensors"


def clip_names(path):
    """Names of a binary glTF's clips, from its JSON chunk."""
    try:
        with open(path, "rb") as file:
            magic, _, _, length, kind = struct.unpack("<5I", file.read(20))
            if magic != 0x46546C67 or kind != 0x4E4F534A:
                raise ValueError("not a binary glTF")
            return [a.get("name", "") for a in json.loads(file.read(length)).get("animations", [])]
    except (OSError, ValueError, struct.error) as error:
        raise BadData(f"{path}: {error}; give a .glb") from None


def jobs_of(plan, clips):
    """The list of simulations, the long ones first so that they do not end alone."""
    held_out = plan.held_out_clip or ("hop" if "hop" in clips else clips[-1] if clips else "")
    if held_out and held_out not in clips:
        raise BadData(
            f"held-out clip '{held_out}' is not in the character; it has {', '.join(clips) or 'no clips'}"
        )
    away = ["--hold-out", held_out] if held_out else []
    strength = lambda i: STRENGTHS[i % len(STRENGTHS)]
    spare = f"clip:{held_out}" if held_out else "shake"
    jobs = [
        Job("long", ("random", spare)[i % 2], 4000 + i, 1.0, plan.long_seconds)
        for i in range(plan.long_sequences)
    ]
    jobs += [
        Job("test", spare, i, (1.0, 0.8, 1.2)[i % 3], plan.seconds, ["--surface"])
        for i in range(plan.test_clips)
    ]
    jobs += [
        Job("test", "random", 3000 + i, strength(i), plan.seconds, ["--surface"])
        for i in range(plan.test_random)
    ]
    jobs += [
        Job("validation", "random", 2000 + i, strength(i), plan.seconds, away)
        for i in range(plan.validation_random)
    ]
    jobs += [Job("train", "random", 1 + i, strength(i), plan.seconds, away) for i in range(plan.train_random)]
    for clip in [c for c in clips if c != held_out]:
        jobs += [
            Job("train", f"clip:{clip}", i, (1.0, 0.7, 1.25)[i % 3], plan.seconds)
            for i in range(plan.train_clips)
        ]
    if not clips:
        jobs += [Job("train", "shake", 1 + i, strength(i), plan.seconds) for i in range(plan.train_clips)]
    return jobs


def _digest(*paths):
    h = hashlib.sha256()
    for path in filter(None, paths):
        with open(path, "rb") as file:
            h.update(file.read())
    return h.hexdigest()[:16]


def _is_done(path, job, plan):
    """A finished file of this very job."""
    if not os.path.exists(path):
        return False
    try:
        have = read_trajectory(path).metadata
    except BadData:
        return False
    want = {
        "motion": job.motion,
        "seed": job.seed,
        "strength": job.strength,
        "seconds": job.seconds,
        "substeps": plan.substeps,
    }
    return all(str(have.get(k)) == (f"{v:g}" if isinstance(v, float) else str(v)) for k, v in want.items())


def _simulate(bake, character, recipe, job, plan, path):
    """None, or why there is no file."""
    command = [
        bake,
        "truth",
        character,
        "--motion",
        job.motion,
        "--seed",
        str(job.seed),
        "--strength",
        f"{job.strength:g}",
        "--seconds",
        f"{job.seconds:g}",
        "--substeps",
        str(plan.substeps),
        *job.flags,
        "-o",
        path,
    ]
    done = subprocess.run(command + (["--recipe", recipe] if recipe else []), capture_output=True, text=True)
    return (
        None
        if done.returncode == 0
        else (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
    )


def _prepare(out, digest):
    """An empty folder, or one of the same character: files of another are not mixed in."""
    os.makedirs(out, exist_ok=True)
    stamp = os.path.join(out, "made_from")
    if os.path.exists(stamp) and open(stamp).read() != digest:
        raise BadData(
            f"{out}: holds sequences of another character, recipe or sinew-bake; "
            "delete it or give another folder"
        )
    with open(stamp, "w") as file:
        file.write(digest)


def _sheet(character, recipe, plan, digest, finished, failed):
    first = read_trajectory(finished[0][1])
    return {
        "character": os.path.basename(character),
        "recipe": os.path.basename(recipe) if recipe else None,
        "made_from": digest,
        "plan": vars(plan),
        "regions": list(first.body.region_names),
        "nodes": len(first.body.region),
        "counts": {
            s: sum(j.split == s for j, _ in finished) for s in ("train", "validation", "test", "long")
        },
        "seconds_simulated": sum(j.seconds for j, _ in finished),
        "failed": failed,
        "sequences": [
            {
                "file": j.file,
                "split": j.split,
                "motion": j.motion,
                "seed": j.seed,
                "strength": j.strength,
                "seconds": j.seconds,
            }
            for j, _ in finished
        ],
    }


def generate(bake, character, recipe, out, plan, processes=2, progress=sys.stderr):
    """Writes the trajectories and data_sheet.json; returns the sheet."""
    digest = _digest(character, recipe, bake)
    _prepare(out, digest)
    jobs = [(j, os.path.join(out, j.file)) for j in jobs_of(plan, clip_names(character))]
    todo = [(j, p) for j, p in jobs if not _is_done(p, j, plan)]
    failed, done = {}, 0
    with concurrent.futures.ThreadPoolExecutor(processes) as pool:
        running = {pool.submit(_simulate, bake, character, recipe, j, plan, p): (j, p) for j, p in todo}
        for future in concurrent.futures.as_completed(running):
            done += 1
            if future.result() is not None:
                failed[running[future][0].file] = future.result()
            if progress.isatty():
                print(f"\rtruth {done} of {len(todo)} sequences", end="", file=progress, flush=True)
    if progress.isatty() and todo:
        print(file=progress)
    if len(failed) > MOST_FAILURES * len(jobs):
        name, why = next(iter(failed.items()))
        raise BadData(f"{out}: {len(failed)} of {len(jobs)} simulations failed; {name}: {why}")
    sheet = _sheet(character, recipe, plan, digest, [(j, p) for j, p in jobs if j.file not in failed], failed)
    path = os.path.join(out, SHEET)
    with open(f"{path}.part", "w") as file:
        json.dump(sheet, file, indent=1)
    os.replace(f"{path}.part", path)
    return sheet
