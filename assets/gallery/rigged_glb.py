# rigged_glb.py  Bones, meshes on them and clips, written as one .glb.
import json
import struct
from dataclasses import dataclass, field

import numpy as np

RATE_HZ, MOST_INFLUENCES, LEAST_WEIGHT = 30, 4, 0.02
FLOAT, USHORT, UINT = 5126, 5123, 5125


@dataclass
class Mesh:
    """A surface; weights: vertices x bones. A surface of one bone may hang there as a node, without a skin."""
    name: str
    positions: np.ndarray
    triangles: np.ndarray
    weights: np.ndarray
    materials: list  # one a triangle
    hangs_on: str = ""


@dataclass
class Rig:
    """Bones that are not turned in the bind pose: a parent and where each begins, metres."""
    parents: dict = field(default_factory=dict)
    heads: dict = field(default_factory=dict)
    meshes: list = field(default_factory=list)
    clips: dict = field(default_factory=dict)  # name -> (seconds, pose(share of the clip) -> {bone: turn or (turn, shift)})

    def bone(self, name, parent, x, y, z):
        self.parents[name] = parent
        self.heads[name] = np.array([x, y, z], float)

    def pair(self, name, parent, x, y, z, left="_l", right="_r"):
        """A bone on either side; `name` and `parent` hold {} where the side's suffix stands."""
        for suffix, side in ((left, 1), (right, -1)):
            self.bone(name.format(suffix), parent.format(suffix), side * x, y, z)

    def names(self):
        return list(self.heads)

    def on(self, bone, count):
        weights = np.zeros((count, len(self.heads)))
        weights[:, self.names().index(bone)] = 1
        return weights


def quaternion(turn_degrees):
    """Of a rotation about x, then y, then z."""
    half = np.radians(np.asarray(turn_degrees, float)) / 2
    (cx, cy, cz), (sx, sy, sz) = np.cos(half), np.sin(half)
    return np.array([sx * cy * cz - cx * sy * sz, cx * sy * cz + sx * cy * sz,
                     cx * cy * sz - sx * sy * cz, cx * cy * cz + sx * sy * sz])


def normals_of(positions, triangles):
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    face = np.cross(b - a, c - a)
    normals = np.zeros_like(positions)
    for k in range(3):
        np.add.at(normals, triangles[:, k], face)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


class Document:
    """A glTF document and its buffer as they grow."""

    def __init__(self):
        self.buffer = bytearray()
        self.json = {"asset": {"version": "2.0", "generator": "assets/gallery/made_up.py"}, "scene": 0, "scenes": [{"nodes": []}],
                     "nodes": [], "meshes": [], "materials": [], "accessors": [], "bufferViews": []}

    def add(self, key, entry):
        self.json.setdefault(key, []).append(entry)
        return len(self.json[key]) - 1

    def accessor(self, values, kind, component, bounds=False):
        data = np.ascontiguousarray(values, {FLOAT: "<f4", USHORT: "<u2", UINT: "<u4"}[component])
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": data.nbytes})
        self.buffer += data.tobytes()
        self.buffer += bytes(-len(self.buffer) % 4)
        entry = {"bufferView": view, "componentType": component, "count": len(data), "type": kind}
        if bounds:
            rows = data.reshape(len(data), -1)
            entry |= {"min": rows.min(0).tolist(), "max": rows.max(0).tolist()}
        return self.add("accessors", entry)

    def material(self, name, colours):
        names = [m["name"] for m in self.json["materials"]]
        if name in names:
            return names.index(name)
        return self.add("materials", {"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": [*colours.get(name, (0.7, 0.7, 0.7)), 1], "metallicFactor": 0, "roughnessFactor": 0.8}})


