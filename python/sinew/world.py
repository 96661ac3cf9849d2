"""Worlds, assets and instances as objects, arrays as numpy's."""
import os

import numpy as np

from sinew.library import LAYOUT, check, ffi, lib

SPACES = {"character": 0, "world": 1, "bind": 2}
TIERS = {"skinning": 0, "network": 2, "modal": 4}


def root(position=(0, 0, 0), rotation=(0, 0, 0, 1), scale=1):
    """World from character: metres, a quaternion x y z w, and how many of the world's metres one of the character's is."""
    return {"position_m": tuple(position), "rotation_xyzw": tuple(rotation), "scale": scale}


def _space(name):
    if name not in SPACES:
        raise ValueError(f"space is '{name}'; it is one of {', '.join(SPACES)}")
    return SPACES[name]


def _tier(name):
    if name not in TIERS:
        raise ValueError(f"tier is '{name}'; it is one of {', '.join(TIERS)}")
    return TIERS[name]


def _set(struct, values, what):
    for name, value in values.items():
        if not hasattr(struct, name):
            raise TypeError(f"{what} has no {name}")
        setattr(struct, name, value)
    return struct


def _fields(struct):
    """A struct of numbers as a dictionary; names as str."""
    out = {}
    for name, field in ffi.typeof(struct).fields:
        if name == "made_by":
            continue
        value = getattr(struct, name)
        if field.type.cname == "char *":
            value = ffi.string(value).decode() if value else None
        elif field.type.kind == "array":
            value = list(value)
        elif field.type.kind == "struct":
            value = _matrix(value) if field.type.cname == "sinew_matrix34" else _fields(value)
        out[name] = value
    return out


def _changed(struct, what, ids, values):
    """Sets fields of a struct that the library gets and sets; returns all of them as a dictionary."""
    out = ffi.new(f"sinew_{struct}*")
    check(getattr(lib, f"sinew_get_{what}")(*ids, out))
    if values:
        check(getattr(lib, f"sinew_set_{what}")(*ids, _set(out, values, f"sinew_{struct}")))
    return _fields(out[0])


def _index(entries, which, what):
    """An index, or the index of the entry with this name."""
    if not isinstance(which, str):
        return which
    names = [each["name"] for each in entries]
    if which not in names:
        raise ValueError(f"no {what} '{which}'; there are {', '.join(names) or 'none'}")
    return names.index(which)


def _matrix(struct):
    return np.array([list(row) for row in struct.m], np.float32)


def _copy(pointer, shape, dtype):
    count = int(np.prod(shape))
    if pointer == ffi.NULL or count == 0:
        return np.zeros(shape, dtype)
    return np.frombuffer(ffi.buffer(pointer, count * np.dtype(dtype).itemsize), dtype).reshape(shape).copy()


def _out(shape, ctype, dtype=np.float32):
    array = np.empty(shape, dtype)
    return array, ffi.cast(ctype, ffi.from_buffer(array))


class World:
    """sinew::World. Keywords are fields of sinew_world_def (max_instances, budget_mode ...)."""

    def __init__(self, **fields):
        definition = _set(lib.sinew_default_world_def(), fields, "sinew_world_def")
        made = ffi.new("sinew_world*")
        self._id = ffi.new("sinew_world*")[0]
        check(lib.sinew_create_world(LAYOUT, ffi.new("sinew_world_def*", definition), made))
        self._id = made[0]

    def close(self):
        """With all that is in it."""
        if self._id.index1:
            check(lib.sinew_destroy_world(self._id))
            self._id = ffi.new("sinew_world*")[0]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if lib is not None and getattr(self, "_id", None) is not None and self._id.index1:
            lib.sinew_destroy_world(self._id)

    def load(self, path):
        made = ffi.new("sinew_asset*")
        check(lib.sinew_load_asset_file(self._id, os.fsencode(path), made))
        return Asset(self, made[0])

    def add(self, asset, **fields):
        """An instance; keywords are fields of sinew_instance_def (importance, touches_own_body ...)."""
        if asset._world is not self:
            raise ValueError("the asset was loaded into another world")
        definition = _set(lib.sinew_default_instance_def(), fields, "sinew_instance_def")
        definition.asset = asset._id
        made = ffi.new("sinew_instance*")
        check(lib.sinew_create_instance(self._id, ffi.new("sinew_instance_def*", definition), made))
        return Instance(self, asset, made[0])

    def step(self, dt_s):
        """Returns the frame's report, a dictionary of sinew_frame_report's fields."""
        report = ffi.new("sinew_frame_report*")
        check(lib.sinew_step(self._id, dt_s, report))
        return _fields(report[0])

    def budget(self, microseconds):
        check(lib.sinew_set_budget_us(self._id, microseconds))

    def environment(self, **fields):
        """Sets fields of sinew_environment (gravity_m_s2, wind_m_s ...) for all instances; returns all of them."""
        return _changed("environment", "environment", (self._id,), fields)


