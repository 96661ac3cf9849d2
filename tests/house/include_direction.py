"""Checks that includes point one way: core <- pack, kernels <- tissue, rods <- schedule <- character <- world <- c; nothing in runtime/ includes the baker.

usage: include_direction.py PROJECT_ROOT
Exit 1 with a line an offender. It first checks itself on an include that must be refused.
"""
import pathlib
import re
import sys

# What a room may include, besides itself and the public headers.
ALLOWED = {
    "core": set(),
    "math": {"core"},
    "pack": {"core"},
    "kernels": {"core", "pack"},
    "tissue": {"core", "pack", "kernels"},
    "rods": {"core", "pack", "kernels"},
    "schedule": {"core", "pack", "kernels", "tissue", "rods"},
    "character": {"core", "math", "pack", "kernels", "tissue", "rods", "schedule"},
    "world": {"core", "math", "pack", "kernels", "tissue", "rods", "schedule", "character"},
    "include": set(),
    "c": {"core", "pack", "kernels", "tissue", "rods", "schedule", "character", "world"},
    # Adapters to other libraries; the core knows none of them.
    "adapters": {"core", "math", "pack", "kernels", "tissue", "rods", "schedule", "character", "world"},
}
# The offline rooms, in the same way; every one may include baker/common and the runtime.
BAKER = {
    "common": set(),
    "import": set(),
    "creature": set(),
    "mesh": {"import"},
    "truth": {"import", "mesh"},
    "pack": {"import", "mesh", "truth"},
    "rods": {"truth"},
    "patches": {"truth"},
    "research": {"pack"},
    "render": set(),
    "preview": {"render"},
    "audit": {"import", "mesh", "preview", "render"},
    "measure": {"import", "mesh", "truth", "pack", "research"},
    "programs": {"audit", "import", "mesh", "truth", "pack", "creature", "measure", "patches", "rods", "preview"},
    "trade": {"import", "mesh", "truth", "pack", "measure", "render"},
}
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def offence(room, included):
    """Why a file of runtime/<room> may not include this path; None when it may."""
    head = included.split("/")[0]
    if head in ("baker", "samples", "tests"):
        return "the runtime does not know it"
    if head in ALLOWED and head not in ALLOWED[room] | {room}:
        return f"{room} comes before {head}"
    return None


def baker_offence(room, included):
    parts = included.split("/")
    if parts[0] in ("samples", "tests"):
        return "the baker does not know it"
    if parts[0] == "baker" and parts[1] not in BAKER[room] | {room, "common"}:
        return f"baker/{room} does not use baker/{parts[1]}"
    return None


def sources(folder):
    return [p for p in folder.rglob("*") if p.suffix in (".hpp", ".cpp", ".inl")]


def offences(root):
    for tree, rooms, judge in (("runtime", ALLOWED, offence), ("baker", BAKER, baker_offence)):
        for room in rooms:
            for path in sources(root / tree / room):
                for included in INCLUDE.findall(path.read_text(encoding="ascii")):
                    why = judge(room, included)
                    if why:
                        yield f"{path.relative_to(root)} includes {included}: {why}"


def main(root):
    assert offence("pack", "character/tick.hpp") and offence("world", "baker/mesh/recipe/recipe.hpp") and baker_offence("mesh", "baker/truth/fem/fem.hpp")
    assert not offence("world", "pack/format.hpp") and not offence("core", "sinew/types.hpp")
    found = list(offences(pathlib.Path(root)))
    print("\n".join(found) or "includes point one way")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
