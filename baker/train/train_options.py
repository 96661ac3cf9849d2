"""The recipe of a training run."""
from dataclasses import dataclass


@dataclass
class TrainOptions:
    """Defaults are the recipe of the shipped weights."""

    channels: tuple = (8, 8, 3)
    minutes: float = 24.0  # of one core's time, or of the clock's on a GPU
    seed: int = 0
    batch: int = 4  # sequences of every body, all regions of each
    window: int = 20  # ticks of truncated back-propagation
    learning_rate: float = 5e-3
    hidden_leak: float = 0.2
    output_scale: float = 0.15  # length units a tick for a cell of 1
    state_clamp: float = 8.0
    overdrive: float = 0.15  # share of a batch driven up to three times too hard, then left in stillness
    stillness: float = 0.08  # share of a batch that is not driven at all: truth is zero
    mirror: bool = True  # half of the sequences seen mirrored left to right
    disturbance: float = 0.05  # displacement noise at some windows' start, length units
    bodies: tuple = ()  # train on these only; empty: all that have training sequences
    without: tuple = ()  # ablations: names of inputs that are fed zero; "base": no modal base
    form: str = ""  # baseline: a vanilla ConvLSTM (vanilla.py, FORMS) in the network's place. Never shipped.
    teacher_forced: bool = False  # baseline: every tick starts from the true displacement
    device: str = "cpu"
