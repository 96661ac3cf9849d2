"""Plan of a data set: which motions of which bodies, and what is held out."""
import hashlib
import json
import os
import re
import struct
from dataclasses import dataclass

from ..files.safetensors import BadData
from .bodies import is_number, known_keys, read_body, read_character, read_json
from .dataset import SPLITS

ALL_CHARACTERS = "*"  # a line for every character given on the command line
PLAN_KEYS = ("substeps", "held_out_clip", "strengths", "sequences")
DRAWN = ("random", "leap", "shake")  # from a seed
MOTIONS = (*DRAWN, "clips", "held_out")
LINE_KEYS = ("body", "split", "seconds", *MOTIONS, "first_seed", "strengths", "surface")


@dataclass(frozen=True)
class Job:
    """One simulation."""

    body: str
    split: str
    motion: str
    seed: int
    strength: float
    seconds: float
    substeps: int = 0  # 0: as many as sinew-bake truth takes for the body
    held_out: tuple = ()  # clips that random motions and leaps must not use
    surface: bool = False

    @property
    def file(self):
        return f"{self.body}/{self.split}-{_file_name(self.motion)}-{self.seed}.safetensors"


def _file_name(motion):
    """Clips of any name make files; names that had to be changed stay apart by a hash."""
    plain = motion.replace(":", "-", 1)
    safe = re.sub("[^A-Za-z0-9_. -]", "_", plain)[:80]
    return safe if safe == plain else f"{safe}-{hashlib.sha256(motion.encode()).hexdigest()[:8]}"


def _check_strengths(where, strengths):
    good = isinstance(strengths, list) and strengths and all(is_number(s, 1e-3, 10) for s in strengths)
    if not good:
        raise BadData(f"{where}: strengths must be a list of numbers above 0, at most 10")


def _whole(where, line, key, low):
    value = line.get(key, low)
    if not (is_number(value, low, 1 << 53) and value == int(value)):
        raise BadData(f"{where}: {key} must be a whole number from {low}")


def _check_line(where, line):
    known_keys(where, line, LINE_KEYS)
    if not isinstance(line.get("body"), str):
        raise BadData(f"{where}: needs a body")
    if line.get("split") not in SPLITS:
        raise BadData(f"{where}: split must be one of {', '.join(SPLITS)}")
    if not is_number(line.get("seconds"), 0.1, 3600):
        raise BadData(f"{where}: seconds must be from 0.1 to 3600")
    for key in MOTIONS:
        _whole(where, line, key, 0)
    _whole(where, line, "first_seed", 1)
    if not any(line.get(key) for key in MOTIONS):
        raise BadData(f"{where}: asks for no motion; give one of {', '.join(MOTIONS)}")
    if line.get("held_out") and line["split"] in ("train", "validation"):
        raise BadData(f"{where}: the held-out clip is for test and long only")
    if "strengths" in line:
        _check_strengths(where, line["strengths"])


def read_plan(path):
    """The plan with its sequences checked one by one; throws BadData naming the first unusable line."""
    plan = read_json(path)
    known_keys(path, plan, PLAN_KEYS)
    _whole(path, plan, "substeps", 1)
    strengths = plan.setdefault("strengths", {})
    known_keys(f"{path}: strengths", strengths, MOTIONS)
    for key in MOTIONS:
        _check_strengths(f"{path}: {key}", strengths.setdefault(key, [1.0]))
    if not isinstance(plan.setdefault("held_out_clip", ""), str):
        raise BadData(f"{path}: held_out_clip must be a clip's name")
    if not (isinstance(plan.get("sequences"), list) and plan["sequences"]):
        raise BadData(f"{path}: sequences must be a list that is not empty")
    for i, line in enumerate(plan["sequences"]):
        _check_line(f"{path}: sequences[{i}]", line)
    return plan


def read_bodies(path, plan, characters):
    """name -> Body of all bodies of the plan; body files lie beside it. Throws BadData."""
    folder = os.path.dirname(os.path.abspath(path))
    named = dict.fromkeys(line["body"] for line in plan["sequences"] if line["body"] != ALL_CHARACTERS)
    for name in [n for n in named if not os.path.exists(os.path.join(folder, f"{n}.json"))]:
        if name not in characters:
            raise BadData(f"{path}: body '{name}': no {os.path.join(folder, name + '.json')}")
    bodies = {n: read_body(os.path.join(folder, f"{n}.json")) for n in named if n not in characters}
    return {**bodies, **{n: read_character(folder, n, p) for n, p in characters.items()}}


def spread(plan, characters):
    """The plan's lines, those for all characters written out."""
    for line in plan["sequences"]:
        for body in characters if line["body"] == ALL_CHARACTERS else [line["body"]]:
            yield {**line, "body": body}


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


def _line_jobs(plan, line, clips):
    """The simulations of one line. Drawn motions take seeds from first_seed on; of a clip, seed 0
    is the clip as it is."""
    held_out = plan["held_out_clip"] if plan["held_out_clip"] in clips else ""
    unseen = (held_out,) if held_out and line["split"] in ("train", "validation") else ()
    first = line.get("first_seed", 1)
    free = [c for c in clips if c != held_out]
    motions = [(kind, kind, first + i, i) for kind in DRAWN for i in range(line.get(kind, 0))]
    motions += [("clips", f"clip:{c}", i, i) for c in free for i in range(line.get("clips", 0))]
    if line.get("held_out") and not held_out:
        raise BadData(f"body '{line['body']}' has no clip '{plan['held_out_clip']}' to hold out")
    motions += [("held_out", f"clip:{held_out}", i, i) for i in range(line.get("held_out", 0))]
    for kind, motion, seed, i in motions:
        strengths = line.get("strengths", plan["strengths"][kind])
        yield Job(
            line["body"],
            line["split"],
            motion,
            seed,
            float(strengths[i % len(strengths)]),
            float(line["seconds"]),
            plan.get("substeps", 0),
            unseen if motion in ("random", "leap") else "",
            bool(line.get("surface")),
        )


def _check_apart(path, jobs):
    """No drawn motion is in two splits, whichever body makes it; no file is made twice."""
    split_of, files = {}, set()
    for job in jobs:
        if job.file in files:
            raise BadData(f"{path}: {job.file} is asked for twice; change first_seed")
        files.add(job.file)
        if job.motion in DRAWN:
            other = split_of.setdefault((job.motion, job.seed), job.split)
            if other != job.split:
                raise BadData(
                    f"{path}: {job.motion} seed {job.seed} is in {other} and {job.split} "
                    f"({job.body}); change first_seed"
                )


def jobs_of(path, plan, clips_of):
    """All simulations in the plan's order. clips_of: body -> names of its clips. Throws BadData."""
    held_out = plan["held_out_clip"]
    if held_out and not any(held_out in clips for clips in clips_of.values()):
        raise BadData(f"{path}: held-out clip '{held_out}' is in no body")
    characters = [b for b in clips_of if b not in {line["body"] for line in plan["sequences"]}]
    jobs = []
    for line in spread(plan, characters):
        try:
            jobs += _line_jobs(plan, line, clips_of[line["body"]])
        except BadData as error:
            raise BadData(f"{path}: {error}") from None
    _check_apart(path, jobs)
    return jobs
