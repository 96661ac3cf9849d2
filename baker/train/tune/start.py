"""The weights that a run begins with, checked."""
import hashlib
import os
from dataclasses import dataclass, replace

from ..files.safetensors import BadData
from ..model.weights import BASE, read_number, read_weights
from . import SHIPPED
from .motions import RATE_HZ


@dataclass
class Start:
    path: str
    model: object
    scaling: object
    metadata: dict

    @property
    def name(self):
        """As tables call it."""
        shipped = os.path.exists(SHIPPED) and os.path.samefile(self.path, SHIPPED)
        return "shipped" if shipped else os.path.splitext(os.path.basename(self.path))[0]


def read_start(path):
    """Throws BadData where the weights are none that can be tuned for a character."""
    model, scaling, metadata = read_weights(path)
    if metadata["sinew.model"] != "alt_conv_lstm" or scaling is None or metadata.get("base") != BASE:
        raise BadData(
            f"{path}: not a network of this version's inputs and modal base; give weights as "
            "assets/weights/creature.safetensors"
        )
    if read_number(path, metadata, "rate_hz", RATE_HZ) != RATE_HZ:
        raise BadData(f"{path}: is of {metadata['rate_hz']} ticks a second; give weights of {RATE_HZ}")
    kept = read_number(path, metadata, "kept", 1)
    if not 0 < kept <= 1:
        raise BadData(f"{path}: metadata kept is {kept:g}, outside 0 to 1; train or export again")
    whole = replace(model.options, output_scale=model.options.output_scale / kept)
    model.options = whole  # what is trained on is all that was learned
    return Start(path, model, scaling, metadata)


def hash_of(*paths):
    """SHA-256 of the files' contents."""
    h = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:
            h.update(file.read())
    return h.hexdigest()
