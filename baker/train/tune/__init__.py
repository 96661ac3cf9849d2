"""sinew-train: fine-tunes the shipped tissue network for one character. See ../README.md."""
import os

from ..bodies import ROOT

SHIPPED = os.path.join(ROOT, "assets", "weights", "creature.safetensors")
