"""Broken data is refused by name before training starts; good data comes out as it went in."""
import json
import os
import struct
import tempfile
import unittest

import support

support.leave_without_torch()
import numpy as np  # noqa: E402
import torch  # noqa: E402

import synthetic  # noqa: E402
from train.data import dataset  # noqa: E402
from train.data.dataset import Union  # noqa: E402
from train.data.trajectory import read_trajectory  # noqa: E402
from train.files.safetensors import BadData, load, save  # noqa: E402
from train.learn.options import TrainOptions  # noqa: E402
from train.learn.train import train  # noqa: E402
from train.model.alt_conv_lstm import normalized_adjacency  # noqa: E402
from train.model.inputs import FELT  # noqa: E402

TICKS = 40


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def place(self, name):
        return os.path.join(self.folder.name, name)


class Refusals(Folder):
    def setUp(self):
        super().setUp()
        self.path = self.place("one.safetensors")
        self.tensors, self.metadata = synthetic.trajectory(1, TICKS)

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

    def changed(self, name, place, value):
        a = self.tensors[name].copy()
        a[place] = value
        self.write(**{name: a})

    def write_header(self, header):
        text = json.dumps(header).encode()
        with open(self.path, "wb") as file:
            file.write(struct.pack("<Q", len(text)) + text + bytes(64))

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

    def test_headers_that_are_none(self):
        entry = {"dtype": "F32", "shape": [4], "data_offsets": [0, 16]}
        for header in (["drive"], 77, {"drive": entry, "__metadata__": 7}):
            self.write_header(header)
            self.refused("its header is not JSON")
        broken = [
            3,
            {"dtype": "F32"},
            {**entry, "data_offsets": [0]},
            {**entry, "data_offsets": ["a", "b"]},
            {**entry, "data_offsets": [-16, 0]},
            {**entry, "shape": [-4], "data_offsets": [16, 0]},
            {**entry, "shape": 4},
            {**entry, "shape": [5]},
            {**entry, "dtype": "F7"},
        ]
        for drive in broken:
            with self.subTest(drive=drive):
                self.write_header({"drive": drive})
                self.refused("tensor drive: its type, shape and size do not agree")

    def test_numbers_that_are_none(self):
        for name in ("drive", "rotation", "displacement"):
            self.changed(name, (7, 3, 1), np.nan)
            self.refused(f"{name}[7, 3, 1]")
        self.changed("modes.1.turn", (4, 2), np.inf)
        self.refused("modes.1.turn[4, 2]")

    def test_other_versions(self):
        for version in ("4", "6", ""):
            self.metadata["sinew.trajectory"] = version
            self.write()
            self.refused(f"version {version}", "reads 5")
        del self.metadata["sinew.trajectory"]
        self.write()
        self.refused("version None")

    def test_rates_that_are_none(self):
        for value in (None, "fast", "0", "-4", "nan"):
            with self.subTest(value=value):
                _, self.metadata = synthetic.trajectory(1, TICKS)
                self.metadata["rate_hz"] = value
                if value is None:
                    del self.metadata["rate_hz"]
                self.write()
                self.refused("rate_hz", "not a number above 0")

    def test_no_motion(self):
        self.write(displacement=np.zeros_like(self.tensors["displacement"]))
        self.refused("no motion")
        self.write(drive=np.zeros_like(self.tensors["drive"]))
        self.refused("no motion")
        self.write(**{k: self.tensors[k][:1] for k in ("drive", "rotation", "displacement")})
        self.refused("no motion")

    def test_missing_tensors(self):
        for name in self.tensors:
            with self.subTest(name=name):
                save(self.path, {k: v for k, v in self.tensors.items() if k != name}, self.metadata)
                self.refused("no tensor " + name)

    def test_misshaped_tensors(self):
        for name, a in self.tensors.items():
            if name in ("drive", "node.region", "region.radius_m", "edges"):  # these rule how long others are
                continue
            with self.subTest(name=name):
                self.write(**{name: a[:-1]})
                self.refused("tensor " + (name if len(a) > 1 or "rad" not in name else ""))
                self.write(**{name: a.ravel()})
                self.refused("tensor " + name)
        self.write(drive=self.tensors["drive"][:, :, :9])
        self.refused("tensor drive is")

    def test_edges_to_nodes_that_are_not_there(self):
        for edge in ((0, 99), (-1, 2)):
            self.write(edges=np.array([edge], np.int32))
            self.refused("tensor edges")

    def test_nodes_of_regions_that_are_not_there(self):
        region = self.tensors["node.region"]
        for broken in (region[::-1], region + 1, region - 1, region * 0, region * 0.5):
            self.write(**{"node.region": broken})
            self.refused("tensor node.region")

    def test_regions_without_size(self):
        for radius in (0, -1):
            self.write(**{"region.radius_m": np.array([0.1, radius], np.float32)})
            self.refused("tensor region.radius_m")

    def test_modes_that_are_none(self):
        broken = (("rad_per_s", 0), ("rad_per_s", -3), ("damping_ratio", -1), ("rest_oscillator", -1), ("first", -1))
        for name, value in broken:
            self.changed(f"modes.1.{name}", (0, 1), value)
            self.refused(f"modes.1.{name}")
        self.changed("modes.1.first", (0, 0), 0)
        self.refused("modes.1.first")
        self.write(**{"modes.0.rad_per_s": np.zeros((1, 0), np.float32)})
        self.refused("modes.0.rad_per_s")

    def test_one_broken_file_stops_training_before_it_starts(self):
        support.write_data_set(self.folder.name, 2, 1, 1, TICKS)
        path = self.place("1.safetensors")
        with open(path, "r+b") as file:
            file.truncate(os.path.getsize(path) - 8)
        with self.assertRaisesRegex(BadData, "1.safetensors"):
            train(self.folder.name, self.place("run"), TrainOptions(minutes=1), log=lambda *a, **k: None)
        self.assertFalse(os.path.exists(self.place("run")))


