"""Training learns what the modal base does not know, goes on after it was cut, and feeds what it says."""
import json
import os
import tempfile
import unittest

import support

support.leave_without_torch()
import numpy as np  # noqa: E402
import torch  # noqa: E402

import synthetic  # noqa: E402
from train import blas  # noqa: E402
from train.data import dataset  # noqa: E402
from train.data.dataset import Union  # noqa: E402
from train.files.safetensors import BadData  # noqa: E402
from train.judge.export import check_vectors  # noqa: E402
from train.learn.episode import Episode  # noqa: E402
from train.learn.options import TrainOptions  # noqa: E402
from train.learn.scaling import ENVELOPE_MARGIN, SCALED_SIZE, measure_scaling  # noqa: E402
from train.learn.train import Trainer, train  # noqa: E402
from train.model.inputs import FEEDBACK, INPUT_WIDTH, ORDER, columns  # noqa: E402
from train.model.rollout import bounded, error_ratio, roll_out, truth  # noqa: E402
from train.model.weights import BASE, read_weights  # noqa: E402

QUIET = lambda *a, **k: None
SMALL = dict(channels=(8, 3), batch=6, window=15, learning_rate=1e-2)
MINUTES, UPDATES = 0.06, 100  # by their number: in a time a slow machine learns less


class Killed(Exception):
    pass


