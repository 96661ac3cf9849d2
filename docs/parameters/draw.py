"""Draws a character's surface with numpy alone: a depth buffer, sun with shadows, sky, vertex colours."""
import copy
import json
from pathlib import Path

import numpy as np

SUPERSAMPLES = 3
SHADOW_PIXELS = 700
SUN = np.array([0.42, 0.75, 0.51])  # towards it, before it turns with the camera
SUN_COLOUR, SKY, GROUND = np.array([2.1, 2.0, 1.85]), np.array([0.62, 0.68, 0.78]), np.array([0.42, 0.38, 0.36])
BACKDROP = np.array([0.69, 0.73, 0.78])  # linear
SHINY = {"eye": 0.9, "nose": 0.35, "lip": 0.1}  # strength of the highlight by material
GLOW = {"glint": 0.8}


def unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


class Paint:
    """Vertex colours of a .glb, linear, and how its materials shine."""

    def __init__(self, path):
        data = Path(path).read_bytes()
        length = int.from_bytes(data[12:16], "little")
        document, binary = json.loads(data[20:20 + length]), data[28 + length:]
        colours, shines, glows = [], [], []
        for primitive in (p for mesh in document["meshes"] for p in mesh["primitives"]):
            accessor = document["accessors"][primitive["attributes"]["COLOR_0"]]
            view = document["bufferViews"][accessor["bufferView"]]
            start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            values = np.frombuffer(binary, "<u2", 4 * accessor["count"], start).reshape(-1, 4)[:, :3]
            name = document["materials"][primitive["material"]]["name"]
            colours.append(values / 65535)
            shines.append(np.full(len(values), SHINY.get(name, 0.0)))
            glows.append(np.full(len(values), GLOW.get(name, 0.0)))
        self.colours, self.shines, self.glows = np.concatenate(colours), np.concatenate(shines), np.concatenate(glows)

    def tinted(self, colours, weights):
        """With sRGB colours mixed in."""
        out = copy.copy(self)
        out.colours = self.colours + weights[:, None] * (np.asarray(colours) ** 2.2 - self.colours)
        return out


class Camera:
    """Looks at `target`, from `distance` away; `view_m` is the height that fits the picture at the target."""

    def __init__(self, target, yaw_deg, pitch_deg, view_m, distance_m=4.0):
        yaw, pitch = np.radians([yaw_deg, pitch_deg])
        back = np.array([np.sin(yaw) * np.cos(pitch), np.sin(pitch), np.cos(yaw) * np.cos(pitch)])
        right = unit(np.cross([0, 1, 0], back))
        self.axes = np.stack([right, np.cross(back, right), back])
        self.eye = np.asarray(target) + distance_m * back
        self.view_m, self.distance_m, self.yaw = view_m, distance_m, yaw

    def project(self, points, width, height):
        """Pixels and depths."""
        seen = (points - self.eye) @ self.axes.T
        scale = height * self.distance_m / self.view_m / -seen[:, 2]
        return np.stack([width / 2 + seen[:, 0] * scale, height / 2 - seen[:, 1] * scale], 1), -seen[:, 2]

    def rays(self, width, height):
        x, y = np.meshgrid(np.arange(width) + 0.5 - width / 2, height / 2 - np.arange(height) - 0.5)
        unit_m = self.view_m / self.distance_m / height
        return unit(np.stack([x * unit_m, y * unit_m, -np.ones_like(x)], -1) @ self.axes)


def rasterise(pixels, depths, triangles, width, height):
    """The triangle of each pixel, -1 where there is none, and its barycentric coordinates."""
    corners = pixels[triangles]
    edges = corners[:, 1:] - corners[:, :1]
    area = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    low = np.clip(np.floor(corners.min(1)), 0, [width, height]).astype(int)
    high = np.clip(np.ceil(corners.max(1)), 0, [width, height]).astype(int)
    sizes = np.maximum(high - low, 0)
    front = np.flatnonzero((area < 0) & (sizes.prod(1) > 0))  # y points down
    counts = sizes[front].prod(1)
    which = np.repeat(front, counts)
    local = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    x, y = low[which, 0] + local % sizes[which, 0], low[which, 1] + local // sizes[which, 0]
    at = np.stack([x, y], 1) + 0.5 - corners[which, 0]
    a, b = edges[which, 0], edges[which, 1]
    v = (at[:, 0] * b[:, 1] - at[:, 1] * b[:, 0]) / area[which]
    w = (a[:, 0] * at[:, 1] - a[:, 1] * at[:, 0]) / area[which]
    bary = np.stack([1 - v - w, v, w], 1)
    inside = np.flatnonzero((bary >= 0).all(1))
    which, bary, flat = which[inside], bary[inside], (y * width + x)[inside]
    depth = (bary * depths[triangles[which]]).sum(1)
    order = np.argsort(-depth, kind="stable")
    triangle, coordinates, nearest = np.full(width * height, -1), np.zeros((width * height, 3)), np.full(width * height, np.inf)
    flat, order = flat[order], order
    triangle[flat], coordinates[flat], nearest[flat] = which[order], bary[order], depth[order]
    return triangle.reshape(height, width), coordinates.reshape(height, width, 3), nearest.reshape(height, width)


