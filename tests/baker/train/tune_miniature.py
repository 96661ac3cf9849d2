"""sinew-train from end to end on a coarse creature: a run, a second one that goes on, one without clips, and
one that is stopped. Slow: a minute."""
import glob
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

import support

support.leave_without_torch()
from train.files.safetensors import load  # noqa: E402
from train.tune.finish import KEPT  # noqa: E402

TISSUE = {"voxels_high": 16, "nodes_per_region": 10}


def expect(good, *what):
    if not good:
        sys.exit(" ".join(map(str, what)))


class Program:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.bake = os.path.join(os.path.dirname(program), "sinew-bake")

    def place(self, name):
        return os.path.join(self.folder, name)

    def call(self, *command):
        done = subprocess.run(command, capture_output=True, text=True)
        expect(done.returncode == 0, *command, done.returncode, done.stdout, done.stderr)
        return done.stdout

    def command(self, name, minutes):
        files = [self.place(f"{name}.glb"), "--recipe", self.place("tissue.json")]
        return [self.program, *files, "--minutes", minutes, "-o", self.place(f"{name}.sinew")]

    def train(self, name, minutes, *more):
        return self.call(*self.command(name, minutes), *more)

    def make(self, name, **changes):
        with open(support.ROOT / "assets" / "creature" / "creature.json") as file:
            recipe = {**json.load(file), "vertices": 500, **changes}
        with open(self.place(f"{name}.json"), "w") as file:
            json.dump(recipe, file)
        with open(support.ROOT / "assets" / "creature" / "tissue.json") as file:
            tissue = {**json.load(file), **TISSUE}
        with open(self.place("tissue.json"), "w") as file:
            json.dump(tissue, file)
        self.call(self.bake, "creature", self.place(f"{name}.json"), "-o", self.place(f"{name}.glb"))


def check_a_run_and_a_second_one(program):
    said = program.train("mini", "0.3", "--keep")
    print(said)
    for words in ("held-out motion", "skinning", "modal base", "shipped", "mini.sinew: "):
        expect(words in said, "not said:", words)
    expect(", 0 there already" in said, "motions before there were any")
    info = json.loads(program.call(program.bake, "info", program.place("mini.sinew"), "--json"))
    expect(info["regions"], "no regions in the pack")
    again = program.train("mini", "0.3", "--keep")
    print(again)
    expect(", 0 there already" not in again, "a second run simulated all again")
    return said + again


def check_the_weights(program, said):
    path = program.place("mini.tissue.safetensors")
    expect(os.path.exists(path) == ("fine-tuned weights" in said), "weights and words differ")
    if os.path.exists(path):
        metadata = load(path)[1]
        expect(metadata["tuned_for"] == "mini.glb" and 0 < float(metadata["error_ratio"]) < 10, metadata)
        (whole,) = glob.glob(program.place("mini.train/*/tuned.safetensors"))
        share = float(metadata["output_scale"]) / float(load(whole)[1]["output_scale"])
        expect(abs(share - KEPT) < 1e-6, "corrects by", share, "of what was learned")


def check_without_clips(program):
    program.make("still", clips=[])
    said = program.train("still", "0.02")
    expect("clips: none" in said and "still.sinew: " in said, said)


def check_a_stop(program):
    """While it simulates, so long before its time is over."""
    os.remove(program.place("still.sinew"))
    both = dict(stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    process = subprocess.Popen(program.command("still", "30"), **both)
    while "soft parts" not in process.stdout.readline():
        expect(process.poll() is None, "ended before it was stopped")
    time.sleep(1)
    began_s = time.monotonic()
    process.send_signal(signal.SIGINT)
    said, errors = process.communicate(timeout=120)
    print(f"stopped in {time.monotonic() - began_s:.1f} s: {said}")
    expect(process.returncode == 0, process.returncode, errors)
    expect("keeps the best so far" in errors and "still.sinew: " in said, said, errors)
    expect(os.path.exists(program.place("still.sinew")), "stopped without a character")


def main(path):
    with tempfile.TemporaryDirectory() as folder:
        program = Program(path, folder)
        program.make("mini")
        check_the_weights(program, check_a_run_and_a_second_one(program))
        check_without_clips(program)
        check_a_stop(program)


if __name__ == "__main__":
    main(sys.argv[1])
