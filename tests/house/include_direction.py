"""Checks that includes point one way: core <- math, pack <- kernels <- tissue, rods <- schedule <- character <- world <- c, adapters; nothing in runtime/ includes the baker.

usage: include_direction.py PROJECT_ROOT
Within runtime/ and baker/ it counts what includes itself in a circle, a header and its source as one, and the files of each folder; both numbers may
only shrink. Exit 1 with a line an offender. It first checks itself on what must be refused.
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
# The most files that include one another in a circle, by trees: of rods, a batch and its collider step together.
LARGEST_CIRCLE = {"runtime": 5, "baker": 3}
# Files in the fullest folder, of these endings.
COUNTED = (".hpp", ".cpp", ".h", ".py", ".sh", ".md", ".txt")
FULLEST_FOLDER = {"runtime": 18, "baker": 22}
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
        for path in sources(root / tree):
            if path.relative_to(root / tree).parts[0] not in rooms:
                yield f"{path.relative_to(root)} lies in no room of {pathlib.Path(__file__).name}"
        for room in rooms:
            for path in sources(root / tree / room):
                for included in INCLUDE.findall(path.read_text(encoding="ascii")):
                    why = judge(room, included)
                    if why:
                        yield f"{path.relative_to(root)} includes {included}: {why}"


def include_graph(folder, prefix):
    """{part: parts it includes}, a header and its source being one part, named as includes name it."""
    files = {(prefix + p.relative_to(folder).as_posix()).split("include/")[-1]: p for p in sources(folder)}
    graph = {name.rsplit(".", 1)[0]: set() for name in files}
    for name, path in files.items():
        own = name.rsplit(".", 1)[0]
        graph[own] |= {i.rsplit(".", 1)[0] for i in INCLUDE.findall(path.read_text(encoding="ascii")) if i in files} - {own}
    return graph


def circles(graph):
    """Sets of two or more parts that reach one another, largest first."""
    reach = {}
    for part in graph:
        seen, todo = set(), [part]
        while todo:
            new = graph[todo.pop()] - seen
            seen |= new
            todo += new
        reach[part] = seen
    found = {frozenset(other for other in reach[part] if part in reach[other]) for part in graph if part in reach[part]}
    return sorted(found, key=len, reverse=True)


def changed(what, number, stated):
    """A number that may only shrink: why it is not as stated; None where it is."""
    if number > stated:
        return f"{what} is {number} and was {stated}"
    if number < stated:
        return f"{what} is {number}: write that in place of {stated} in {pathlib.Path(__file__).name}"
    return None


def growths(root):
    for tree in ("runtime", "baker"):
        found = circles(include_graph(root / tree, "baker/" if tree == "baker" else ""))
        named = f"the largest circle of includes in {tree}/ ({', '.join(sorted(found[0])) if found else 'none'})"
        yield changed(named, len(found[0]) if found else 0, LARGEST_CIRCLE[tree])
        folders = [p for p in [root / tree, *(root / tree).rglob("*")] if p.is_dir() and p.name != "__pycache__"]
        count = {p: sum(f.suffix in COUNTED for f in p.iterdir()) for p in folders}
        fullest = max(folders, key=count.get)
        yield changed(f"the fullest folder of {tree}/, {fullest.relative_to(root)},", count[fullest], FULLEST_FOLDER[tree])


def main(root):
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}) == [{"a", "b", "c"}] and not circles({"a": {"b"}, "b": set()})
    assert changed("it", 2, 1) and changed("it", 1, 2) and not changed("it", 1, 1)
    assert offence("pack", "character/tick.hpp") and offence("world", "baker/mesh/recipe/recipe.hpp") and baker_offence("mesh", "baker/truth/fem/fem.hpp")
    assert not offence("world", "pack/format.hpp") and not offence("core", "sinew/types.hpp")
    found = [*offences(pathlib.Path(root)), *filter(None, growths(pathlib.Path(root)))]
    print("\n".join(found) or "includes point one way, and no folder or circle grew")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
