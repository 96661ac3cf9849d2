#!/usr/bin/env python3
# make.py  The gallery: bakes characters as proposed and by hand-written recipes, plays and audits them, draws pictures and writes the page.
"""Usage: make.py CHARACTERS [BUILD] [--only FOLDER]... [--work DIR]

CHARACTERS holds a folder a character of characters.json that is not made up, with file.glb, .gltf or .vrm in it;
BUILD is a build folder (build/release). Writes README.md and pictures beside this script; with --only pictures alone.
"""
import argparse
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
PANEL_PIXELS, RAYS = 250, 48  # the demo draws its still half as large again
WIDTH, MOST_BYTES = 1120, 150_000
GAP, BACKGROUND = 4, (250, 252, 255)
LEAST_MOVING, MOST_OF_FLESH = 0.01, 0.1  # of the vertices; of the height


def run(command, allowed=(0,)):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode not in allowed:
        sys.exit(f"make.py: {' '.join(map(str, command))}: exit {done.returncode}\n{done.stderr or done.stdout}")
    return done.stdout


def part_rows(printed):
    """The table of parts that a bake prints: name -> (evidence, kind, Hz, limit); parts that stay rigid are left out."""
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
    """Parts whose limit a bake or a proposal has lowered, for their skin would tear."""
    return len(re.findall(r"^note: .*its skin would tear", printed, re.MULTILINE))


class OwnNetwork:
    """Weights that sinew-train made for a character, as baker/train/tune_gallery.sh ships them; sinew-train has judged them on more motions than a bake."""

    def __init__(self, folder):
        self.path = HERE / f"{folder}.tissue.safetensors"
        with open(self.path, "rb") as file:
            told = json.loads(file.read(int.from_bytes(file.read(8), "little")))["__metadata__"]
        errors = json.loads(told["held_out"])
        self.motions = len(errors) - 1
        self.of_base = errors["all"]["fine-tuned"]["ratio"] / errors["all"]["modal base"]["ratio"]

    def told(self):
        return f"On {self.motions} motions that it never saw its own network leaves {self.of_base:.2f} of the modes' error"

    @classmethod
    def of(cls, folder):
        return cls(folder) if (HERE / f"{folder}.tissue.safetensors").exists() else None


class Proposal:
    """What `propose` writes, unedited, and its numbered picture."""

    def __init__(self, tools, source, work):
        self.recipe, self.preview = work / "proposal.json", work / "proposal.png"
        printed = run([tools / "sinew-bake", "propose", source, "-o", self.recipe, "--preview", self.preview])
        self.lowered = limits_lowered(printed)
        written = json.loads(self.recipe.read_text())
        parts = written["regions"] + written.get("rods", [])
        self.why = {part["name"]: part["note"].split(": ", 1)[1] for part in parts}  # after its number
        self.off = [part["name"] for part in parts if not part["enabled"]]


class Bake:
    """One character baked one way: the pack, its table, its audit and what a bake cost."""

    def __init__(self, tools, source, recipe, work, proposal=None, own=None):
        self.pack = work / "character.sinew"
        self.preview = proposal.preview if proposal else work / "preview.png"
        self.proposal, self.own = proposal, own
        command = [tools / "sinew-bake", "character", source, "--tissue", own.path if own else WEIGHTS, "-o", self.pack, "--recipe", recipe]
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

    def most(self, key, kind=None):
        values = [part[key] for part in self.audit["parts"] if kind in (None, part["kind"])]
        return max((v["value"] if isinstance(v, dict) else v for v in values), default=None)

    def why(self, part):
        return self.proposal.why.get(part, "") if self.proposal else "recipe"


def scaled(image):
    return image.resize((WIDTH, round(image.height * WIDTH / image.width)), Image.LANCZOS)


