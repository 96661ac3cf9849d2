"""Bodies of a data set: a creature recipe with a few changes, or a character file of its own."""
import copy
import hashlib
import json
import os
import re
from dataclasses import dataclass, field

import numpy as np

from ..files.safetensors import BadData

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
KEYS = ("creature", "vertices", "proportions", "radii", "tissue_recipe", "tissue")
SMALLEST, LARGEST = 0.1, 10.0  # factor of a proportion or radius
FEWEST_VERTICES, MOST_VERTICES = 200, 50000  # of sinew-bake creature
TISSUE_KEYS = (  # of a tissue recipe, see baker/mesh/recipe/recipe.hpp
    "young_soft_pa",
    "young_stiff_pa",
    "poisson_ratio",
    "density_kg_m3",
    "damping_ratio",
    "voxels_high",
    "rigid_stiffness",
    "core_share",
    "coreless_joints",
    "nodes_per_region",
    "neighbours",
    "unit_m",
    "up",
    "regions",
)
_USUAL_NODES = 80  # a region, of a recipe that states none
_MOVES = {"move_x": 0, "move_y": 1, "move_z": 2}


@dataclass
class Body:
    """What is simulated. A creature is built from its recipe; a character's file is used as it is."""

    name: str
    creature: dict = None  # the recipe with its changes; None: `character` is the file
    character: str = None
    tissue: dict = field(default_factory=dict)

    def stamp(self):
        """Names the content that the trajectories depend on, without the program that makes them."""
        tissue = {"nodes_per_region": _USUAL_NODES, **self.tissue}
        h = hashlib.sha256(json.dumps([self.creature, tissue], sort_keys=True).encode())
        if self.character:
            with open(self.character, "rb") as file:
                h.update(file.read())
        return h.hexdigest()[:16]


def read_json(path):
    """The object in a JSON file; throws BadData: not there, not JSON, not an object."""
    try:
        with open(path) as file:
            value = json.load(file)
    except OSError as error:
        raise BadData(f"{path}: {error.strerror}") from None
    except ValueError as error:
        raise BadData(f"{path}: not JSON ({error})") from None
    if not isinstance(value, dict):
        raise BadData(f"{path}: must hold an object {{...}}")
    return value


def is_number(value, low, high):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and low <= value <= high


def known_keys(where, value, keys):
    """Throws BadData unless `value` is an object with these keys only."""
    if not isinstance(value, dict):
        raise BadData(f"{where}: must be an object {{...}}")
    for key in value:
        if key not in keys:
            raise BadData(f"{where}: unknown key '{key}'; it may hold {', '.join(keys)}")


def checked_name(where, name):
    """A body's name is a folder's too. Throws BadData."""
    if not re.fullmatch("[A-Za-z0-9_-]+", name):
        raise BadData(f"{where}: '{name}' is no name of a body; use letters, digits, _ and -")
    return name


def _turned_scale(proportions, turn_deg):
    """Factor of each radius of an ellipsoid turned about Z, then X, then Y: how long its axis becomes."""
    x, y, z = np.radians(turn_deg)
    about = lambda c, s, i, j: np.array(
        [[c if a == b and a in (i, j) else float(a == b) for b in range(3)] for a in range(3)]
    ) + s * (np.outer(np.eye(3)[j], np.eye(3)[i]) - np.outer(np.eye(3)[i], np.eye(3)[j]))
    turn = (
        about(np.cos(y), np.sin(y), 2, 0)
        @ about(np.cos(x), np.sin(x), 1, 2)
        @ about(np.cos(z), np.sin(z), 0, 1)
    )
    return np.linalg.norm(np.asarray(proportions)[:, None] * turn, axis=0)


def _scaled(values, factors):
    return [round(float(v) * float(f), 9) for v, f in zip(values, factors)]


def _stretch_item(item, proportions):
    """A joint, body part, detail or brush; lengths without a direction take the mean factor."""
    mean = float(np.prod(proportions)) ** (1 / 3)
    for key in ("at", "tip"):
        if key in item:
            item[key] = _scaled(item[key], proportions)
    if "radii" in item:
        item["radii"] = _scaled(item["radii"], _turned_scale(proportions, item.get("turn_deg", (0, 0, 0))))
    if "tube" in item:
        item["tube"] = [_scaled(row, (*proportions, mean)) for row in item["tube"]]
    for key in ("blend_m", "fade_m", "overlap_m", "smooth_m", "size_m"):
        if key in item:
            item[key] = round(item[key] * mean, 9)