class Sheets(Folder):
    def refused(self, words, **sheet):
        with open(self.place(dataset.SHEET), "w") as file:
            json.dump(sheet, file)
        with self.assertRaisesRegex(BadData, words):
            dataset.read_split(self.folder.name, "train")

    def test_no_sheet_at_all(self):
        with self.assertRaisesRegex(BadData, "data_sheet.json"):
            dataset.read_split(self.folder.name, "train")

    def test_a_sheet_without_training_sequences(self):
        self.refused("no train sequences", sequences=[])

    def test_sheets_that_are_none(self):
        self.refused("unusable data sheet", sequences=[{"split": "train"}])
        self.refused("unusable data sheet", sequences=3)
        self.refused("unusable data sheet", bodies=[])

    def test_sequences_of_several_rates(self):
        tensors, metadata = synthetic.trajectory(1, TICKS)
        sequences = []
        for rate_hz in (30, 60):
            save(self.place(f"{rate_hz}.safetensors"), tensors, {**metadata, "rate_hz": rate_hz})
            sequences.append({"file": f"{rate_hz}.safetensors", "split": "train"})
        self.refused("several rate_hz", sequences=sequences)

    def test_one_body_may_be_asked_for(self):
        support.write_data_set(self.folder.name, 2, 1, 1, TICKS)
        self.assertEqual(len(dataset.read_split(self.folder.name, "train", support.BODY)), 2)
        with self.assertRaisesRegex(BadData, "no train sequences"):
            dataset.read_split(self.folder.name, "train", "another")