class Training(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        torch.set_num_threads(1)
        cls.folder = tempfile.TemporaryDirectory()
        support.write_data_set(cls.folder.name, bend_share=0.0)
        cls.run_folder, cls.log = os.path.join(cls.folder.name, "run"), []
        cls.train(cls.run_folder, cls.log)
        cls.groups = [dataset.group(dataset.read_split(cls.folder.name, s)) for s in ("train", "validation")]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def train(cls, out, log):
        options = TrainOptions(minutes=MINUTES, updates=UPDATES, **SMALL)
        return train(cls.folder.name, out, options, lambda text, **k: log.append(text))

    def trainer(self, **options):
        return Trainer(*self.groups, TrainOptions(minutes=1, **{**SMALL, **options}), QUIET)

    def same_weights(self, a, b):
        return all(torch.equal(x, y) for x, y in zip(a.model.parameters(), b.model.parameters()))

    def test_options_that_cannot_be_trained_with_are_refused_by_name(self):
        unusable = {
            "channels": [(), (8, 8), (0, 3), ("abc",)],
            "minutes": [0, -1, float("nan"), float("inf")],
            "updates": [-1, 0.5],
            "batch": [0],
            "window": [0],
            "learning_rate": [0, float("nan"), float("inf")],
            "hidden_leak": [-0.1, 1.1],
            "output_scale": [0, float("inf")],
            "state_clamp": [0],
            "stillness": [-0.1, 2],
            "without": [("colour",)],
            "form": ["LSTM"],
        }
        for name, values in unusable.items():
            for value in values:
                with self.assertRaises(BadData, msg=f"{name} {value}") as caught:
                    train(self.folder.name, self.run_folder, TrainOptions(**{name: value}), QUIET)
                self.assertIn("--" + name.replace("_", "-"), str(caught.exception))

    def test_so_many_updates_are_made_however_long_they_take(self):
        with open(os.path.join(self.run_folder, "curve.json")) as file:
            self.assertEqual(json.load(file)["curve"][-1]["updates"], UPDATES)

    def test_a_few_seconds_already_beat_the_modal_base(self):
        model, scaling, _ = read_weights(os.path.join(self.run_folder, "weights.safetensors"))
        (group,) = self.groups[1]
        base = error_ratio(roll_out(None, None, group), truth(group), group.ticks)
        self.assertGreater(base, 0.2)  # there is something to learn
        self.assertLess(error_ratio(roll_out(model, scaling, group), truth(group), group.ticks), 0.7 * base)

    def test_an_untrained_network_is_nearly_the_modal_base(self):
        trainer, (group,) = self.trainer(), self.groups[1]
        base, ours = roll_out(None, None, group), roll_out(trainer.model, trainer.scaling, group)
        self.assertLess(float((ours - base).norm(dim=-1).mean() / base.norm(dim=-1).mean()), 0.3)

    def test_the_same_seed_trains_the_same_network_and_another_another(self):
        trainers = [self.trainer(seed=seed) for seed in (3, 3, 4)]
        losses = []
        for trainer, seed in zip(trainers, (3, 3, 4)):
            torch.manual_seed(seed)
            episode = trainer.new_episode()
            losses.append([trainer.update(episode) for _ in range(3)])
        self.assertEqual(losses[0], losses[1])
        self.assertTrue(self.same_weights(*trainers[:2]))
        self.assertFalse(self.same_weights(*trainers[1:]))

    def test_a_cut_run_goes_on_with_the_same_weights_moments_and_draws(self):
        """From a checkpoint on, a new episode's updates are the uninterrupted run's. (An episode that a kill
        cuts is not gone on with, and the rate follows the clock.)"""
        first, second = self.trainer(), self.trainer()
        first.update(first.new_episode())
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "checkpoint.pt")
            torch.save(first.checkpoint(), path)
            losses = [first.update(first.new_episode())]
            second.resume(torch.load(path))
        losses.append(second.update(second.new_episode()))
        self.assertEqual(*losses)
        self.assertTrue(self.same_weights(first, second))

    def test_a_killed_run_is_gone_on_with_where_it_was_last_judged(self):
        out, judged = os.path.join(self.folder.name, "killed"), []
        options = TrainOptions(minutes=0.02, **SMALL)

        def kill(text, **k):
            judged.append(text)
            if sum("validation ratio" in line for line in judged) == 2:
                raise Killed

        with self.assertRaises(Killed):
            train(self.folder.name, out, options, kill)
        self.assertFalse(os.path.exists(os.path.join(out, "weights.safetensors")))
        kept, log = torch.load(os.path.join(out, "checkpoint.pt")), []
        done = train(self.folder.name, out, options, lambda text, **k: log.append(text))
        self.assertIn("goes on from", log[0])
        self.assertGreater(done.updates, kept["updates"])
        self.assertEqual(done.curve[: len(kept["curve"])], kept["curve"])
        self.assertTrue(os.path.exists(os.path.join(out, "weights.safetensors")))

    def test_a_finished_run_is_not_trained_again(self):
        log = []
        updates = self.train(self.run_folder, log).updates
        self.assertIn("goes on from", log[0])
        with open(os.path.join(self.run_folder, "curve.json")) as file:
            self.assertEqual(json.load(file)["curve"][-1]["updates"], updates)

    def test_a_run_of_another_recipe_starts_anew(self):
        trainer, log = self.trainer(), []
        out = os.path.join(self.folder.name, "other")
        os.makedirs(out)
        torch.save(trainer.checkpoint(), os.path.join(out, "checkpoint.pt"))
        train(self.folder.name, out, TrainOptions(minutes=0.005, **SMALL), lambda t, **k: log.append(t))
        self.assertFalse(any("goes on from" in text for text in log))

    def test_a_sequence_that_is_lost_starts_anew(self):
        trainer = self.trainer()
        episode = trainer.new_episode()
        trainer.update(episode)
        episode.state.base.l[:, :, 2] = float("nan")
        episode.state.base.q[:, :, 2] = float("nan")
        episode.state.base.l[:, :, 4] = 1e3
        state = trainer._without_the_lost(episode)
        for b in (2, 4):
            self.assertEqual(float(state.base.l[:, :, b].abs().max() + state.base.q[:, :, b].abs().max()), 0)
        self.assertGreater(float(state.base.u[:, :, 1].abs().max()), 0)
        self.assertTrue(np.isfinite(trainer.update(episode)))

    def test_weights_come_back_from_their_file_and_predict_the_same(self):
        model, scaling, metadata = read_weights(os.path.join(self.run_folder, "weights.safetensors"))
        said = {"seed": "0", "base": BASE, "frame": "bent"}
        self.assertEqual({k: metadata[k] for k in said}, said)
        (group,) = self.groups[1]
        ratio = error_ratio(roll_out(model, scaling, group), truth(group), 50)
        judged = [text for text in self.log if "validation ratio" in text]
        self.assertTrue(any(f"50: {ratio:.3f}" in text for text in judged), (ratio, judged))

    def test_check_vectors_are_the_networks_own_roll_out(self):
        path = os.path.join(self.run_folder, "weights.safetensors")
        _, trajectory = dataset.read_split(self.folder.name, "validation")[0]
        vectors = check_vectors(path, trajectory, 30)
        model, scaling, _ = read_weights(path)
        (group,) = dataset.group([("", trajectory)])
        n = synthetic.SIZES[0]
        told = {k: torch.tensor(vectors[k])[:, None, :, None] for k in ("z", "carry")}
        y = y_before = torch.tensor(vectors["y0"])[None, :, None]
        memory, packed, P = model.zero_state(1, n, 1), model.packed(), group.P[:1, :n, :n]
        with torch.no_grad():
            for z, carry, want in zip(told["z"], told["carry"], vectors["y"]):
                for name, fed in zip(FEEDBACK, (y, y - y_before)):
                    z[..., columns(name)] = bounded(fed, name, scaling)
                (y, memory), y_before = model.step(packed, P, z, memory, y, carry), y
                self.assertLess(float((y[0, :, 0] - torch.tensor(want)).abs().max()), 1e-4)  # double against float
        self.assertGreater(float(y.abs().max()), 0.3)
        self.assertEqual(vectors["y0"].any(), False)
        vectors = check_vectors(path, trajectory, 30)
        self.assertEqual(vectors["z"].shape, (30, n, INPUT_WIDTH))
        for name in FEEDBACK:
            self.assertFalse(vectors["z"][..., columns(name)].any())
        self.assertEqual(vectors["carry"].shape, (30, n, 3))
        self.assertTrue((vectors["edges"] < n).all())


