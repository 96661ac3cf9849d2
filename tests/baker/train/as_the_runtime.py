"""The trainer's roll-out is the runtime's: over 200 ticks in which the budget of corrections, the limit of what is shown
and swings and the envelope of inputs each act."""
import json
import os
import subprocess
import sys
import tempfile

import support

support.leave_without_torch()
import numpy as np  # noqa: E402
import torch  # noqa: E402

from train.data import dataset  # noqa: E402
from train.data.trajectory import read_trajectory  # noqa: E402
from train.files.safetensors import load  # noqa: E402
from train.learn.scaling import measure_scaling  # noqa: E402
from train.model import correction, modal_base, rollout  # noqa: E402
from train.model.alt_conv_lstm import AltConvLSTM, ModelOptions  # noqa: E402
from train.model.inputs import INPUT_WIDTH  # noqa: E402
from train.model.limit import FREE_SHARE  # noqa: E402
from train.model.weights import save_weights  # noqa: E402

TICKS = 200
NEAR = 1e-4  # of the region's radius; one float's rounding, fed back by a network
TISSUE = {"voxels_high": 16, "nodes_per_region": 10}
LIMIT = 0.15  # of the radius: the truth of this motion goes more than twice as far


def expect(good, *what):
    if not good:
        sys.exit(" ".join(map(str, what)))


class Watched:
    """A function that remembers what it gave."""

    def __init__(self, function):
        self.function, self.given = function, []

    def __call__(self, *arguments):
        out = self.function(*arguments)
        self.given.append(out)
        return out


def made(bake, folder):
    """A coarse creature with tight limits: its glTF, recipe and a motion of it."""
    place = lambda name: os.path.join(folder, name)
    with open(support.ROOT / "assets" / "creature" / "creature.json") as file:
        creature = {**json.load(file), "vertices": 500}
    with open(support.ROOT / "assets" / "creature" / "tissue.json") as file:
        tissue = {**json.load(file), **TISSUE}
    for region in tissue["regions"]:
        region["max_displacement"] = LIMIT
    for name, value in (("creature.json", creature), ("tissue.json", tissue)):
        with open(place(name), "w") as file:
            json.dump(value, file)
    run(bake, "creature", place("creature.json"), "-o", place("c.glb"))
    how = ["--recipe", place("tissue.json"), "--motion", "random", "--seed", "7", "--strength", "1", "--seconds", "3.5"]
    run(bake, "truth", place("c.glb"), *how, "-o", place("t.safetensors"))
    return place


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    expect(done.returncode == 0, *command, done.returncode, done.stdout, done.stderr)
    return done.stdout


def loud_network(group):
    """Untrained, louder than any trained one, and of an envelope that this motion leaves now and then."""
    torch.manual_seed(3)
    model = AltConvLSTM(ModelOptions(INPUT_WIDTH, (6, 3), True, 0.15, 0.0, 0.2, 8.0)).eval()
    scaling = measure_scaling([group])
    for name in ("felt_step", "angular_velocity"):
        scaling.envelope[name] *= 0.5
    return model, scaling


def main(bake):
    with tempfile.TemporaryDirectory() as folder:
        place = made(bake, folder)
        motion = read_trajectory(place("t.safetensors"))
        model, scaling = loud_network(dataset.group([("", motion)])[0])
        save_weights(place("w.safetensors"), model, scaling, 60, {})
        characters = [place("base.sinew"), place("network.sinew")]
        for path, tissue in zip(characters, ([], ["--tissue", place("w.safetensors")])):
            run(bake, "character", place("c.glb"), "--recipe", place("tissue.json"), *tissue, "--quick", "-o", path)
        told = json.loads(run(bake, "info", characters[0], "--json"))
        judge = ["--truth", place("t.safetensors"), "--ticks", str(TICKS), "--trace", place("trace.safetensors")]
        said = json.loads(run(bake, "judge", *characters, *judge, "--json"))
        trace = load(place("trace.safetensors"))[0]
        limits = [region["displacement_limit_m"] for region in told["regions"]]
        (group,) = dataset.group([("", motion)], limits=limits)

        correction.bounded_share, rollout.trust = Watched(correction.bounded_share), Watched(rollout.trust)
        modal_base.swing_share = Watched(modal_base.swing_share)
        for k, network in enumerate((None, model)):
            u = rollout.roll_out(network, scaling, group, TICKS)[:, :, 0]
            apart = (u - torch.tensor(np.array(trace[f"displacement.{k}"]))).abs() / group.radius_m()[:, None]
            ratio = rollout.error_ratio(u[:, :, None], rollout.truth(group), TICKS)
            judged = said["characters"][k]["ticks"][str(TICKS)]["ratio"]
            print(f"character {k}: {float(apart.max()):.1e} of the radius apart; error {ratio:.4f}, judged {judged:.4f}")
            expect(float(apart.max()) < NEAR, "not the runtime's roll-out")
            expect(abs(ratio / judged - 1) < 1e-3, "not the error that is judged")

        shares, trusts = torch.stack(correction.bounded_share.given), torch.stack(rollout.trust.given)
        reach = torch.stack([u[:, group.body.region == r].norm(dim=-1).amax() for r in range(group.regions)])
        held = float((reach / torch.tensor(limits)).max())
        acted = lambda values: float((values < 1).float().mean())
        print(f"of region ticks {acted(shares):.2f} are short of budget, {acted(trusts):.2f} of trust; limits {held:.2f} full")
        expect(0.01 < acted(shares) < 1 and 0.01 < acted(trusts) < 1, "budget or envelope did not act")
        expect(held > FREE_SHARE + 0.1, "no limit acted on what is shown")
        expect(acted(torch.stack(modal_base.swing_share.given)) > 0.001, "no limit acted on what swings")


if __name__ == "__main__":
    main(sys.argv[1])