def compose(preview, still):
    """The parts above what they do."""
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
    """The liveliest moment, as skinning and Sinew show it and how far they are apart."""
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
    for way in ("proposed",) if character["made_up"] else ("proposed", "with"):
        place = work / folder / way
        place.mkdir(parents=True, exist_ok=True)
        source = place / (folder + file.suffix)  # pictures show the file's name
        source.unlink(missing_ok=True)
        source.symlink_to(file.resolve())
        proposal = Proposal(tools, source, place) if way == "proposed" else None
        own = None if proposal else OwnNetwork.of(folder)
        bake = bakes[way] = Bake(tools, source, proposal.recipe if proposal else HERE / f"{folder}.json", place, proposal, own)
        still = play(tools, bake, character, place) if bake.parts else None
        write_jpeg(compose(bake.preview, still), HERE / f"{folder}_{way}.jpg")
        print(f"{folder}, {way}: {len(bake.parts)} parts, {bake.lowered} limits lowered, {bake.seconds:.1f} s, "
              f"{'passes' if bake.audit['ok'] else 'FAILS: ' + '; '.join(map(str, bake.audit['failures']))}", flush=True)
    return bakes


def figure(value, form):
    return "–" if value is None else "0" if value == 0 else format(value, form)


def percent(share):
    return f"{100 * share:.1f} %"


def network_of(bake):
    whose = "its own, " if bake.own else ""
    if bake.left_out is not None:
        return f"{whose}left out ({bake.left_out:.2f})"
    error = bake.error_of("network")
    return "–" if error is None else f"{whose}kept, {error:.2f}"


def summary(made):
    yield ("| character | recipe | parts | visibly moving | flesh / height | rods / height | bob / height | residual / height | edge stretch | limits lowered | audit | bake, s "
           "| error of modes | network |")
    yield "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---|---:|---:|---|"
    for character, bakes in made:
        for way, bake in bakes.items():
            cells = [f"[{character['title']}](#{character['title'].lower().replace(' ', '-')})", way, len(bake.parts),
                     percent(bake.audit["moving_share"]) if bake.parts else "–",
                     figure(bake.most("displacement_of_height", "region"), ".3f"), figure(bake.most("displacement_of_height", "rod"), ".3f"),
                     figure(bake.most("bob_displacement_of_height"), ".3f"),
                     figure(bake.most("residual_of_height"), ".0e"), figure(bake.most("edge_stretch"), ".2f"), bake.lowered,
                     "passes" if bake.audit["ok"] else "**fails**", f"{bake.seconds:.1f}",
                     figure(bake.error_of("modal"), ".2f"), network_of(bake)]
            yield "| " + " | ".join(map(str, cells)) + " |"


def tally(made):
    """How many proposals keep what is asked of them."""
    proposed = [bakes["proposed"] for _, bakes in made]
    soft = [bake for bake in proposed if bake.parts]
    moving = sum(bake.audit["moving_share"] >= LEAST_MOVING for bake in soft)
    calm = sum((bake.most("displacement_of_height", "region") or 0) <= MOST_OF_FLESH for bake in soft)
    return (f"Of {len(proposed)} proposals {len(soft)} have parts that move; of these, {moving} visibly move at least {100 * LEAST_MOVING:.0f} % of the vertices, "
            f"and flesh of {calm} stays within {MOST_OF_FLESH} of the height.")


def part_table(bakes):
    yield "| recipe | part | why | kind | Hz | limit / size | moving | displacement / height | bob / height | edge stretch |"
    yield "|---|---|---|---|---:|---:|---:|---:|---:|---:|"
    for way, bake in bakes.items():
        audited = {part["name"]: part for part in bake.audit["parts"]}
        for name, (_, kind, hz, limit) in bake.parts.items():
            part = audited[name]
            yield (f"| {way} | `{name}` | {bake.why(name)} | {kind}, {'rod' if part['kind'] == 'rod' else 'soft'} | {hz} | {limit} | {percent(part['moving_share'])} | "
                   f"{part['displacement_of_height']['value']:.3f} | {part['bob_displacement_of_height']:.3f} | {part['edge_stretch']['value']:.2f} |")


def in_doubt(proposal):
    if proposal.off:
        yield "\nProposed, but switched off:\n"
        for name in proposal.off:
            yield f"- `{name}`: {proposal.why[name]}"


CAPTIONS = {"proposed": "As proposed", "with": "By a hand-written recipe"}


