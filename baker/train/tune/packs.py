"""What sinew-bake does for the tuner: characters with and without a network, what they hold, their errors."""
import json
import subprocess
from dataclasses import dataclass

from ..files.safetensors import BadData
from .verdict import Error


@dataclass
class Baker:
    """program: path of sinew-bake. recipe, rods (weights that its rods start from): a path, or None."""

    program: str
    character: str
    recipe: str = None
    rods: str = None

    def run(self, *arguments):
        """What it printed; its own line as BadData where it refuses. Ctrl-C does not reach it."""
        command = [self.program, *arguments]
        try:
            done = subprocess.run(command, capture_output=True, text=True, start_new_session=True)
        except OSError as error:
            raise BadData(f"{self.program}: {error.strerror}; build sinew-bake, or give --bake") from None
        if done.returncode:
            said = (done.stderr.strip().splitlines() or [f"{arguments[0]}: exit code {done.returncode}"])[-1]
            raise BadData(said.removeprefix("sinew-bake: "))
        return done.stdout

    def of_recipe(self):
        return ["--recipe", self.recipe] if self.recipe else []

    def bake(self, pack, weights=None, measured=False):
        """The character with these weights, or with its modes alone. measured: with its errors stated, which
        takes seconds. Returns the notes on it."""
        tissue = ["--tissue", weights] if weights else []
        how = ["--keep-network"] if measured else ["--quick"]
        rods = ["--rods", self.rods] if self.rods else []
        said = self.run("character", self.character, *self.of_recipe(), *tissue, *rods, *how, "-o", pack)
        return [line for line in said.splitlines() if line.startswith("note: ")]

    def describe(self, pack):
        return json.loads(self.run("info", pack, "--json"))

    def judge(self, packs, truths, ticks):
        """Error of each pack, ticked along true motions as the runtime does, its guards included."""
        said = json.loads(self.run("judge", *packs, "--truth", *truths, "--ticks", str(ticks), "--json"))
        return [Error(**{k: one["ticks"][str(ticks)][k] for k in Error._fields}) for one in said["characters"]]
