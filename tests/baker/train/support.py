"""What the trainer's tests share."""
import json
import os
import sys
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


def write_data_set(folder, train_count=6, validation=2, test=2, ticks=90):
    """A data set of the synthetic body."""
    import synthetic
    from train.safetensors import save

    sheet, seed = [], 0
    for split, count in (("train", train_count), ("validation", validation), ("test", test)):
        for _ in range(count):
            tensors, metadata = synthetic.trajectory(seed, ticks)
            save(os.path.join(folder, f"{seed}.safetensors"), tensors, metadata)
            sheet.append({"file": f"{seed}.safetensors", "split": split})
            seed += 1
    with open(os.path.join(folder, "data_sheet.json"), "w") as file:
        json.dump({"sequences": sheet}, file)