def _stretch_track(track, proportions):
    if track["axis"] not in _MOVES:
        return
    factor = proportions[_MOVES[track["axis"]]]
    if "keys" in track:
        track["keys"] = [_scaled(row, (1, factor)) for row in track["keys"]]
    if "wave" in track:
        track["wave"] = _scaled(track["wave"], (factor, 1, 1))


def stretch(recipe, proportions):
    """The creature with every coordinate, length and movement scaled by [x, y, z]."""
    for group in ("joints", "body", "details", "coat", "tissue"):
        for item in recipe.get(group, []):
            _stretch_item(item, proportions)
    for group in ("noise", "skin"):
        _stretch_item(recipe.get(group, {}), proportions)
    for track in recipe.get("stance", []) + [t for c in recipe.get("clips", []) for t in c["tracks"]]:
        _stretch_track(track, proportions)
    return recipe


def thicken(recipe, radii):
    """The creature with the radii of the body parts of these names multiplied."""
    for part in recipe["body"]:
        factor = radii.get(part.get("name"), 1)
        if "radii" in part:
            part["radii"] = _scaled(part["radii"], (factor,) * 3)
        if "tube" in part:
            part["tube"] = [_scaled(row, (1, 1, 1, factor)) for row in part["tube"]]
    return recipe


def _checked(path, body):
    known_keys(path, body, KEYS)
    factor = lambda v: is_number(v, SMALLEST, LARGEST)
    proportions, radii = body.get("proportions", [1, 1, 1]), body.get("radii", {})
    if not (isinstance(proportions, list) and len(proportions) == 3 and all(map(factor, proportions))):
        raise BadData(f"{path}: proportions must be three factors from {SMALLEST:g} to {LARGEST:g}")
    if not (isinstance(radii, dict) and all(map(factor, radii.values()))):
        raise BadData(f"{path}: radii must be factors from {SMALLEST:g} to {LARGEST:g}, by names of parts")
    if not is_number(body.get("vertices", FEWEST_VERTICES), FEWEST_VERTICES, MOST_VERTICES):
        raise BadData(f"{path}: vertices must be a number from {FEWEST_VERTICES} to {MOST_VERTICES}")
    for key in ("creature", "tissue_recipe"):
        if not isinstance(body.get(key, ""), str):
            raise BadData(f"{path}: {key} must be a path from the repository's root")
    if "creature" not in body and set(body) & {"vertices", "proportions", "radii"}:
        raise BadData(f"{path}: only a creature can be changed; name its recipe as \"creature\"")
    return body, proportions, radii


def _creature(path, name, body, proportions, radii):
    file = os.path.join(ROOT, body["creature"])
    recipe = copy.deepcopy(read_json(file))
    try:
        parts = [p.get("name") for p in recipe["body"]]
        recipe = thicken(stretch(recipe, proportions), radii)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise BadData(f"{file}: not a creature recipe ({error!r}); see assets/creature/README.md") from None
    for part in radii:
        if part not in parts:
            known = ", ".join(filter(None, parts))
            raise BadData(f"{path}: radii: no body part '{part}'; {file} has {known}")
    recipe["name"] = name
    recipe["vertices"] = body.get("vertices", recipe.get("vertices", 7000))
    return recipe


def _tissue(path, body):
    known_keys(f"{path}: tissue", body.get("tissue", {}), TISSUE_KEYS)
    base = read_json(os.path.join(ROOT, body["tissue_recipe"])) if "tissue_recipe" in body else {}
    return {**base, **body.get("tissue", {})}


def read_body(path, character=None):
    """A body file; `character` is the path of a body that has no creature recipe. Throws BadData."""
    name = checked_name(path, os.path.splitext(os.path.basename(path))[0])
    body, proportions, radii = _checked(path, read_json(path))
    if ("creature" in body) == (character is not None):
        raise BadData(
            f"{path}: has a creature recipe, so it takes no --character"
            if character
            else f"{path}: has no creature recipe; give its file with --character {name}=PATH"
        )
    creature = None if character else _creature(path, name, body, proportions, radii)
    return Body(name, creature, character, _tissue(path, body))


def read_character(folder, name, path):
    """A character file, with the tissue of folder/NAME.json where there is one. Throws BadData."""
    if not os.path.isfile(path):
        raise BadData(f"--character {name}={path}: no such file")
    checked_name("--character", name)
    beside = os.path.join(folder, f"{name}.json")
    return read_body(beside, path) if os.path.exists(beside) else Body(name, character=path)
