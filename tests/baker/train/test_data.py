"""Broken data is refused by name before training starts; good data comes out as it went in."""
import json
import os
import tempfile
import unittest

import support

support.leave_without_torch()
import numpy as np  # noqa: E402
import torch  # noqa: E402

import synthetic  # noqa: E402
from train import dataset  # noqa: E402
from train.inputs import DRIVE, INPUT_WIDTH, ORDER  # noqa: E402
from train.model import normalized_adjacency  # noqa: E402
from train.safetensors import BadData, load, save  # noqa: E402
from train.train import train  # noqa: E402
from train.train_options import TrainOptions  # noqa: E402
from train.trajectory import read_trajectory  # noqa: E402


class Refusals(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self.folder.name, "one.safetensors")
        self.tensors, self.metadata = synthetic.trajectory(1, 40)

    def tearDown(self):
        self.folder.cleanup()

    def refused(self, *words):
        """The file is refused in one line that names it and says these words."""
        with self.assertRaises(BadData) as caught:
            read_trajectory(self.path)
        text = str(caught.exception)
        self.assertNotIn("\n", text)
        for word in (self.path, *words):
            self.assertIn(word, text)

    def write(self, **changes):
        save(self.path, {**self.tensors, **changes}, self.metadata)

    def test_a_missing_file(self):
        self.refused("No such file")

    def test_an_empty_file(self):
        open(self.path, "w").close()
        self.refused("not a safetensors file")

    def test_every_way_of_cutting_a_file_short(self):
        self.write()
        with open(self.path, "rb") as file:
            whole = file.read()
        for length in (1, 9, 200, len(whole) // 2, len(whole) - 1):
            with open(self.path, "wb") as file:
                file.write(whole[:length])
            self.refused("make")

    def test_a_number_that_is_none(self):
        displacement = self.tensors["displacement"].copy()
        displacement[7, 3, 1] = np.nan
        self.write(displacement=displacement)
        self.refused("displacement[7, 3, 1]")

    def test_another_version(self):
        self.metadata["sinew.trajectory"] = 2
        self.write()
        self.refused("version 2")

    def test_no_motion(self):
        self.write(displacement=np.zeros_like(self.tensors["displacement"]))
        self.refused("no motion")

    def test_a_missing_tensor(self):
        del self.tensors["drive"]
        self.write()
        self.refused("no tensor drive")

    def test_a_misshaped_tensor(self):
        self.write(drive=self.tensors["drive"][:, :, :20])
        self.refused("tensor drive is")

    def test_an_edge_to_a_node_that_is_not_there(self):
        self.write(edges=np.array([[0, 99]], np.int32))
        self.refused("tensor edges")

    def test_one_broken_file_stops_training_before_it_starts(self):
        folder = self.folder.name
        support.write_data_set(folder, 2, 1, 1, 40)
        path = os.path.join(folder, "1.safetensors")
        with open(path, "r+b") as file:
            file.truncate(os.path.getsize(path) - 8)
        out = os.path.join(folder, "run")
        with self.assertRaisesRegex(BadData, "1.safetensors"):
            train(folder, out, TrainOptions(minutes=1), log=lambda *a, **k: None)
        self.assertFalse(os.path.exists(out))

    def test_a_sheet_without_training_sequences(self):
        with open(os.path.join(self.folder.name, dataset.SHEET), "w") as file:
            json.dump({"sequences": []}, file)
        with self.assertRaisesRegex(BadData, "no train sequences"):
            dataset.read_split(self.folder.name, "train")

    def test_no_sheet_at_all(self):
        with self.assertRaisesRegex(BadData, "data_sheet.json"):
            dataset.read_split(self.folder.name, "train")


class Groups(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        support.write_data_set(self.folder.name, 3, 1, 1, 40)
        self.trajectories = dataset.read_split(self.folder.name, "train")
        (self.group,) = dataset.group(self.trajectories)

    def tearDown(self):
        self.folder.cleanup()

    def test_a_window_holds_what_the_files_hold(self):
        sequences, starts = torch.tensor([2, 0]), torch.tensor([5, 11])
        drive, u = self.group.window(sequences, starts, 7)
        flat = self.group.flatten(u)
        for b, (s, start) in enumerate(zip(sequences, starts)):
            want = self.trajectories[s].displacement[start : start + 8]
            np.testing.assert_array_equal(flat[:, :, b].numpy(), want)
        self.assertEqual(tuple(drive.shape), (8, 2, 12, 2, 21))

    def test_regions_of_different_sizes_are_padded_apart(self):
        trajectory = self.trajectories[0]
        keep = np.r_[0:12, 12:17]  # the second region loses seven nodes
        edges = trajectory.body.edges
        body = trajectory.body
        body.edges = edges[(edges < 17).all(1)]
        for name in ("rest_position", "rest_normal", "stiffness", "region"):
            setattr(body, name, getattr(body, name)[keep])
        trajectory.drive, trajectory.displacement = (
            trajectory.drive[:, keep],
            trajectory.displacement[:, keep],
        )
        (group,) = dataset.group([trajectory])
        self.assertEqual(group.mask.sum(1).tolist(), [12, 5])
        second = body.edges[(body.edges >= 12).all(1)] - 12
        np.testing.assert_allclose(
            group.P[1, :5, :5].numpy(), normalized_adjacency(5, second).numpy(), atol=1e-6
        )
        self.assertEqual(float(group.P[1, 5:].abs().max()), 0)

    def test_bodies_that_differ_get_groups_of_their_own(self):
        tensors, metadata = synthetic.trajectory(5, 40, body_seed=9)
        path = os.path.join(self.folder.name, "other.safetensors")
        save(path, tensors, metadata)
        self.assertEqual(len(dataset.group(self.trajectories + [read_trajectory(path)])), 2)

    def test_inputs_are_scaled_in_order_and_held_in_the_envelope(self):
        scaling = dataset.measure_scaling([self.group])
        drive, _ = self.group.window(torch.tensor([0]), torch.tensor([20]), 1)
        y = torch.full((2, 12, 1, 3), 1e6)
        z = dataset.input_columns(
            self.group.static_columns(scaling, 1), dataset.drive_columns(drive[1], scaling), y, y * 0, scaling
        )
        self.assertEqual(z.shape[-1], INPUT_WIDTH)
        self.assertEqual(float(z[..., -6].max()), np.float32(scaling.envelope["displacement"]))
        want = drive[1][..., DRIVE["angular_velocity"]] * scaling.scale["angular_velocity"]
        np.testing.assert_allclose(z[..., 22:25].numpy(), want.numpy(), rtol=1e-6)
        self.assertEqual(list(ORDER)[8], "angular_velocity")

    def test_a_container_comes_back_as_it_was_written(self):
        path = os.path.join(self.folder.name, "any.safetensors")
        a = {"x": np.arange(6, dtype=np.float16).reshape(2, 3), "y": np.array([[1, -2]], np.int32)}
        save(path, a, {"k": 3})
        b, metadata = load(path)
        self.assertEqual(metadata, {"k": "3"})
        for k in a:
            np.testing.assert_array_equal(a[k], b[k])


if __name__ == "__main__":
    unittest.main()