def page(made):
    yield """# Gallery

Eight characters of others and four made-up ones, baked as `sinew-bake propose` proposes, unedited, and the eight by hand-written recipes, too. `assets/gallery/make.py CHARACTERS build/release`
makes this page and its pictures: it proposes, bakes each character, plays and audits the packs and draws what it saw. The files of the eight are not part of this repository; `made_up.py` writes the other four.

A picture shows on top what moves by itself, soft parts in colour and rods as lines, of a proposal numbered and with what it leaves switched off; below it the liveliest moment of four seconds: skinning alone, Sinew, and how
far apart they are, the darkest at 5 % of the height. A character of which nothing moves has the upper half alone. Recipes are the JSON files beside this page;
[their keys](../../docs/your-character.md#edit-the-recipe).
"""
    yield from summary(made)
    yield f"""
{tally(made)}

All but the limits lowered, the bake's seconds (two cores, measured errors included) and errors come from `sinew-bake audit`: the largest over parts and motions, lengths as a share of the character's height. *visibly moving*: vertices that move by at least 0.5 %
of the height somewhere in the bob or the character's clips. *bob*: while the root goes up and down by 5 % of the height, of which flesh may do 0.08; rods swing freely. *residual*: after a minute of rest, at most 1e-4. *edge stretch*: beyond skinning's, at most 1.5, of rods 2.
*limits lowered*: parts whose limit the proposal or the bake made smaller, for their skin would tear. Errors are distances from the finite-element truth of this
character as a share of skinning's, the median over a random motion and up to five clips; rods have no such truth. Truth and tiers are shown held at the part's limit: where they lie at it, what is compared is a direction. A network is left out where it is not 5 % better than the modes: in brackets what it would have had. The shipped one is trained on other bodies;
*its own* was trained on the character by `sinew-train`, is here where [it pays](../evaluation/characters/README.md) at the control nodes, and is kept."""
    for character, bakes in made:
        title, folder = character["title"], character["folder"]
        yield f"\n## {title}\n\n{character['note']}" + ("" if character["made_up"] else f" [Recipe]({folder}.json).") + "\n"
        if any(bake.parts for bake in bakes.values()):
            yield from part_table(bakes)
        yield from in_doubt(bakes["proposed"].proposal)
        for way, bake in bakes.items():
            own = f". {bake.own.told()} ([weights]({folder}.tissue.safetensors))" if bake.own else ""
            yield f"\n{CAPTIONS[way]}{own}:\n\n![{title}, {CAPTIONS[way].lower()}]({folder}_{way}.jpg)"
    yield "\n## Credits\n\nPictures and figures here are made from these works, which others made and licensed; all were baked by Sinew, which changes how they move.\n"
    yield "| character | by | licence |\n|---|---|---|"
    for character, _ in made:
        if not character["made_up"]:
            yield f"| {character['title']} | {character['credit']} | {character['licence']} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("characters", type=Path)
    parser.add_argument("build", type=Path, nargs="?", default=ROOT / "build/release")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--work", type=Path, default=ROOT / "out/gallery")
    options = parser.parse_args()
    tools = options.build.resolve() / "bin"
    for program in ("sinew-bake", "sinew-demo"):
        if not (tools / program).exists():
            sys.exit(f"make.py: {tools / program} is missing; build it: cmake --build {options.build} --target sinew-bake sinew-demo")
    listed = [{"made_up": False} | character for character in json.loads((HERE / "characters.json").read_text())]
    unknown = set(options.only) - {character["folder"] for character in listed}
    if unknown:
        sys.exit(f"make.py: --only {unknown.pop()}: not in characters.json")
    chosen = [character for character in listed if not options.only or character["folder"] in options.only]
    write_all(options.work / "made_up")
    made = [(character, make(tools, options.characters, character, options.work)) for character in chosen]
    if not options.only:
        (HERE / "README.md").write_text("\n".join(page(made)) + "\n")
    if not all(bake.audit["ok"] for _, bakes in made for bake in bakes.values()):
        sys.exit(1)


if __name__ == "__main__":
    main()