class Asset:
    """A loaded character. `info` has sinew_asset_info's fields; arrays are copies."""

    def __init__(self, world, asset):
        self._world, self._id = world, asset
        self.info = _fields(self._ask("asset_info"))
        arrays, vertices = self._ask("asset_arrays"), self.info["vertex_count"]
        self.positions = _copy(arrays.positions_m, (vertices, 3), np.float32)
        self.normals = _copy(arrays.normals, (vertices, 3), np.float32)
        self.triangles = _copy(arrays.triangles, (self.info["triangle_count"], 3), np.uint32)
        self.moved_vertices = _copy(arrays.moved_vertices, (self.info["moved_vertex_count"],), np.uint32)
        self.joints = [_fields(self._ask("joint_info", j)) for j in range(self.info["joint_count"])]
        self.meshes = [_fields(self._ask("mesh_info", m)) for m in range(self.info["mesh_count"])]
        self.rods = [_fields(self._ask("rod_info", r)) for r in range(self.info["rod_count"])]
        self.clips = [_fields(self._ask("clip_info", c)) for c in range(self.info["clip_count"])]
        self.regions = []
        for index in range(self.info["region_count"]):
            region = self._ask("region_info", index)
            vertices = _copy(region.vertices, (region.vertex_count,), np.uint32)
            self.regions.append({**_fields(region), "vertices": vertices})

    def _ask(self, what, *index):
        out = ffi.new(f"sinew_{what}*")
        check(getattr(lib, f"sinew_get_{what}")(self._world._id, self._id, *index, out))
        return out[0]

    def joint_path(self, joint):
        length = lib.sinew_joint_path(self._world._id, self._id, joint, ffi.NULL, 0)
        text = ffi.new("char[]", length + 1)
        lib.sinew_joint_path(self._world._id, self._id, joint, text, length + 1)
        return ffi.string(text).decode()

    def bind_pose(self):
        """Character from joint, [joints, 3, 4]."""
        joints, out = _out((self.info["joint_count"], 3, 4), "sinew_matrix34*")
        check(lib.sinew_bind_pose(self._world._id, self._id, out, len(joints)))
        return joints

    def clip(self, clip, time_s, loop=True):
        """The pose of a clip, by index or name, as bind_pose gives one."""
        clip = _index(self.clips, clip, "clip")
        joints, out = _out((self.info["joint_count"], 3, 4), "sinew_matrix34*")
        check(lib.sinew_sample_clip(self._world._id, self._id, clip, time_s, int(loop), out, len(joints)))
        return joints


class Instance:
    def __init__(self, world, asset, instance):
        self._world, self.asset, self._id, self._root = world, asset, instance, None

    def pose(self, joints, root=None, teleport=False):
        """joints: character from joint, [joints, 3, 4]; root: of sinew.root, or where it was."""
        joints = np.ascontiguousarray(joints, np.float32)
        if joints.ndim != 3 or joints.shape[1:] != (3, 4):
            raise ValueError(f"joints have the shape {joints.shape}; it must be [joints, 3, 4]")
        pose = lib.sinew_default_pose()
        pose.joints = ffi.cast("sinew_matrix34*", ffi.from_buffer(joints))
        pose.joint_count, pose.teleport = len(joints), teleport
        root = root or self._root
        if root:
            pose.root = root
        check(lib.sinew_set_pose(self._world._id, self._id, ffi.new("sinew_pose*", pose)))
        self._root = root

    def _read(self, what, space):
        array, out = _out((self.asset.info["vertex_count"], 3), "float*")
        check(getattr(lib, f"sinew_read_{what}")(self._world._id, self._id, _space(space), out, len(array)))
        return array

    def positions(self, space="character"):
        """[vertices, 3], metres; of space "bind" displacements before skinning."""
        return self._read("positions", space)

    def normals(self, space="character"):
        return self._read("normals", space)

    def joints(self):
        """Character from joint as shown, bones that are rods moved: [joints, 3, 4]."""
        joints, out = _out((self.asset.info["joint_count"], 3, 4), "sinew_matrix34*")
        check(lib.sinew_read_joint_matrices(self._world._id, self._id, out, len(joints)))
        return joints

    def report(self):
        """A dictionary of sinew_instance_report's fields."""
        out = ffi.new("sinew_instance_report*")
        check(lib.sinew_get_report(self._world._id, self._id, out))
        return _fields(out[0])

    def tier_limit(self, best):
        """The best tier it may get: "network", all there is, "modal" or "skinning"."""
        check(lib.sinew_set_tier_limit(self._world._id, self._id, _tier(best)))

    def parameters(self, *, region=None, rod=None, **fields):
        """Sets fields of sinew_part_parameters (intensity, stiffness ...) of the instance, or of one region or one rod by index or name; returns all of them."""
        if region is not None and rod is not None:
            raise ValueError("region and rod are both given; name one of them")
        kind, ids = "", (self._world._id, self._id)
        if region is not None:
            kind, ids = "region_", (*ids, _index(self.asset.regions, region, "region"))
        if rod is not None:
            kind, ids = "rod_", (*ids, _index(self.asset.rods, rod, "rod"))
        return _changed("part_parameters", f"{kind}parameters", ids, fields)

    def environment(self, **fields):
        """Sets acceleration_m_s2 and wind_m_s, which this instance gets in addition to the world's; returns both."""
        return _changed("added_environment", "added_environment", (self._world._id, self._id), fields)

    def reset(self):
        check(lib.sinew_reset(self._world._id, self._id))

    def save(self):
        state = ffi.new("char[]", lib.sinew_state_bytes(self._world._id, self._id))
        check(lib.sinew_save_state(self._world._id, self._id, state, len(state)))
        return bytes(ffi.buffer(state))

    def restore(self, state):
        check(lib.sinew_restore_state(self._world._id, self._id, state, len(state)))
