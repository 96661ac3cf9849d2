"""Which motions train, choose checkpoints and judge. A motion's split depends on its number alone, so that a
longer run, or one that goes on, never trains on what an earlier one held out."""
import itertools

from ..plan import Job

SECONDS = 4.0  # of every motion
RATE_HZ = 60  # of sinew-bake truth
MOST_MOTIONS = 160
ORDER = "HTVTTTHTTVTTTTHTTVTT"  # held out, training, validation: any beginning of three has one of each
SPLITS = {"T": "train", "V": "validation", "H": "test"}
FIRST_SEED = {"train": 1, "validation": 100_001, "test": 200_001}
CLIP = "clip"
KINDS = {  # of a split's motions, over and over
    "train": ("random", "leap", CLIP, "random", CLIP, "leap"),
    "validation": ("random", "leap"),
    "test": (CLIP, "random", "leap", "random"),
}
STRENGTHS = {"random": (0.8, 0.5, 1.0, 1.25), "leap": (0.8, 0.6, 1.0), CLIP: (1.0, 0.7, 1.25)}


def held_out_clip(clips):
    """The clip that neither training nor validation uses, not even inside random motions: the middle one, or
    none where there are fewer than two."""
    return clips[len(clips) // 2] if len(clips) > 1 else ""


def _split_jobs(split, body, clips):
    """A split's motions without end. A clip's seed 0 is the clip as it is; others play it from elsewhere, at
    another speed."""
    held_out = held_out_clip(clips)
    unseen = "" if split == "test" else held_out
    mine = [c for c in clips if c != held_out] if split == "train" else [held_out] if held_out else []
    kinds = [k for k in KINDS[split] if mine or k != CLIP]
    count = dict.fromkeys(KINDS[split], 0)
    for number, kind in enumerate(itertools.cycle(kinds)):
        turn, count[kind] = count[kind], count[kind] + 1
        round_, which = divmod(turn, len(mine)) if kind == CLIP else (turn, 0)
        strength = STRENGTHS[kind][round_ % len(STRENGTHS[kind])]
        motion, seed = (f"clip:{mine[which]}", round_) if kind == CLIP else (kind, FIRST_SEED[split] + number)
        avoided = "" if kind == CLIP else unseen
        yield Job(body, split, motion, seed, strength, SECONDS, held_out=avoided)


def motions_of(body, clips):
    """All motions in the order in which they are simulated."""
    of = {key: _split_jobs(split, body, clips) for key, split in SPLITS.items()}
    return [next(of[key]) for key in itertools.islice(itertools.cycle(ORDER), MOST_MOTIONS)]
