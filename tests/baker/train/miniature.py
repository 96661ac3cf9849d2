"""The whole path in two minutes: a coarse creature, a few simulated seconds, a third of a minute of
training, export, bake, check."""
import json
import os
import subprocess
import sys
import tempfile

import support

support.leave_without_torch()
from train.cli import main as trainer  # noqa: E402
from train.judge import baselines, evaluate  # noqa: E402

CHECK_TOLERANCE = "1e-4"  # length units of a tenth of a radius: float32 against float64 over 120 ticks

# Nothing here looks at how well the plain models are fitted, nor at a whole minute of rest: both are only gone through.
baselines.FIT_TICKS, evaluate.STILL_TICKS = 15, 200


def run(*command):
    """Runs a program and returns what it printed; a failure ends the test with its own words."""
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def train_step(*arguments):
    if trainer(list(arguments)):
        sys.exit(f"baker/train {' '.join(arguments)}: failed")


def small_plan(folder):
    """The creature with few vertices, on a coarse cage with few control nodes, and a few seconds of motion."""
    body = {
        "creature": "assets/creature/creature.json",
        "tissue_recipe": "assets/creature/tissue.json",
        "vertices": 500,
        "tissue": {"voxels_high": 16, "nodes_per_region": 10},
    }
    line = {"body": "mini", "seconds": 2, "random": 1}
    sequences = [
        {**line, "split": "train", "random": 8},
        {**line, "split": "validation", "first_seed": 2000},
        {**line, "split": "test", "random": 0, "held_out": 1, "surface": True},
    ]
    plan = {"substeps": 2, "held_out_clip": "hop", "sequences": sequences}
    for name, value in (("mini", body), ("plan", plan)):
        with open(os.path.join(folder, f"{name}.json"), "w") as file:
            json.dump(value, file)
    return os.path.join(folder, "plan.json")


def main(bake):
    with tempfile.TemporaryDirectory() as folder:
        place = lambda name: os.path.join(folder, name)
        train_step("generate", "--plan", small_plan(folder), "--bake", bake, "--out", place("data"))
        train_step(
            "train",
            place("data"),
            "--out",
            place("run"),
            "--minutes",
            "0.3",
            "--channels",
            "16,3",
            "--batch",
            "3",
        )
        train_step(
            "evaluate", place("data"), "--run", f"network={place('run')}", "--out", place("page")
        )
        train_step(
            "export",
            place("data"),
            *("--run", place("run"), "--page", place("page"), "--model", "network", "--body", "mini"),
            *("--out", place("weights"), "--name", "mini"),
        )
        run(bake, "model", place("weights/mini.safetensors"), "-o", place("mini.sinew"))
        for network in ("mini.sinew", "weights/mini.safetensors"):
            report = json.loads(
                run(
                    bake,
                    "check",
                    place(network),
                    place("weights/mini.vectors.safetensors"),
                    "--tolerance",
                    CHECK_TOLERANCE,
                )
            )
            assert report["ok"] and report["steps"] > 50, report
        run(
            bake,
            "character",
            place("data/mini/body.glb"),
            "--recipe",
            place("data/mini/tissue.json"),
            "--tissue",
            place("weights/mini.safetensors"),
            "-o",
            place("c.sinew"),
        )
        told = json.loads(run(bake, "info", place("c.sinew"), "--json"))
        with open(place("page/metrics.json")) as file:
            row = json.load(file)["bodies"]["mini"]["roll_out"]["100"]
        ratio, base = row["network"]["ratio"], row["modal_warped"]["ratio"]
        print(
            f"held-out error after 100 ticks: {ratio} of skinning's, its modal base alone {base}; "
            f"baked for {len(told['regions'])} regions"
        )
        assert ratio < 1.1 * base < 0.6, "training made the base worse, or the base is none"
        assert os.path.getsize(place("page/roll_outs.png")) > 1000 and os.path.exists(place("page/README.md"))


if __name__ == "__main__":
    main(sys.argv[1])
