"""What all stages of a run share, and its first stage: the character with its modal base."""
import os
import tempfile
import time
from dataclasses import dataclass, field

from ..data.trajectory import VERSION
from ..files.safetensors import BadData
from ..files.write_file import put_copy
from .motions import SPLIT
from .packs import Baker
from .progress_line import ProgressLine
from .start import Start, hash_of
from .stop import Stop
from .time_budget import TimeBudget


def say(text):
    print(text, flush=True)


@dataclass
class Run:
    baker: Baker
    start: Start
    budget: TimeBudget
    stop: Stop
    cache: str  # C.train
    folder: str = ""  # in it, of this character as it is now: packs, motions, weights
    clips: list = field(default_factory=list)
    limits: list = field(default_factory=list)  # metres, of each region, as baked

    def place(self, name):
        return os.path.join(self.folder, name)


def _folder_name(run, base):
    """The base's pack holds mesh, clips, regions and modes: whatever the truth depends on changes it."""
    recipe = [run.baker.recipe] if run.baker.recipe else []
    return f"{hash_of(base, *recipe)[:12]}-{VERSION}.{SPLIT}"


def _check_soft(run, regions):
    if not regions:
        raise BadData(
            f"{run.baker.character}: has no soft parts, so there is nothing to train; name some under "
            '"regions" in a recipe (--recipe), or bake it with sinew-bake character'
        )


def _tell_of_others(run):
    """Of motions in the cache that are of no use now."""
    others = [f for f in os.scandir(run.cache) if f.is_dir() and f.path != run.folder]
    size = sum(file.stat().st_size for folder in others for file in os.scandir(folder))
    if others:
        say(f"note: {run.cache}: {size >> 20} MB are of other recipes or files; delete what is not wanted")


def prepare(run):
    """Bakes the character with its modes alone and with the given weights. Throws BadData, with nothing
    written: a character that cannot be baked, or has nothing soft."""
    line = ProgressLine()
    line.update("baking the character with its modes")
    with tempfile.TemporaryDirectory() as folder:
        base, began_s = os.path.join(folder, "base.sinew"), time.monotonic()
        notes = run.baker.bake(base)
        run.budget.bake_s = time.monotonic() - began_s
        described = run.baker.describe(base)
        _check_soft(run, described.get("regions"))
        shipped = os.path.join(folder, "start.sinew")
        run.baker.bake(shipped, run.start.path)
        run.folder = os.path.join(run.cache, _folder_name(run, base))
        os.makedirs(run.folder, exist_ok=True)
        put_copy(base, run.place("base.sinew"))
        put_copy(shipped, run.place("start.sinew"))
    line.clear()
    run.clips = [clip["name"] for clip in described["clips"]]
    run.limits = [region["displacement_limit_m"] for region in described["regions"]]
    for note in notes:
        say(note)
    _tell_of_others(run)
    regions = ", ".join(f"{r['name']} ({r['first_hz']:.1f} Hz)" for r in described["regions"])
    say(f"soft parts: {regions}; clips: {', '.join(run.clips) or 'none'}")