class Scales(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.group = support.synthetic_group((0, 1), ticks=60)
        cls.scaling = measure_scaling([cls.group])

    def test_a_scaled_input_is_of_even_size_and_fits_its_envelope(self):
        name, s = "angular_velocity", torch.tensor([0, 1])
        _, drive, _, _ = self.group.window(s, s * 0, 60)
        raw = drive[..., 6:9][:, self.group.mask]
        scaled = bounded(raw, name, self.scaling)
        self.assertAlmostEqual(float(scaled.abs().mean()), SCALED_SIZE, delta=0.05 * SCALED_SIZE)  # rounding
        self.assertTrue(torch.equal(scaled, raw * self.scaling.scale[name]))
        self.assertAlmostEqual(
            float(scaled.abs().max()) * ENVELOPE_MARGIN, self.scaling.envelope[name], places=3
        )

    def test_what_leaves_the_envelope_is_held_at_it(self):
        for name in ORDER:
            most = np.float32(self.scaling.envelope[name])
            self.assertEqual(bounded(torch.tensor([1e9, -1e9]), name, self.scaling).tolist(), [most, -most])


class Episodes(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(0)
        self.group = support.synthetic_group((0, 1), ticks=500)
        self.scaling = measure_scaling([self.group])
        self.bodies = Union([self.group])

    def episode(self, stillness=0.0):
        trained = TrainOptions(batch=2, window=20, stillness=stillness)
        return Episode(self.bodies, self.scaling, trained, None, [torch.tensor([[1.0, 4], [2, 2]])])

    def test_sequences_are_the_data(self):
        episode = self.episode()
        felt, drive, turn, u = episode.next_window()
        want = self.bodies.window(episode.sequences, torch.zeros(2, dtype=torch.long), 20)
        for found, k in ((felt, 0), (drive, 1), (u, 3)):
            self.assertTrue(torch.equal(found, want[k]))
        self.assertTrue(torch.equal(turn[0], want[2][0]) and torch.equal(turn[1], want[2][1]))

    def test_still_sequences_feel_nothing_and_rest(self):
        felt, drive, turn, u = self.episode(stillness=1.0).next_window()
        self.assertEqual(float(felt.abs().max() + drive.abs().max() + u.abs().max()), 0)
        self.assertTrue(torch.equal(turn[0], torch.eye(3).expand_as(turn[0])))

    def test_errors_count_as_their_sequence_says(self):
        episode = self.episode()
        first, second = (episode.weight[:, 0, episode.sequences[0] == s][:, 0].tolist() for s in (0, 1))
        self.assertEqual((first, second), ([1, 2], [4, 2]))

    def test_windows_follow_each_other_to_the_end(self):
        episode, felt = self.episode(), []
        while episode.ticks_left() > 0:
            felt.append(episode.next_window()[0])
        want = self.bodies.window(episode.sequences, torch.zeros(2, dtype=torch.long), self.bodies.ticks)[0]
        self.assertTrue(torch.equal(torch.cat(felt), want))


class Kernels(unittest.TestCase):
    def test_a_processor_with_avx512_gets_the_kernels_that_suit_it(self):
        environment = {}
        blas.choose(environment, {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl", "fma"})
        self.assertEqual(environment["OPENBLAS_CORETYPE"], "SkylakeX")

    def test_others_are_left_alone_and_so_is_a_callers_choice(self):
        environment = {}
        blas.choose(environment, {"avx2", "fma"})
        self.assertNotIn("OPENBLAS_CORETYPE", environment)
        environment = {"OPENBLAS_CORETYPE": "Zen"}
        blas.choose(environment, {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"})
        self.assertEqual(environment["OPENBLAS_CORETYPE"], "Zen")


if __name__ == "__main__":
    unittest.main()
