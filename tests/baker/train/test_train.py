"""Training learns, goes on after it was cut, and is judged against springs that are what they claim to be."""
import math
import os
import tempfile
import unittest

import support

support.leave_without_torch()
import torch  # noqa: E402

from train import blas, dataset  # noqa: E402
from train.baselines import Springs, fit_springs, forces  # noqa: E402
from train.evaluate import evaluate  # noqa: E402
from train.export import check_vectors  # noqa: E402
from train.rollout import error_ratio, roll_out, truth  # noqa: E402
from train.train import Trainer, train  # noqa: E402
from train.train_options import TrainOptions  # noqa: E402
from train.weights import read_weights  # noqa: E402

QUIET = lambda *a, **k: None
SMALL = dict(channels=(16, 3), batch=6, window=15)


class Training(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        support.write_data_set(cls.folder.name)
        cls.run_folder = os.path.join(cls.folder.name, "run")
        cls.log = []
        torch.set_num_threads(1)
        train(
            cls.folder.name,
            cls.run_folder,
            TrainOptions(minutes=0.15, **SMALL),
            lambda text, **k: cls.log.append(text),
        )

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_few_seconds_already_beat_skinning_alone(self):
        metrics, _ = evaluate(os.path.join(self.run_folder, "weights.safetensors"), self.folder.name)
        self.assertLess(metrics["roll_out"]["50"]["network"]["ratio"], 0.9)
        self.assertEqual(metrics["roll_out"]["50"]["skinning"]["ratio"], 1)

    def test_a_finished_run_is_not_trained_again(self):
        log = []
        train(
            self.folder.name,
            self.run_folder,
            TrainOptions(minutes=0.15, **SMALL),
            lambda text, **k: log.append(text),
        )
        self.assertIn("goes on from", log[0])
        self.assertLessEqual(len(log), 3)

    def test_a_cut_run_goes_on_with_the_same_weights_and_moments(self):
        groups = [dataset.group(dataset.read_split(self.folder.name, s)) for s in ("train", "validation")]
        options = TrainOptions(minutes=1, **SMALL)
        first = Trainer(*groups, options, QUIET)
        first.update(first.new_episode())
        saved = first.checkpoint()
        second = Trainer(*groups, options, QUIET)
        second.resume(saved)
        losses = [trainer.update(trainer.new_episode()) for trainer in (second,)]
        torch.set_rng_state(saved["random"])
        losses += [first.update(first.new_episode())]
        self.assertEqual(*losses)
        for a, b in zip(first.model.parameters(), second.model.parameters()):
            self.assertTrue(torch.equal(a, b))

    def test_weights_come_back_from_their_file_and_predict_the_same(self):
        model, scaling, metadata = read_weights(os.path.join(self.run_folder, "weights.safetensors"))
        self.assertEqual(metadata["seed"], "0")
        (group,) = dataset.group(dataset.read_split(self.folder.name, "validation"))
        ratio = error_ratio(roll_out(model, scaling, group), truth(group), 50)
        line = [text for text in self.log if "validation ratio" in text]
        self.assertTrue(any(f"50: {ratio:.3f}" in text for text in line))

    def test_check_vectors_are_the_networks_own_roll_out(self):
        path = os.path.join(self.run_folder, "weights.safetensors")
        trajectory = dataset.read_split(self.folder.name, "validation")[0]
        vectors = check_vectors(path, trajectory, 30)
        model, scaling, _ = read_weights(path)
        (group,) = dataset.group([trajectory])
        y = roll_out(model, scaling, group, 30)[1:, :12, 0] / scaling.length_unit_m
        self.assertEqual(vectors["z"].shape, (30, 12, 34))
        self.assertFalse(vectors["z"][..., 28:].any())
        self.assertLess(float((y - torch.tensor(vectors["y"])).abs().max()), 1e-4)

    def test_mirrored_sequences_are_mirror_images(self):
        groups = [dataset.group(dataset.read_split(self.folder.name, s)) for s in ("train", "validation")]
        trainer = Trainer(*groups, TrainOptions(overdrive=0, stillness=0, **SMALL), QUIET)
        episode = trainer.new_episode()
        episode.sign = episode._mirror_signs(torch.tensor([True, False] * 3))
        episode.sequences[:] = 0
        episode.starts[:] = 20
        drive, u = episode.next_window()
        flip = torch.tensor([-1.0, 1, 1])
        self.assertTrue(torch.equal(u[:, :, :, 0], u[:, :, :, 1] * flip))
        self.assertTrue(torch.equal(drive[..., 0, 12:15], -drive[..., 1, 12:15] * flip))  # a rotation vector
        # the force of the turn, -alpha x r, must be the mirror image of itself
        self.assertTrue(torch.equal(drive[..., 0, 3:6], drive[..., 1, 3:6] * flip))


class SpringFit(unittest.TestCase):
    def test_recovers_the_spring_that_made_the_data(self):
        with tempfile.TemporaryDirectory() as folder:
            support.write_data_set(folder)
            (group,) = dataset.group(dataset.read_split(folder, "train"))
        made = Springs(group, False)
        made.log_w.data.fill_(math.log(2 * math.pi * 2.5))
        made.logit_zeta.data.fill_(-1.5)
        group.displacement = made.predict(group).permute(2, 0, 1, 3).contiguous()
        fitted = fit_springs(group, False)
        self.assertLess(error_ratio(fitted.predict(group), truth(group), group.ticks), 0.05)
        self.assertLess(float((fitted.log_w - made.log_w).abs().median()), 0.02)

    def test_is_stable_whatever_its_parameters(self):
        with tempfile.TemporaryDirectory() as folder:
            support.write_data_set(folder, 1, 1, 1)
            (group,) = dataset.group(dataset.read_split(folder, "train"))
        springs = Springs(group, True)
        for p in springs.parameters:
            p.data.normal_(0, 6)
        a, b, c, d, _ = springs._transition()
        radius = (
            torch.linalg.eigvals(torch.stack([torch.stack([a, b], -1), torch.stack([c, d], -1)], -2).detach())
            .abs()
            .max()
        )
        self.assertLessEqual(float(radius), 1 + 1e-5)

    def test_a_constant_force_is_not_extrapolated_away(self):
        drive = torch.ones(5, 2, 1, 21)
        self.assertTrue(torch.equal(forces(drive, False), torch.full((1, 5, 2, 1, 3), 5.0)))


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
