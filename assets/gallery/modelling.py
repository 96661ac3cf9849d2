# modelling.py  Closed surfaces: a smooth skin about limbs, tubes along points, lathes about an axis, sheets.
from dataclasses import dataclass

import numpy as np


@dataclass
class Limb:
    """A cone with round ends, about a bone; `squash` makes its round cross-sections oval."""
    bone: str
    begin: tuple
    end: tuple
    begin_radius: float
    end_radius: float
    squash: tuple = (1, 1, 1)

    def distance(self, places):
        squash = np.array(self.squash, float)
        a, b, p = np.array(self.begin) / squash, np.array(self.end) / squash, places / squash
        along = b - a
        t = np.clip((p - a) @ along / max(along @ along, 1e-12), 0, 1)
        radius = self.begin_radius + t * (self.end_radius - self.begin_radius)
        return (np.linalg.norm(p - a - t[..., None] * along, axis=-1) - radius) * squash.min()


def surface_nets(distance, low, high, cell):
    """The closed surface where distance(places) is 0: a vertex in each cell that it crosses."""
    counts = np.ceil((np.asarray(high) - low) / cell).astype(int) + 1
    grid = np.stack(np.meshgrid(*[low[k] + cell * np.arange(counts[k]) for k in range(3)], indexing="ij"), -1)
    value = distance(grid)
    inside = value < 0
    corners = [np.array([i >> 2 & 1, i >> 1 & 1, i & 1]) for i in range(8)]

    def at(array, offset):
        return array[tuple(slice(o, o + n - 1) for o, n in zip(offset, counts))]

    total, crossings = np.zeros((*(counts - 1), 3)), np.zeros(counts - 1)
    for i, a in enumerate(corners):
        for b in corners[i + 1:]:
            if abs(a - b).sum() != 1:
                continue
            va, vb = at(value, a), at(value, b)
            crossed = at(inside, a) != at(inside, b)
            t = np.where(crossed, va / np.where(crossed, va - vb, 1), 0)[..., None]
            total += crossed[..., None] * ((1 - t) * at(grid, a) + t * at(grid, b))
            crossings += crossed
    used = crossings > 0
    number = np.full(used.shape, -1)
    number[used] = np.arange(used.sum())
    triangles = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        step = np.eye(3, dtype=int)
        first = inside[tuple(slice(0, n - (k == axis)) for k, n in enumerate(counts))]
        second = inside[tuple(slice(k == axis, None) for k in range(3))]
        for at_edge in np.argwhere(first != second):
            quad = [number[tuple(at_edge - du * step[u] - dv * step[v])] for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1))]
            if not first[tuple(at_edge)]:
                quad.reverse()
            triangles += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
    return total[used] / crossings[used][:, None], np.array(triangles)


def skin_about(limbs, bones, cell, blend, soft_weights):
    """One surface about all limbs, and the weights of its vertices: the nearest bones, blended over soft_weights metres."""
    def distance(places):
        return -blend * np.log(sum(np.exp(np.minimum(-limb.distance(places) / blend, 50)) for limb in limbs))

    reach = [np.array([p - r * np.array(limb.squash) for limb in limbs for p, r in ends(limb)]).min(0),
             np.array([p + r * np.array(limb.squash) for limb in limbs for p, r in ends(limb)]).max(0)]
    positions, triangles = surface_nets(distance, reach[0] - 3 * cell, reach[1] + 3 * cell, cell)
    near = np.full((len(positions), len(bones)), np.inf)
    for limb in limbs:
        column = bones.index(limb.bone)
        near[:, column] = np.minimum(near[:, column], limb.distance(positions))
    weights = np.exp(-(near - near.min(1, keepdims=True)) / soft_weights)
    return positions, triangles, weights / weights.sum(1, keepdims=True)


def ends(limb):
    return (np.array(limb.begin), limb.begin_radius), (np.array(limb.end), limb.end_radius)


def tube(points, radii, around=8, squash=1.0):
    """A closed tube; also the ring that each vertex is of. Sections are round, or flat along x by squash."""
    points, rings = np.asarray(points, float), []
    for i, place in enumerate(points):
        along = points[min(i + 1, len(points) - 1)] - points[max(i - 1, 0)]
        along /= np.linalg.norm(along)
        side = np.cross(along, [0, 0, 1] if abs(along[2]) < 0.9 else [0, 1, 0])
        side /= np.linalg.norm(side)
        other = np.cross(along, side)
        angle = 2 * np.pi * np.arange(around) / around
        rings.append(place + radii[i] * (np.cos(angle)[:, None] * side + squash * np.sin(angle)[:, None] * other))
    positions = np.concatenate([points[:1], *rings, points[-1:]])
    ring_of = np.concatenate([[0], np.repeat(np.arange(len(points)), around), [len(points) - 1]])
    return positions, np.array(stitched(len(points), around)), ring_of


def stitched(rings, around):
    """Triangles of rings one after the other, with a vertex before and one behind them all."""
    last, triangles = 1 + rings * around, []
    for k in range(around):
        n = (k + 1) % around
        triangles += [[0, 1 + n, 1 + k], [last, last - around + k, last - around + n]]
        for r in range(rings - 1):
            a, b = 1 + r * around, 1 + (r + 1) * around
            triangles += [[a + k, a + n, b + n], [a + k, b + n, b + k]]
    return triangles


def lathe(centre, profile, around=16, lean=(0, 0)):
    """Rings of (radius, height) about the upright axis through centre; lean shifts the uppermost one by (x, z)."""
    heights = [h for _, h in profile]
    low, high = min(heights), max(heights)
    rings = []
    for radius, height in profile:
        share = ((height - low) / (high - low)) ** 2
        angle = -2 * np.pi * np.arange(around) / around
        rings.append(np.stack([radius * np.cos(angle) + share * lean[0], np.full(around, height), radius * np.sin(angle) + share * lean[1]], -1))
    inner = [ring.mean(0, keepdims=True) for ring in (rings[0], rings[-1])]
    return np.concatenate([inner[0], *rings, inner[1]]) + centre, np.array(stitched(len(profile), around))


def sheet(front, back):
    """A closed thin sheet from two grids of places, rows x columns."""
    rows, columns, _ = front.shape
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (index[r, k].ravel() for r, k in ((slice(0, -1), slice(0, -1)), (slice(0, -1), slice(1, None)),
                                                  (slice(1, None), slice(1, None)), (slice(1, None), slice(0, -1))))
    outer = np.concatenate([np.stack([a, c, b], -1), np.stack([a, d, c], -1)])
    rim = np.concatenate([index[0, :-1], index[:-1, -1], index[-1, :0:-1], index[:0:-1, 0]])
    after, shift = np.roll(rim, -1), rows * columns
    edge = np.concatenate([np.stack([rim, after, after + shift], -1), np.stack([rim, after + shift, rim + shift], -1)])
    return np.concatenate([front.reshape(-1, 3), back.reshape(-1, 3)]), np.concatenate([outer, outer[:, ::-1] + shift, edge])


def outward(positions, triangles):
    """The same, wound so that the volume is positive: outside is where triangles face."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    return positions, triangles if np.einsum("ij,ij->", a, np.cross(b, c)) > 0 else triangles[:, ::-1]
