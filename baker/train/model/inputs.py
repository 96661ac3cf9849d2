"""What a node is fed: names, widths and where each comes from (runtime/pack/format.hpp, InputKind)."""
from dataclasses import dataclass

# name -> columns of a trajectory's drive (runtime/tissue/frames/node_drive.hpp)
FELT = slice(0, 3)
DRIVE = {"gravity_change": slice(3, 6), "angular_velocity": slice(6, 9), "bend": slice(12, 15)}
STATIC = {"rest_position": 3, "rest_normal": 3, "stiffness": 1, "frequency": 1}
BASE = ("felt_step", "base_step", "turn")  # from the modal base (modal_base.py)
FEEDBACK = ("displacement", "velocity")
CROSSED = {  # name -> a rotation vector x what moves
    "bent_force": ("bend", "felt_step"),
    "bent_step": ("bend", "base_step"),
    "bent_displacement": ("bend", "displacement"),
    "turned_force": ("turn", "felt_step"),
    "turned_step": ("turn", "base_step"),
    "turned_velocity": ("turn", "velocity"),
    "spun_step": ("angular_velocity", "base_step"),
    "spun_velocity": ("angular_velocity", "velocity"),
}
ORDER = tuple(STATIC) + tuple(DRIVE) + BASE + FEEDBACK + tuple(CROSSED)
WIDTH = {**{name: 3 for name in ORDER}, **STATIC}
INPUT_WIDTH = sum(WIDTH.values())
AXIAL = ("angular_velocity", "turn", "bend")  # rotation vectors: a mirror flips their other two components


def crossed_with(*names):
    """The crossed inputs that hold any of these."""
    return tuple(k for k, pair in CROSSED.items() if set(pair) & set(names))


def columns(name):
    """Where an input lies in z."""
    first = sum(WIDTH[k] for k in ORDER[: ORDER.index(name)])
    return slice(first, first + WIDTH[name])


@dataclass
class Scaling:
    """The network is fed value x scale; y is in length units."""

    scale: dict  # name -> number
    length_unit: float  # in region radii
    envelope: dict  # name -> largest |value x scale| let through
    without: tuple = ()  # ablations: inputs that are fed zero; "base": no modal base. Never shipped.
