"""What a node is fed: names, widths and where each comes from (runtime/pack/format.hpp, InputKind)."""
from dataclasses import dataclass

# name -> columns of a trajectory's drive
DRIVE = {
    "linear_acceleration": slice(0, 3),
    "euler_acceleration": slice(3, 6),
    "centrifugal_acceleration": slice(6, 9),
    "articulation_acceleration": slice(9, 12),
    "angular_acceleration": slice(12, 15),
    "angular_velocity": slice(15, 18),
    "gravity_change": slice(18, 21),
}
STATIC = {"rest_position": 3, "rest_normal": 3, "stiffness": 1}
FEEDBACK = ("displacement", "velocity")
ORDER = tuple(STATIC) + tuple(DRIVE) + FEEDBACK
WIDTH = {**STATIC, **{name: 3 for name in DRIVE}, **{name: 3 for name in FEEDBACK}}
INPUT_WIDTH = sum(WIDTH.values())
DRIVE_START = sum(STATIC.values())  # columns of z: statics, drive, displacement and velocity
FEEDBACK_START = DRIVE_START + 3 * len(DRIVE)


@dataclass
class Scaling:
    """The network is fed value x scale; y is in length units."""

    scale: dict  # name -> number
    length_unit_m: float
    envelope: dict  # name -> largest |value x scale| let through
    displacement_limit: float  # share of a region's radius at which the runtime holds a node
