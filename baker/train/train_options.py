"""The recipe of a training run."""
from dataclasses import dataclass


@dataclass
class TrainOptions:
    """Defaults are the recipe of the shipped weights."""

    channels: tuple = (32, 32, 3)
    minutes: float = 20.0  # of one core's time, or of the clock's on a GPU
    seed: int = 0
    batch: int = 8  # sequences, all regions of each
    window: int = 20  # ticks of truncated back-propagation
    learning_rate: float = 1e-2
    output_leak: float = 0.02
    hidden_leak: float = 0.2
    output_scale: float = 0.0  # 0: by the speed of the liveliest region, so that cells stay near 1
    state_clamp: float = 8.0
    noise: float = 0.1  # displacement noise at a window's start, share of the region's root mean square
    overdrive: float = 0.15  # share of a batch driven up to three times too hard, then left in stillness
    stillness: float = 0.08  # share of a batch that is not driven at all: truth is zero
    mirror: bool = True  # half of the sequences mirrored left to right
    device: str = "cpu"
