"""What the trainer's tests share."""
import json
import os
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
SHARED = os.environ.get("SINEW_SHARED_DIR", "")
sys.path.insert(0, str(ROOT / "baker"))

try:
    import train  # noqa: F401  first: it chooses the linear algebra kernels before torch is loaded
    import numpy  # noqa: F401
    import torch

    MISSING = None
except ImportError as error:
    torch, MISSING = None, f"SKIPPED: {error}; install python3-torch to test the trainer"


def leave_without_torch():
    """Ends a test program plainly where PyTorch is not installed."""
    if MISSING:
        print(MISSING)
        sys.exit(0)


class Folder(unittest.TestCase):
    """A folder of its own for each test."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.temporary.cleanup()

    def place(self, name):
        return os.path.join(self.temporary.name, name)

    def write(self, name, value):
        """A text, or else as JSON; its path."""
        with open(self.place(name), "w") as file:
            file.write(value if isinstance(value, str) else json.dumps(value))
        return self.place(name)


BODY = "made_up"


def write_trajectory(path, seed=0, **how):
    """One trajectory of the synthetic body; its path."""
    import synthetic
    from train.files.safetensors import save

    save(path, *synthetic.trajectory(seed, **how))
    return path


def write_data_set(folder, train_count=6, validation=2, test=2, ticks=90, **how):
    """A data set of the synthetic body."""
    sheet, seed = [], 0
    for split, count in (("train", train_count), ("validation", validation), ("test", test)):
        for _ in range(count):
            write_trajectory(os.path.join(folder, f"{seed}.safetensors"), seed, ticks=ticks, **how)
            sheet.append({"file": f"{seed}.safetensors", "split": split, "body": BODY})
            seed += 1
    with open(os.path.join(folder, "data_sheet.json"), "w") as file:
        json.dump({"sequences": sheet}, file)


def synthetic_group(seeds=(0, 1), change=None, **how):
    """A Group of the synthetic body's trajectories. change: tensors -> tensors, before they are written."""
    import synthetic
    from train.data import dataset
    from train.data.trajectory import read_trajectory
    from train.files.safetensors import save

    with tempfile.TemporaryDirectory() as folder:
        named = []
        for seed in seeds:
            tensors, metadata = synthetic.trajectory(seed, **how)
            path = os.path.join(folder, f"{seed}.safetensors")
            save(path, change(tensors) if change else tensors, metadata)
            named.append((BODY, read_trajectory(path)))
        (group,) = dataset.group(named)
    return group


def base_states(group, model, scaling, sequences, ticks, mirror=None):
    """The modal base's state after every tick of a roll-out from rest."""
    from train.model.rollout import start, static_columns, tick

    batch = sequences.shape[-1]
    felt, drive, turn, _ = group.window(sequences, torch.zeros(batch, dtype=torch.long), ticks)
    static, state, out = static_columns(group, scaling, batch), start(model, group, batch), []
    packed = None if model is None else model.packed()
    with torch.no_grad():
        for t in range(ticks):
            now = (turn[0][t], turn[1][t])
            state = tick(model, packed, group, scaling, static, state, felt[t], drive[t], now, mirror)
            out.append(state.base)
    return out
