#!/usr/bin/env python3
# make.py  The gallery: bakes characters as proposed and by hand-written recipes, plays and audits them, draws pictures and writes the page.
"""Usage: make.py CHARACTERS [BUILD] [--only FOLDER]... [--work DIR]
       make.py --page

CHARACTERS holds one folder for each character of characters.json that is not made up, with file.glb, .gltf or .vrm in it;
BUILD is a build folder (build/release). Writes pictures, gallery.csv and README.md in this script's folder; with --only
pictures alone, with --page README.md alone, from gallery.csv.
"""
import argparse
import csv
import io
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

try:
    from PIL import Image

    from made_up import write_all
except ImportError:  # a Python without Debian's packages
    system_python = "/usr/bin/python3"
    if os.path.realpath(sys.executable) == os.path.realpath(system_python):
        sys.exit("make.py: no PIL; run scripts/install_packages.sh")
    os.execv(system_python, [system_python, *sys.argv])

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WEIGHTS = ROOT / "assets/weights/creature.safetensors"
CSV = HERE / "gallery.csv"
COLUMNS = ("folder", "way", "part", "simulated", "kind", "evidence", "frequency_hz", "limit", "moving_fraction", "displacement_of_height", "bob_of_height",
           "residual_of_height", "edge_stretch", "limits_lowered", "audit", "bake_seconds", "error_modes", "error_network", "network")
PANEL_PIXELS, RAYS = 250, 48  # the demo draws its still half as large again
WIDTH, MOST_BYTES = 1120, 150_000
GAP, BACKGROUND = 4, (250, 252, 255)
PROPOSED, BY_HAND = "proposed", "recipe"  # ways to bake, as pictures are named


def run(command, allowed=(0,)):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode not in allowed:
        sys.exit(f"make.py: {' '.join(map(str, command))}: exit {done.returncode}\n{done.stderr or done.stdout}")
    return done.stdout


def part_rows(printed):
    """The table of moving parts that a bake prints: name -> (evidence, kind, Hz, limit)."""
    lines = printed.splitlines()
    header = next((i for i, line in enumerate(lines) if re.match(r"part +evidence +kind +Hz", line)), None)
    rows = {}
    if header is None:
        return rows
    starts = [lines[header].index(word) for word in ("evidence", "kind", "Hz", "limit")]
    for line in lines[header + 1:]:
        if not re.search(r"(soft tissue|rod of \d+ bones?)$", line):
            continue
        ends = [0, *starts, len(line)]
        cells = [line[a:b].strip() for a, b in zip(ends, ends[1:])]
        rows[cells[0]] = (cells[1], cells[2], cells[3], cells[4].split()[0])
    return rows


def limits_lowered(printed):
    """How many parts' limit a bake or a proposal has lowered because their skin would tear."""
    return len(re.findall(r"^note: .*its skin would tear", printed, re.MULTILINE))


def own_network(folder):
    """Weights that sinew-train made for a character, as baker/train/tune_gallery.sh ships them, or None."""
    path = HERE / f"{folder}.tissue.safetensors"
    return path if path.exists() else None


class Proposal:
    """What `propose` writes, unedited, and its numbered picture."""

    def __init__(self, tools, source, work):
        self.recipe, self.preview = work / "proposal.json", work / "proposal.png"
        printed = run([tools / "sinew-bake", "propose", source, "-o", self.recipe, "--preview", self.preview])
        self.lowered = limits_lowered(printed)
        written = json.loads(self.recipe.read_text())
        parts = written["regions"] + written.get("rods", [])
        self.evidence = {part["name"]: part["note"].split(": ", 1)[1] for part in parts}  # after its number
        self.off = [part["name"] for part in parts if not part["enabled"]]