def add_mesh(document, mesh, shift, skin, colours):
    """A primitive for each material, with vertices of its own, as exporters write them."""
    normals, primitives = normals_of(mesh.positions, mesh.triangles), []
    for material in dict.fromkeys(mesh.materials):
        triangles = mesh.triangles[[m == material for m in mesh.materials]]
        used, corners = np.unique(triangles, return_inverse=True)
        attributes = {"POSITION": document.accessor(mesh.positions[used] - shift, "VEC3", FLOAT, bounds=True),
                      "NORMAL": document.accessor(normals[used], "VEC3", FLOAT)}
        if skin is not None:
            weights = mesh.weights[used]
            joints = np.argsort(-weights, axis=1, kind="stable")[:, :MOST_INFLUENCES]
            kept = np.take_along_axis(weights, joints, axis=1)
            kept[kept < LEAST_WEIGHT] = 0
            joints[kept == 0] = 0
            attributes["JOINTS_0"] = document.accessor(joints, "VEC4", USHORT)
            attributes["WEIGHTS_0"] = document.accessor(kept / kept.sum(1, keepdims=True), "VEC4", FLOAT)
        primitives.append({"attributes": attributes, "indices": document.accessor(corners.reshape(-1), "SCALAR", UINT),
                           "material": document.material(material, colours)})
    node = {"name": mesh.name, "mesh": document.add("meshes", {"name": mesh.name, "primitives": primitives})}
    return document.add("nodes", node if skin is None else node | {"skin": skin})


def add_clip(document, rig, name, seconds, pose):
    frames = round(seconds * RATE_HZ) + 1
    times = document.accessor(np.arange(frames) / RATE_HZ, "SCALAR", FLOAT, bounds=True)
    poses = [pose(frame / (frames - 1)) for frame in range(frames)]
    animation = {"name": name, "channels": [], "samplers": []}

    def channel(bone, path, values, kind):
        animation["samplers"].append({"input": times, "output": document.accessor(values, kind, FLOAT), "interpolation": "LINEAR"})
        animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": {"node": rig.names().index(bone), "path": path}})

    for bone in poses[0]:
        turns, shifts = zip(*[(p[bone], None) if np.ndim(p[bone][0]) == 0 else p[bone] for p in poses])
        channel(bone, "rotation", np.array([quaternion(t) for t in turns]), "VEC4")
        if shifts[0] is not None:
            parent = rig.parents[bone]
            rest = rig.heads[bone] - (rig.heads[parent] if parent else 0)
            channel(bone, "translation", np.array(shifts) + rest, "VEC3")
    document.add("animations", animation)


def write_glb(rig, path, colours):
    document, names = Document(), rig.names()
    for name in names:
        parent = rig.parents[name]
        place = rig.heads[name] - (rig.heads[parent] if parent else 0)
        document.add("nodes", {"name": name, "translation": place.tolist()})
    inverse = np.tile(np.eye(4), (len(names), 1, 1))
    inverse[:, 3, :3] = -np.array([rig.heads[name] for name in names])  # columns first, as glTF has them
    skin = document.add("skins", {"joints": list(range(len(names))), "inverseBindMatrices": document.accessor(inverse.reshape(-1, 16), "MAT4", FLOAT)})
    hanging = {}
    for mesh in rig.meshes:
        shift = rig.heads[mesh.hangs_on] if mesh.hangs_on else np.zeros(3)
        node = add_mesh(document, mesh, shift, None if mesh.hangs_on else skin, colours)
        hanging.setdefault(mesh.hangs_on, []).append(node)
    for name in names:
        children = [i for i, child in enumerate(names) if rig.parents[child] == name] + hanging.get(name, [])
        if children:
            document.json["nodes"][names.index(name)]["children"] = children
    document.json["scenes"][0]["nodes"] = [i for i, name in enumerate(names) if not rig.parents[name]] + hanging.get("", [])
    for name, (seconds, pose) in rig.clips.items():
        add_clip(document, rig, name, seconds, pose)
    document.json["buffers"] = [{"byteLength": len(document.buffer)}]
    text = json.dumps(document.json, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(document.buffer), 0x004E4942) + document.buffer
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)
