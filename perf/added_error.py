"""What a precision adds to a network's roll-out error, on held-out motion.

usage: added_error.py WEIGHTS.safetensors DATA BODY [TICKS]
WEIGHTS come from a training run on DATA (`baker/train`), BODY is one of its bodies. int8 takes its scales from the
first training sequence. For each test sequence, over TICKS (50), one region's roll-out: mean distance to the ground
truth in each precision as a share of float32's, and mean distance between the two roll-outs as such a share.
SINEW_BAKE names the program (build/release/bin/sinew-bake). Needs PyTorch.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "baker"))

from train import dataset  # noqa: E402
from train.export import check_vectors  # noqa: E402
from train.safetensors import save  # noqa: E402
from train.weights import read_weights  # noqa: E402

BAKE = os.environ.get("SINEW_BAKE", str(HERE.parent / "build/release/bin/sinew-bake"))


def true_outputs(weights, trajectory, ticks, nodes):
    """The ground truth as the network would give it: (T, n, 3) in length units, after each tick."""
    group, scaling = dataset.group([("", trajectory)])[0], read_weights(weights)[1]
    unit = float(scaling.length_unit * group.radius[0])
    return (group.displacement[0, 1 : ticks + 1, :nodes] / unit).numpy()


def mean_error(model, vectors):
    report = subprocess.run([BAKE, "check", model, vectors, "--tolerance", "1e9"], capture_output=True, text=True)
    if report.returncode == 2:
        sys.exit(report.stderr)
    return json.loads(report.stdout)["mean_abs_error"]


def main(weights, data, body, ticks=50):
    ticks = int(ticks)
    with tempfile.TemporaryDirectory() as folder:
        place = lambda name: os.path.join(folder, name)  # noqa: E731
        kind = {"sinew.vectors": "alt_conv_lstm"}
        save(place("calibrate"), check_vectors(weights, dataset.read_split(data, "train", body)[0][1]), kind)
        for precision in ("fp32", "fp16", "int8"):
            scales = ["--calibrate", place("calibrate")] if precision == "int8" else []
            subprocess.run([BAKE, "model", weights, "-o", place(precision), "--precision", precision, *scales], check=True)
        print("| sequence | precision | error, share of float32's | distance to float32's roll-out, share of its error |")
        print("|---|---|---|---|")
        for name, trajectory in dataset.read_split(data, "test", body):
            own = check_vectors(weights, trajectory, ticks)
            save(place("own"), own, kind)
            save(place("true"), {**own, "y": true_outputs(weights, trajectory, ticks, own["y"].shape[1])}, kind)
            whole = mean_error(place("fp32"), place("true"))
            for precision in ("fp16", "int8"):
                error, off = (mean_error(place(precision), place(of)) / whole for of in ("true", "own"))
                print(f"| {os.path.basename(name)} | {precision} | {error:.4f} | {off:.4f} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
