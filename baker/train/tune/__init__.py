"""sinew-train: fine-tunes the shipped tissue network for one character. See ../README.md."""
import os

from ..data.bodies import ROOT

SHIPPED = os.path.join(ROOT, "assets", "weights", "creature.safetensors")


def tissue_beside(output):
    """Where the fine-tuned weights are written, beside C.sinew."""
    return os.path.splitext(output)[0] + ".tissue.safetensors"
