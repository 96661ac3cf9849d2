"""Trajectory files of `sinew-bake truth`, checked on reading: nothing broken reaches the trainer."""
from dataclasses import dataclass

import numpy as np

from ..files.safetensors import BadData, load

VERSION = "5"
DRIVE_WIDTH = 15
BASIS = ("rad_per_s", "damping_ratio", "shape", "turn", "force", "rest", "rest_oscillator", "first")
_STILL = 1e-9  # metres: a displacement nowhere larger than this is no motion


@dataclass
class Body:
    """What does not change in time. N nodes of R regions, region after region."""

    rest_position: np.ndarray  # (N, 3) bind position less the region's centre, in region radii
    rest_normal: np.ndarray  # (N, 3)
    stiffness: np.ndarray  # (N, 1) 0 soft .. 1 rigid
    region: np.ndarray  # (N,) ascending
    edges: np.ndarray  # (m, 2)
    radius_m: np.ndarray  # (R,)
    region_names: tuple
    bases: list  # a region: rad_per_s (K,), damping_ratio (K,), shape and turn (3n, K), force (K, 3n),
    # rest (3n, 3n), rest_oscillator and first (2,)

    def same_as(self, other):
        arrays = lambda b: (b.rest_position, b.rest_normal, b.stiffness, b.region, b.edges, b.radius_m)
        return all(np.array_equal(a, b) for a, b in zip(arrays(self), arrays(other)))


@dataclass
class Trajectory:
    """T ticks after a start at rest."""

    path: str
    body: Body
    drive: np.ndarray  # (T+1, N, 15) m/s^2, rad/s, rad/s^2, rad
    rotation: np.ndarray  # (T+1, N, 9) node frames, world from bind axes
    displacement: np.ndarray  # (T+1, N, 3) metres, along the node's own frame
    metadata: dict
    tensors: dict  # everything the file holds

    @property
    def rate_hz(self):
        return float(self.metadata["rate_hz"])

    @property
    def name(self):
        return f"{self.metadata.get('motion', '?')}#{self.metadata.get('seed', '?')}"


def _need(path, tensors, name, shape):
    """The tensor, after its shape; -1 is any size."""
    if name not in tensors:
        raise BadData(f"{path}: no tensor {name}; make the file again with this version's sinew-bake truth")
    a = tensors[name]
    if a.ndim != len(shape) or any(want not in (-1, have) for want, have in zip(shape, a.shape)):
        raise BadData(f"{path}: tensor {name} is {a.shape}, not {tuple(shape)}; make the file again")
    if a.dtype.kind == "f" and not np.isfinite(a).all():
        first = tuple(int(i) for i in np.argwhere(~np.isfinite(a))[0])
        raise BadData(
            f"{path}: tensor {name}{list(first)} is not a number; delete the file and make it again"
        )
    return a


def _checked(path, name, good, what):
    if not good:
        raise BadData(f"{path}: tensor {name}: {what}; make the file again")


def _read_bases(path, tensors, nodes_of_region):
    bases = []
    for r, nodes in enumerate(nodes_of_region):
        n, name = 3 * int(nodes), f"modes.{r}."
        w = _need(path, tensors, name + "rad_per_s", (1, -1))[0]
        _checked(path, name + "rad_per_s", len(w) and (w > 0).all(), "no modes, or not all above 0 rad/s")
        shapes = ((1, len(w)), (n, len(w)), (n, len(w)), (len(w), n), (n, n), (1, 2), (1, 2))
        values = [_need(path, tensors, name + k, shape) for k, shape in zip(BASIS[1:], shapes)]
        for k, value in (("damping_ratio", values[0]), ("rest_oscillator", values[-2]), ("first", values[-1])):
            _checked(path, name + k, (value >= 0).all(), "below 0")
        _checked(path, name + "first", values[-1][0, 0] > 0, "not above 0 rad/s")
        bases.append(dict(zip(BASIS, [w, values[0][0], *values[1:-2], values[-2][0], values[-1][0]])))
    return bases


def _read_nodes(path, tensors):
    """node.region, region.radius_m and edges, after what they say of each other."""
    region = _need(path, tensors, "node.region", (-1,))
    radius = _need(path, tensors, "region.radius_m", (-1,))
    edges = _need(path, tensors, "edges", (-1, 2))
    in_order = len(region) and region.dtype.kind == "i" and (np.diff(region) >= 0).all()
    in_order = in_order and np.array_equal(np.unique(region), np.arange(len(radius)))
    _checked(path, "node.region", in_order, f"not the numbers of {len(radius)} regions in order")
    _checked(path, "region.radius_m", (radius > 0).all(), "not above 0")
    inside = edges.dtype.kind == "i" and ((edges >= 0) & (edges < len(region))).all()
    _checked(path, "edges", inside, f"names a node beyond {len(region)}")
    return region, radius, edges


def _read_body(path, tensors, metadata):
    region, radius, edges = _read_nodes(path, tensors)
    nodes = len(region)
    return Body(
        _need(path, tensors, "node.rest_position", (nodes, 3)),
        _need(path, tensors, "node.rest_normal", (nodes, 3)),
        _need(path, tensors, "node.stiffness", (nodes, 1)),
        region,
        edges,
        radius,
        tuple(metadata.get("regions", "").split(",")),
        _read_bases(path, tensors, np.bincount(region)),
    )


def _check_metadata(path, metadata):
    version = metadata.get("sinew.trajectory")
    if version != VERSION:
        raise BadData(
            f"{path}: trajectory version {version}, this trainer reads {VERSION}; "
            "make it again with sinew-bake truth"
        )
    try:
        good = 0 < float(metadata["rate_hz"]) < float("inf")
    except (KeyError, ValueError):
        good = False
    if not good:
        raise BadData(
            f"{path}: metadata rate_hz is {metadata.get('rate_hz')}: not a number above 0; make the file again"
        )


def read_trajectory(path):
    """Throws BadData: cut short, another version, a missing or misshaped tensor, NaN, no motion."""
    tensors, metadata = load(path)
    _check_metadata(path, metadata)
    body = _read_body(path, tensors, metadata)
    nodes = len(body.region)
    drive = _need(path, tensors, "drive", (-1, nodes, DRIVE_WIDTH))
    rotation = _need(path, tensors, "rotation", (len(drive), nodes, 9))
    displacement = _need(path, tensors, "displacement", (len(drive), nodes, 3))
    if len(drive) < 2 or np.abs(displacement).max() <= _STILL or not np.abs(drive).max() > 0:
        raise BadData(f"{path}: holds no motion; make it again with another --motion or a larger --strength")
    return Trajectory(path, body, drive, rotation, displacement, metadata, tensors)