class Bake:
    """One character baked one way: the pack, its table, its audit and the time of the bake."""

    def __init__(self, tools, source, recipe, work, proposal=None, own=None):
        self.pack = work / "character.sinew"
        self.preview = proposal.preview if proposal else work / "preview.png"
        self.proposal, self.own = proposal, own
        command = [tools / "sinew-bake", "character", source, "--tissue", own or WEIGHTS, "-o", self.pack, "--recipe", recipe]
        if not proposal:
            command += ["--preview", self.preview]
        if own:
            command += ["--keep-network"]
        start = time.monotonic()
        printed = run(command)
        self.seconds = time.monotonic() - start
        self.parts = part_rows(printed)
        self.lowered = proposal.lowered if proposal else limits_lowered(printed)
        left_out = re.search(r"network is left out: on this character its error is ([\d.]+)", printed)
        self.left_out = float(left_out.group(1)) if left_out else None
        self.info = json.loads(run([tools / "sinew-bake", "info", self.pack, "--json"]))
        self.audit = json.loads(run([tools / "sinew-bake", "audit", self.pack, "--json"], allowed=(0, 1)))

    def error_of(self, tier):
        return next((t["error_ratio"] for t in self.info["tiers"] if t["tier"] == tier), None)

    def most(self, key):
        values = [part[key] for part in self.audit["parts"]]
        return max((v["value"] if isinstance(v, dict) else v for v in values), default=None)

    def rows(self, folder, way):
        """Of COLUMNS: the character, its moving parts and those that the proposal leaves switched off."""
        digits = lambda value: "" if value is None else float(f"{value:.3g}")
        error = self.error_of("network")
        state = "kept" if error is not None else "left out" if self.left_out is not None else ""
        yield {"folder": folder, "way": way, "moving_fraction": digits(self.audit["moving_share"]) if self.parts else "",
               **{column: digits(self.most(key)) for column, key in (("displacement_of_height",) * 2, ("bob_of_height", "bob_displacement_of_height"),
                                                                     ("residual_of_height",) * 2, ("edge_stretch",) * 2)},
               "limits_lowered": self.lowered, "audit": "passes" if self.audit["ok"] else "; ".join(map(str, self.audit["failures"])),
               "bake_seconds": digits(self.seconds), "error_modes": digits(self.error_of("modal")),
               "error_network": digits(self.left_out if error is None else error),
               "network": state and f"{'own' if self.own else 'generic'}, {state}"}
        audited = {part["name"]: part for part in self.audit["parts"]}
        evidence = self.proposal.evidence if self.proposal else {}
        for name, (_, kind, hz, limit) in self.parts.items():
            part = audited[name]
            yield {"folder": folder, "way": way, "part": name, "simulated": "rod" if part["kind"] == "rod" else "soft", "kind": kind,
                   "evidence": evidence.get(name, "recipe"), "frequency_hz": hz, "limit": limit.strip("-"), "moving_fraction": digits(part["moving_share"]),
                   "displacement_of_height": digits(part["displacement_of_height"]["value"]), "bob_of_height": digits(part["bob_displacement_of_height"]),
                   "edge_stretch": digits(part["edge_stretch"]["value"])}
        for name in self.proposal.off if self.proposal else ():
            yield {"folder": folder, "way": way, "part": name, "simulated": "no, in doubt", "evidence": evidence[name]}


def scaled(image):
    return image.resize((WIDTH, round(image.height * WIDTH / image.width)), Image.LANCZOS)


def compose(preview, still):
    """The picture of the parts above the one of their movement."""
    images = [scaled(Image.open(path).convert("RGB")) for path in (preview, still) if path]
    out = Image.new("RGB", (WIDTH, sum(i.height for i in images) + GAP * (len(images) - 1)), BACKGROUND)
    y = 0
    for image in images:
        out.paste(image, (0, y))
        y += image.height + GAP
    return out


def write_jpeg(image, path):
    for quality in range(88, 40, -4):
        image.save(path, quality=quality, optimize=True, progressive=True)
        if path.stat().st_size <= MOST_BYTES:
            return
    sys.exit(f"make.py: {path}: more than {MOST_BYTES} bytes")


def play(tools, bake, character, work):
    """The liveliest moment: skinning, Sinew and the distance between them."""
    command = [tools / "sinew-demo", bake.pack, "--frames", work / "pictures", "--view", character["view"],
               "--width", PANEL_PIXELS, "--height", PANEL_PIXELS, "--samples", RAYS]
    if character["clip"]:
        command += ["--clip", character["clip"]]
    run(command)
    return work / "pictures/still.png"


def file_of(characters, character, work):
    folder = character["folder"]
    if character["made_up"]:
        return work / f"made_up/{folder}.glb"
    files = sorted((characters / folder).glob("file.*"))
    if len(files) != 1:
        sys.exit(f"make.py: {characters / folder}: needs one file.glb, file.gltf or file.vrm")
    return files[0]


def make(tools, characters, character, work):
    folder, file = character["folder"], file_of(characters, character, work)
    bakes = {}
    for way in (PROPOSED,) if character["made_up"] else (PROPOSED, BY_HAND):
        place = work / folder / way
        place.mkdir(parents=True, exist_ok=True)
        source = place / (folder + file.suffix)  # its name is drawn in pictures
        source.unlink(missing_ok=True)
        source.symlink_to(file.resolve())
        proposal = Proposal(tools, source, place) if way == PROPOSED else None
        own = None if proposal else own_network(folder)
        bake = bakes[way] = Bake(tools, source, proposal.recipe if proposal else HERE / f"{folder}.json", place, proposal, own)
        still = play(tools, bake, character, place) if bake.parts else None
        write_jpeg(compose(bake.preview, still), HERE / f"{folder}_{way}.jpg")
        print(f"{folder}, {way}: {len(bake.parts)} parts, {bake.lowered} limits lowered, {bake.seconds:.1f} s, "
              f"{'passes' if bake.audit['ok'] else 'FAILS: ' + '; '.join(map(str, bake.audit['failures']))}", flush=True)
    return bakes


