"""Patches of simulated bodies: what is fed of them, the network that is fed, and what is refused."""
import json
import os
import tempfile
import unittest

import support

support.leave_without_torch()
import torch  # noqa: E402

import numpy as np  # noqa: E402
from train.files.safetensors import BadData, save  # noqa: E402
from train.patches.data import patches_of, read_run, take_step  # noqa: E402
from train.patches.export import errors_of, read_network  # noqa: E402
from train.patches.model import Scaled, glance  # noqa: E402
from train.patches.train import PatchTrainOptions, PatchTrainer, train_patches  # noqa: E402


def body(ticks=40, speed=(0.3, 0, 0), turn=0.02, seed=0):
    """A made-up run: three nodes in a row and one above, the first held; displacement swings."""
    random = np.random.default_rng(seed)
    rest = np.array([[0, 0, 0], [0, 1, 0], [0, 2, 0], [1, 1, 0]], np.float32)
    t = np.arange(ticks + 1)
    turns = np.stack([[[np.cos(turn * k), -np.sin(turn * k), 0], [np.sin(turn * k), np.cos(turn * k), 0], [0, 0, 1]] for k in t])
    swing = 0.1 * np.sin(0.3 * t + random.random())[:, None, None] * random.normal(size=(1, 4, 3))
    swing[:, 0] = 0
    return {
        "rest": rest,
        "place": (t[:, None] * np.array(speed)).astype(np.float32),
        "turn": turns.reshape(-1, 9).astype(np.float32),
        "displacement": swing.astype(np.float32),
        "material": np.tile(np.array([1.0, 1.0, 1.0], np.float32), (4, 1)),
        "constrained": np.array([1, 0, 0, 0], np.int32),
        "edges": np.array([[0, 1], [1, 2], [1, 3]], np.int32),
    }


ABOUT = {"rate_hz": 60, "integrator": "bdf2", "substeps": 4, "damping_ratio": 0.1, "shape": "made up"}


def written(folder, tensors, name="made-train-1"):
    path = os.path.join(folder, f"{name}.safetensors")
    save(path, tensors, ABOUT)
    return path


class Patches(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def test_what_is_fed_does_not_change_with_the_speed_of_the_whole(self):
        still, fast = (read_run(written(self.folder.name, body(speed=s), f"made-train-{k}")) for k, s in enumerate([(0, 0, 0), (9, -2, 4)]))
        for a, b in zip(vars(patches_of(still, 20, still.free)).values(), vars(patches_of(fast, 20, fast.free)).values()):
            # Places of 200 cells are floats in the file.
            self.assertTrue(torch.allclose(a.double(), b.double(), atol=1e-4))

    def test_the_true_answer_takes_the_step_to_the_truth(self):
        run = read_run(written(self.folder.name, body()))
        patches = patches_of(run, 10, run.free)
        stepped = take_step(run, 10, patches.answer, run.moving(10))
        self.assertLess(float((stepped - run.moved(11)).abs().max()), 1e-6)
        self.assertLess(float((run.posed(11)[run.free] - read_run(written(self.folder.name, body())).posed(11)[run.free]).abs().max()), 1e-12)

    def test_a_patch_says_its_strain_at_a_glance(self):
        run = read_run(written(self.folder.name, body()))
        patches = patches_of(run, 10, run.free)
        seen = patches.patch @ glance(True).T
        node, other = 1, 2  # the second of the first free node's neighbours
        edge = [int(run.columns[k]) for k in range(int(run.rows[node]), int(run.rows[node + 1]))].index(other)
        u = run.moved(10)
        want = ((u[other] - u[node]) - (run.posed(10)[other] - run.posed(10)[node])) @ run.turn[11]
        self.assertTrue(torch.allclose(seen[edge, 15:18].double(), want, atol=1e-5))

    def test_exported_weights_answer_as_the_trained_ones(self):
        torch.manual_seed(1)
        run = read_run(written(self.folder.name, body()))
        patches = patches_of(run, 10, run.free)
        model = Scaled(16)
        model.fit(patches.centre, patches.material, patches.patch, patches.answer)
        with torch.no_grad():
            a = model(patches.centre, patches.material, patches.patch, patches.owner)
            b = model.absorbed()(patches.centre, patches.material, patches.patch, patches.owner)
        self.assertLess(float((a - b).abs().max()), 1e-4 * float(a.abs().max()) + 1e-6)

    def write_runs(self):
        for split in ("train", "validation"):
            for seed in range(3):
                written(self.folder.name, body(seed=seed), f"made-{split}-{seed + 10 * (split == 'validation')}")
        return os.path.join(self.folder.name, "run")

    def test_seconds_of_roll_outs_bring_them_nearer_to_the_truth(self):
        out = self.write_runs()
        train_patches(self.folder.name, out, PatchTrainOptions(minutes=0.1, ticks=4, patches=16, rolled_share=1), log=lambda text: None)
        with open(os.path.join(out, "curve.json"), encoding="utf-8") as f:
            rolled = [point["rolled_48"] for point in json.load(f)["curve"]]
        self.assertLess(min(rolled), 0.5 * rolled[0])

    def test_seconds_of_training_leave_less_than_going_on_does(self):
        out = self.write_runs()
        options = PatchTrainOptions(minutes=0.15, ticks=4, patches=16, noise=0.0, rolled_share=0)
        train_patches(self.folder.name, out, options, log=lambda text: None)
        model, metadata = read_network(os.path.join(out, "weights.safetensors"))
        self.assertEqual((metadata["frame"], metadata["latent"]), ("going_on", "16"))
        run = read_run(written(self.folder.name, body(seed=5), "made-test-5"))
        ours, _ = errors_of(model, run)
        going_on, _ = errors_of(lambda c, *_: torch.zeros(len(c), 3), run)
        self.assertLess(ours.mean(), 0.5 * going_on.mean())

    def test_bad_runs_and_options_are_refused_in_one_line(self):
        nan, short, missing = body(), body(), body()
        nan["displacement"][3, 1, 1] = np.nan
        short["turn"] = short["turn"][:-1]
        del missing["place"]
        for tensors, words in ((nan, "holds a NaN"), (short, "tensor turn is"), (missing, "tensor place is missing")):
            with self.assertRaisesRegex(BadData, words) as caught:
                read_run(written(self.folder.name, tensors))
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaisesRegex(BadData, "no run of split train"):
            PatchTrainer(tempfile.gettempdir(), PatchTrainOptions())
        for wrong in ({"latent": 20}, {"minutes": 0}, {"noise": -1}, {"rolled_share": 2}, {"rolled_ticks": 2}):
            with self.assertRaises(BadData):
                PatchTrainOptions(**wrong).check()
        self.write_runs()
        with self.assertRaisesRegex(BadData, "--rolled-ticks 60: the shortest run .* has 40 ticks"):
            PatchTrainer(self.folder.name, PatchTrainOptions(rolled_ticks=60))
        with self.assertRaisesRegex(BadData, "is not deep_emulator"):
            read_network(written(self.folder.name, body()))


if __name__ == "__main__":
    unittest.main()
