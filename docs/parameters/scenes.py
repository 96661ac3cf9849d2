"""What the pictures show: a parameter, three values of it, and a motion that makes the difference visible."""
import dataclasses
import math
from typing import Callable

import draw

GRAVITY_M_S2 = 9.80665
LIGHT_KG_M3, USUAL_KG_M3 = 100, 1000


def hop(asset, time_s):
    return asset.clip("hop", max(time_s, 0), loop=False)


def stand(asset, _):
    return asset.clip("hop", 0)


def nothing(*_):
    """Leaves the creature as it is baked."""


@dataclasses.dataclass
class View:
    part: str  # what the curves are of
    includes: Callable  # bind positions -> which vertices belong to it; None: the region of that name
    camera: draw.Camera
    axis: int = 1
    towards: str = "upward"
    tint: bool = False  # colours how far the surface is from skinning


BELLY = View("belly", None, draw.Camera((0.0, 0.40, 0.06), -58, 4, 0.92), tint=True)
EAR = View("left ear", lambda p: (p[:, 0] > 0.3) & (p[:, 1] > 0.5), draw.Camera((0, 0.55, 0), 22, 7, 1.62))
EAR_SIDEWAYS = dataclasses.replace(EAR, axis=0, towards="sideways")


@dataclasses.dataclass
class Scene:
    title: str
    note: str
    values: tuple  # low, medium, high
    label: str = "{:g}"
    view: View = None
    set: Callable = nothing  # (world, instance, value), before the creature comes to rest
    begin: Callable = nothing  # the same, at 0 s
    rods: Callable = None  # value -> keys that change in every rod of the recipe; None: the recipe as it is
    motion: Callable = hop
    seconds: float = 2.6
    shown_from: float = 0.0  # s, the earliest moment to show


def of_belly(name):
    def set_belly(world, one, value):
        for kind, parts in (("rod", one.asset.rods), ("region", one.asset.regions)):
            for part in parts:
                one.parameters(**{kind: part["name"]}, enabled=part["name"] == "belly")
        one.parameters(region="belly", **{name: value})
    return set_belly


def of_rods(name):
    def set_all(world, one, value):
        for rod in one.asset.rods:
            one.parameters(rod=rod["name"], **{name: value})
    return set_all


def light(_):
    """Fur's density at an unchanged frequency, which a recipe states at the usual density."""
    return {"density_kg_m3": LIGHT_KG_M3, "frequency_hz": 1.8 * math.sqrt(LIGHT_KG_M3 / USUAL_KG_M3)}


SCENES = {
    "soft_intensity": Scene("intensity", "of a soft part; 1: as baked", (0.5, 1, 2), view=BELLY, set=of_belly("intensity")),
    "soft_stiffness": Scene("stiffness", "of a soft part; 1: as baked", (0.25, 1, 4), view=BELLY, set=of_belly("stiffness")),
    "soft_damping": Scene("damping", "of a soft part; 1: as baked", (0.2, 1, 5), view=BELLY, set=of_belly("damping"), shown_from=1.1),
    "soft_displacement": Scene("displacement", "the limit of a soft part; 1: as baked", (0.25, 1, 4), view=BELLY, set=of_belly("displacement")),
    "rod_intensity": Scene("intensity", "of rods; 1: as baked", (0.5, 1, 2), view=EAR, set=of_rods("intensity")),
    "rod_stiffness": Scene("stiffness", "of rods; 1: as baked", (0.25, 1, 4), view=EAR, set=of_rods("stiffness")),
    "rod_damping": Scene("damping", "of rods; 1: as baked", (0.2, 1, 5), view=EAR, set=of_rods("damping"), shown_from=1.1),
    "rod_displacement": Scene("displacement", "the limit of rods; 1: as baked", (0.25, 1, 4), view=EAR, set=of_rods("displacement")),
    "rod_density": Scene("density_kg_m3", "of rods, in the recipe", (250, 1000, 4000), "{:g} kg/m³", view=EAR,
                         rods=lambda value: {"density_kg_m3": value}),
    "rod_sag": Scene("sag", "of rods, in the recipe", (0, 0.5, 1), view=EAR, rods=lambda value: {"sag": value}, shown_from=2.3),
    "gravity": Scene("gravity_m_s2", "downwards; it changes at 0 s", (0, GRAVITY_M_S2, 25), "{:.3g} m/s²", view=EAR, motion=stand,
                     begin=lambda world, one, value: world.environment(gravity_m_s2=(0, -value, 0))),
    "acceleration": Scene("acceleration_m_s2", "sideways, from 0 s on", (3, 8, 20), "{:g} m/s²", view=EAR_SIDEWAYS, motion=stand,
                          begin=lambda world, one, value: world.environment(acceleration_m_s2=(value, 0, 0))),
    "wind": Scene("wind velocity_m_s", "sideways from 0 s on, rods of 100 kg/m³", (8, 15, 25), "{:g} m/s", view=EAR_SIDEWAYS, rods=light,
                  motion=stand, begin=lambda world, one, value: world.environment(wind_m_s=(value, 0, 0))),
    "gust": Scene("wind gust", "of 15 m/s, rods of 100 kg/m³", (0, 0.3, 0.8), view=EAR_SIDEWAYS, rods=light, motion=stand, seconds=8,
                  begin=lambda world, one, value: world.environment(wind_m_s=(15, 0, 0), gust=value)),
}