def slashed(values):
    """A cell: of the proposal, and behind a slash of the recipe."""
    return "/".join(values)


def summary(characters, rows):
    number = lambda value, digits, scale=1: f"{scale * float(value):.{digits}f}" if value else "–"
    yield "| character | parts | moving, % | error of modes | network | bake, s |"
    yield "|---|---:|---:|---:|---:|---:|"
    for character in characters:
        mine = [row for row in rows if row["folder"] == character["folder"]]
        whole = [row for row in mine if not row["part"]]
        moving = lambda way: sum(row["way"] == way and row["simulated"] in ("soft", "rod") for row in mine)
        kept = lambda row: row["network"].endswith("kept")
        cells = [character["title"], slashed(str(moving(row["way"])) for row in whole), slashed(number(row["moving_fraction"], 1, 100) for row in whole),
                 slashed(number(row["error_modes"], 2) for row in whole), slashed(number(kept(row) and row["error_network"], 2) for row in whole),
                 slashed(number(row["bake_seconds"], 0) for row in whole)]
        yield "| " + " | ".join(cells) + " |"


def audited(characters, rows):
    """How many packs pass their audit, and which do not."""
    titles = {character["folder"]: character["title"] for character in characters}
    whole = [row for row in rows if not row["part"]]
    failed = [f"{titles[row['folder']]} ({row['way']})" for row in whole if row["audit"] != "passes"]
    return f"{len(whole) - len(failed)} of {len(whole)} packs pass `sinew-bake audit`" + (f"; failing: {', '.join(failed)}." if failed else ".")


def page(characters, rows):
    yield """# Gallery

Eight characters of others and four made-up ones. `assets/gallery/make.py CHARACTERS build/release` bakes each as `sinew-bake propose` proposes it, the eight also by the hand-written recipes in this folder, plays and audits the packs,
draws the pictures and writes `gallery.csv` and this page. The files of the eight are not in this repository. Authors and licences are named below; Sinew changes how the works move.
"""
    yield from summary(characters, rows)
    yield f"""
A slash separates proposal and recipe. *Moving*: vertices that move by 0.5 % of the height or more. Errors are distances of the surface from the finite-element truth as a fraction of skinning's, the median over motions; a network's where it is [kept](../evaluation/characters/README.md).
{audited(characters, rows)} Every part and figure: [gallery.csv](gallery.csv).

Pictures show soft parts in colour and rods as lines; below them the liveliest moment: skinning, Sinew, their distance, darkest at 5 % of the height."""
    for character in characters:
        folder = character["folder"]
        ways = dict.fromkeys(row["way"] for row in rows if row["folder"] == folder)
        pictures = " ".join(f"![{way}]({folder}_{way}.jpg)" for way in ways)
        credit = "" if character["made_up"] else f" {character['credit']}"
        yield f"\n## {character['title']}\n\n{character['note']}{credit}\n\n{pictures}"


def listed_characters():
    return [{"made_up": False} | character for character in json.loads((HERE / "characters.json").read_text())]


def write_page():
    rows = []
    if CSV.exists():
        with CSV.open(newline="") as file:
            rows = list(csv.DictReader(file))
    if not rows:
        sys.exit("make.py: gallery.csv holds no character; run make.py CHARACTERS")
    replace(HERE / "README.md", "\n".join(page(listed_characters(), rows)) + "\n")


def replace(path, text):
    part = path.with_name(path.name + ".part")
    part.write_text(text)
    part.replace(path)


def write_csv(rows):
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    replace(CSV, text.getvalue())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("characters", type=Path, nargs="?")
    parser.add_argument("build", type=Path, nargs="?", default=ROOT / "build/release")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--work", type=Path, default=ROOT / "out/gallery")
    parser.add_argument("--page", action="store_true")
    options = parser.parse_args()
    if options.page:
        if options.characters or options.only:
            parser.error("--page stands alone: it draws nothing")
        write_page()
        return
    if not options.characters:
        parser.error("give CHARACTERS or --page")
    tools = options.build.resolve() / "bin"
    for program in ("sinew-bake", "sinew-demo"):
        if not (tools / program).exists():
            sys.exit(f"make.py: {tools / program} is missing; build it: cmake --build {options.build} --target sinew-bake sinew-demo")
    listed = listed_characters()
    unknown = set(options.only) - {character["folder"] for character in listed}
    if unknown:
        sys.exit(f"make.py: --only {unknown.pop()}: not in characters.json")
    chosen = [character for character in listed if not options.only or character["folder"] in options.only]
    write_all(options.work / "made_up")
    made = [(character, make(tools, options.characters, character, options.work)) for character in chosen]
    if not options.only:
        write_csv(row for character, bakes in made for way, bake in bakes.items() for row in bake.rows(character["folder"], way))
        write_page()
    if not all(bake.audit["ok"] for _, bakes in made for bake in bakes.values()):
        sys.exit(1)


if __name__ == "__main__":
    main()
