"""Which motions train, choose checkpoints and judge. A motion's split depends on its number alone, so that a
longer run, or one that goes on, never trains on what an earlier one held out."""
import itertools

from ..data.plan import Job

SECONDS = 4.0  # of every motion
RATE_HZ = 60  # of sinew-bake truth
MOST_MOTIONS = 240
SPLIT = 2  # of these rules: what an earlier version trained on may be held out in this one
ORDER = "HTVTTTHTTVTTTTHTTVTT"  # held out, training, validation: any beginning of three has one of each
SPLITS = {"T": "train", "V": "validation", "H": "test"}
FIRST_SEED = {"train": 1, "validation": 100_001, "test": 200_001}
CLIP = "clip"
_TRAIN = ("random", "leap", CLIP, "random", CLIP, "leap")
KINDS = {  # of a split's motions, over and over; a shake is of the root alone: what bends no joint must not get worse
    "train": (*_TRAIN, *_TRAIN[:4], "shake", "leap"),
    "validation": ("random", CLIP, "leap", "random", "shake", "leap"),
    "test": (CLIP, "random", "leap", "shake"),
}
FIRST_CLIP_SEED = {"train": 0, "validation": 1000, "test": 0}  # 0: the clip as it is
STRENGTHS = {"random": (0.8, 0.5, 1.0, 1.25), "leap": (0.8, 0.6, 1.0), "shake": (0.6, 0.3, 1.0), CLIP: (1.0, 0.7, 1.25)}


def held_out_clips(clips):
    """The clips that neither training nor validation uses, not even inside random motions: one of two clips or more, two
    of six, three of twelve, evenly picked."""
    count = (len(clips) >= 2) + (len(clips) >= 6) + (len(clips) >= 12)
    return tuple(clips[(2 * i + 1) * len(clips) // (2 * count)] for i in range(count))


def _split_jobs(split, body, clips):
    """A split's motions without end. A clip's seed 0 is the clip as it is; others play it from elsewhere, at
    another speed."""
    held_out = held_out_clips(clips)
    unseen = () if split == "test" else held_out
    mine = held_out if split == "test" else [c for c in clips if c not in held_out]
    kinds = [k for k in KINDS[split] if mine or k != CLIP]
    count = dict.fromkeys(KINDS[split], 0)
    for number, kind in enumerate(itertools.cycle(kinds)):
        turn, count[kind] = count[kind], count[kind] + 1
        round_, which = divmod(turn, len(mine)) if kind == CLIP else (turn, 0)
        strength = STRENGTHS[kind][round_ % len(STRENGTHS[kind])]
        clip = (f"clip:{mine[which]}", FIRST_CLIP_SEED[split] + round_) if kind == CLIP else None
        motion, seed = clip or (kind, FIRST_SEED[split] + number)
        yield Job(body, split, motion, seed, strength, SECONDS, held_out=() if clip else unseen)


def motions_of(body, clips):
    """All motions in the order in which they are simulated."""
    of = {key: _split_jobs(split, body, clips) for key, split in SPLITS.items()}
    return [next(of[key]) for key in itertools.islice(itertools.cycle(ORDER), MOST_MOTIONS)]
