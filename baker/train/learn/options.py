"""The recipe of a training run."""
import math
from dataclasses import dataclass

from ..files.safetensors import BadData
from ..model.inputs import ORDER


@dataclass
class TrainOptions:
    """Defaults are the recipe of the shipped weights."""

    channels: tuple = (8, 3)
    minutes: float = 27.0  # of one core's time, or of the clock's on a GPU
    updates: int = 0  # ends after so many, on whatever machine, in place of minutes; 0: by the time
    seed: int = 0
    batch: int = 4  # sequences of every body, all regions of each
    window: int = 20  # ticks of truncated back-propagation
    learning_rate: float = 5e-3
    hidden_leak: float = 0.2
    output_scale: float = 0.15  # length units a tick for a cell of 1
    state_clamp: float = 8.0
    stillness: float = 0.08  # share of a batch that is not driven at all: without it small motions get worse
    mirror: bool = True  # half of the sequences seen mirrored left to right
    bodies: tuple = ()  # train on these only; empty: all that have training sequences
    without: tuple = ()  # ablations: names of inputs that are fed zero; "base": no modal base
    form: str = ""  # baseline: a vanilla ConvLSTM (model/vanilla.py, FORMS) in the network's place. Never shipped.
    teacher_forced: bool = False  # baseline: every tick starts from the true displacement
    device: str = "cpu"

    def check(self):
        """Throws BadData naming the first option that cannot be trained with."""
        whole = lambda v: isinstance(v, int) and v >= 1
        usable = {
            "channels": ("whole numbers of which the last is 3", _are_channels(self.channels)),
            "minutes": ("above 0", 0 < self.minutes < math.inf),
            "updates": ("a whole number, 0 or more", self.updates == 0 or whole(self.updates)),
            "batch": ("a whole number from 1", whole(self.batch)),
            "window": ("a whole number from 1", whole(self.window)),
            "learning_rate": ("above 0", 0 < self.learning_rate < math.inf),
            "hidden_leak": ("from 0 to 1", 0 <= self.hidden_leak <= 1),
            "output_scale": ("above 0", 0 < self.output_scale < math.inf),
            "state_clamp": ("above 0", self.state_clamp > 0),
            "stillness": ("from 0 to 1", 0 <= self.stillness <= 1),
            "without": (f"of {', '.join((*ORDER, 'base'))}", set(self.without) <= {*ORDER, "base"}),
        }
        for name, (wanted, fine) in usable.items():
            if not fine:
                raise BadData(f"--{name.replace('_', '-')} {getattr(self, name)}: must be {wanted}")


def _are_channels(channels):
    return len(channels) > 0 and channels[-1] == 3 and all(isinstance(c, int) and c >= 1 for c in channels)