class Groups(Folder):
    def setUp(self):
        super().setUp()
        support.write_data_set(self.folder.name, 3, 1, 1, TICKS)
        self.named = dataset.read_split(self.folder.name, "train")
        (self.group,) = dataset.group(self.named)

    def test_a_window_holds_what_the_files_hold(self):
        sequences, starts = torch.tensor([2, 0]), torch.tensor([5, 11])
        felt, drive, turn, u = self.group.window(sequences, starts, 7)
        for b, (s, start) in enumerate(zip(sequences.tolist(), starts.tolist())):
            t = self.named[s][1]
            ticks = slice(start + 1, start + 8)
            np.testing.assert_array_equal(self.group.flatten(u)[:, :, b].numpy(), t.displacement[ticks])
            np.testing.assert_array_equal(self.group.flatten(drive)[:, :, b].numpy(), t.drive[ticks])
            np.testing.assert_array_equal(self.group.flatten(felt)[:, :, b].numpy(), t.drive[ticks, :, FELT])
            frames = np.asarray(t.rotation).reshape(-1, 16, 3, 3)
            for back, found in ((1, turn[0]), (2, turn[1])):
                want = frames[ticks].swapaxes(-1, -2) @ frames[start + 1 - back : start + 8 - back]
                flat = self.group.flatten(found.flatten(-2))[:, :, b].unflatten(-1, (3, 3))
                np.testing.assert_allclose(flat.numpy(), want, atol=1e-6)  # order of three products

    def test_what_lies_before_a_sequence_is_its_first_tick(self):
        frames = self.group.rotation
        frames[:, 0] = torch.tensor([0.0, -1, 0, 1, 0, 0, 0, 0, 1])
        _, _, turn, _ = self.group.window(torch.tensor([0]), torch.tensor([0]), 2)
        self.assertTrue(torch.equal(turn[0][0], turn[1][0]))

    def test_regions_of_different_sizes_are_padded_apart(self):
        group, (first, second) = self.group, synthetic.SIZES
        self.assertEqual(group.mask.sum(1).tolist(), [first, second])
        edges = np.array(self.named[0][1].body.edges)
        inside = edges[(edges >= first).all(1)] - first
        want = normalized_adjacency(second, inside).numpy()
        np.testing.assert_allclose(group.P[1, :second, :second].numpy(), want, atol=1e-6)
        self.assertEqual(float(group.P[1, second:].abs().max()), 0)
        _, drive, turn, u = group.window(torch.tensor([0]), torch.tensor([20]), 3)
        for a in (drive, turn[0].flatten(-2), u, *(v[None, :, :, None] for v in group.static.values())):
            self.assertEqual(float(a[:, 1, second:].abs().max()), 0)

    def test_flatten_takes_back_what_unflatten_did(self):
        a = torch.randn(4, sum(synthetic.SIZES), 2, 5)
        self.assertTrue(torch.equal(self.group.flatten(self.group.unflatten(a)), a))

    def test_bodies_names_and_lengths_that_differ_get_groups_of_their_own(self):
        other = read_trajectory(support.write_trajectory(self.place("a"), 5, ticks=TICKS, body_seed=9))
        longer = read_trajectory(support.write_trajectory(self.place("b"), 6, ticks=TICKS + 1))
        name, same = self.named[0]
        named = self.named + [(name, other), (name, longer), ("twin", same)]
        self.assertEqual([g.count for g in dataset.group(named)], [3, 1, 1, 1])

    def test_a_union_holds_its_bodies_side_by_side(self):
        other = support.synthetic_group((7, 8), ticks=TICKS + 5, body_seed=3)
        union = Union([self.group, other])
        sequences, starts = torch.tensor([[2, 0], [1, 1]]), torch.tensor([3, 9])
        parts = [g.window(s, starts, 4) for g, s in zip(union.groups, sequences)]
        whole = union.window(sequences, starts, 4)
        for k in (0, 1, 3):
            self.assertTrue(torch.equal(whole[k], torch.cat([p[k] for p in parts], 1)))
        for k in (0, 1):
            self.assertTrue(torch.equal(whole[2][k], torch.cat([p[2][k] for p in parts], 1)))
        self.assertEqual(union.ticks, TICKS)
        drawn = union.draw(5)
        self.assertEqual(tuple(drawn.shape), (2, 5))
        self.assertTrue((drawn < torch.tensor([[3], [2]])).all())

    def test_a_container_comes_back_as_it_was_written(self):
        path = self.place("any.safetensors")
        a = {"x": np.arange(6, dtype=np.float16).reshape(2, 3), "y": np.array([[1, -2]], np.int32)}
        save(path, a, {"k": 3})
        b, metadata = load(path)
        self.assertEqual(metadata, {"k": "3"})
        for k in a:
            np.testing.assert_array_equal(a[k], b[k])


if __name__ == "__main__":
    unittest.main()