class Sun:
    """Which points it lights, with soft edges of the shadows."""

    def __init__(self, direction, positions, triangles):
        self.direction = direction
        right = unit(np.cross([0, 1, 0], direction))
        self.axes = np.stack([right, np.cross(direction, right)])
        seen = positions @ self.axes.T
        self.low, self.span = seen.min(0) - 0.05, (seen.max(0) - seen.min(0)).max() + 0.1
        pixels = (seen - self.low) / self.span * SHADOW_PIXELS
        pixels[:, 1] = SHADOW_PIXELS - pixels[:, 1]
        _, _, self.nearest = rasterise(pixels, -(positions @ direction), triangles, SHADOW_PIXELS, SHADOW_PIXELS)

    def lights(self, points, bias_m, radius=4):
        """0..1 of each point."""
        at = (points @ self.axes.T - self.low) / self.span * SHADOW_PIXELS
        x, y, depth = at[:, 0], SHADOW_PIXELS - at[:, 1], -(points @ self.direction)
        total = np.zeros(len(points))
        offsets = [(i, j) for i in (-1, -0.33, 0.33, 1) for j in (-1, -0.33, 0.33, 1)]
        for i, j in offsets:
            column, row = (x + radius * i).astype(int), (y + radius * j).astype(int)
            outside = (column < 0) | (row < 0) | (column >= SHADOW_PIXELS) | (row >= SHADOW_PIXELS)
            blocker = self.nearest[row.clip(0, SHADOW_PIXELS - 1), column.clip(0, SHADOW_PIXELS - 1)]
            total += outside | (blocker > depth - bias_m)
        return total / len(offsets)


def shrunk(image):
    height, width = np.array(image.shape[:2]) // SUPERSAMPLES
    return image.reshape(height, SUPERSAMPLES, width, SUPERSAMPLES, *image.shape[2:]).mean((1, 3))


def to_srgb(linear):
    linear = np.clip(linear, 0, None)
    linear = linear * (1 + linear / 6) / (1 + linear)  # bright colours approach white
    linear = np.clip(1.22 * linear, 0, 1)
    return np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def picture(positions, normals, triangles, paint, camera, width, height):
    """An image [height, width, 3], 0..1, of sRGB values."""
    w, h = width * SUPERSAMPLES, height * SUPERSAMPLES
    pixels, depths = camera.project(positions, w, h)
    triangle, bary, _ = rasterise(pixels, depths, triangles, w, h)
    turn = np.array([[np.cos(camera.yaw), 0, np.sin(camera.yaw)], [0, 1, 0], [-np.sin(camera.yaw), 0, np.cos(camera.yaw)]])
    sun = Sun(unit(turn @ SUN), positions, triangles)
    rays = camera.rays(w, h)

    image = np.empty((h, w, 3))
    ground = rays[..., 1] < -1e-3
    reach = np.where(ground, -camera.eye[1] / np.where(ground, rays[..., 1], -1), 0)
    hits = (camera.eye + rays * reach[..., None]).reshape(-1, 3)
    lit = sun.lights(hits, 0.0, radius=9).reshape(h, w)
    image[:] = BACKDROP * (1 + 0.35 * rays[..., 1:2])
    near = ground & (reach < 3 * camera.distance_m)
    image[near] *= 1 - 0.42 * (1 - lit[near])[:, None]

    covered = triangle >= 0
    corners, weights = triangles[triangle[covered]], bary[covered][..., None]
    of = lambda values: (values[corners] * weights).sum(1)  # noqa: E731
    normal, colour, point = unit(of(normals)), of(paint.colours), of(positions)
    shine, glow, view = of(paint.shines[:, None]), of(paint.glows[:, None]), -rays[covered]
    facing = normal @ sun.direction
    direct = (np.clip(facing, 0, 1) * sun.lights(point + 0.006 * normal, 0.004))[:, None]
    up = (0.5 + 0.5 * normal[:, 1:2])
    light = SUN_COLOUR * direct + SKY * up + GROUND * (1 - up)
    rim = (1 - np.clip((normal * view).sum(1, keepdims=True), 0, 1)) ** 3
    halfway = unit(sun.direction + view)
    highlight = shine * np.clip((normal * halfway).sum(1, keepdims=True), 0, 1) ** 60
    image[covered] = colour * light * 0.72 + 0.12 * rim * SKY + highlight + glow
    return shrunk(to_srgb(image))


def covered(positions, triangles, camera, width, height):
    """The fraction of each pixel that a surface covers."""
    w, h = width * SUPERSAMPLES, height * SUPERSAMPLES
    return shrunk((rasterise(*camera.project(positions, w, h), triangles, w, h)[0] >= 0).astype(float))
