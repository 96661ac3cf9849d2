"""The page of networks trained for one character: which weights are shipped, and its figures."""
import csv
import json
import os
import unittest
from unittest import mock

import support

support.leave_without_torch()
import numpy as np  # noqa: E402

from train.files.safetensors import BadData, save  # noqa: E402
from train.judge import characters as page  # noqa: E402
from train.tune.verdict import BASE, TUNED  # noqa: E402

MOST_WORDS = 250 - 4 * 11  # of the page with three rows instead of seven


class Characters(support.Folder):
    def setUp(self):
        super().setUp()
        self.work, self.out, self.gallery = (self.place(n) for n in ("work", "out", "gallery"))
        for folder in ("work", "gallery", "evaluation/truth"):
            os.makedirs(self.place(folder))
        self.write("gallery/characters.json", json.dumps([{"folder": "fox", "title": "Fox"}]))
        self.write("evaluation/truth/some_clips.csv", 'character,clip,mean_mm,slow,many,finer,fault\n"fox","run",2.0,,0.02,0.2,""\n')

    def weights(self, name, **motions):
        """motions: name -> (base, generic, own) of skinning's error."""
        error = lambda r: {"mean_mm": 10 * r, "ratio": r, "p95_mm": 30 * r, "velocity_ratio": 2 * r}
        held_out = {m: dict(zip((BASE, page.GENERIC, TUNED), map(error, ratios))) for m, ratios in motions.items()}
        metadata = {"held_out": json.dumps(held_out), "data": "2 motions of 4 s: random, leap", "tuned_minutes": "3.21"}
        save(os.path.join(self.work, name + page.TISSUE), {"w": np.zeros(3, np.float32)}, metadata)

    def make(self):
        with mock.patch.object(page, "_draw_trace"):
            page.characters(self.work, self.out, self.temporary.name, "bake")
        with open(os.path.join(self.out, "README.md")) as file:
            return file.read()

    def table(self, name):
        with open(os.path.join(self.out, name)) as file:
            return list(csv.DictReader(file))

    def shipped(self):
        return sorted(name for name in os.listdir(self.gallery) if name.endswith(page.TISSUE))

    def test_what_pays_is_shipped_and_what_does_not_is_taken_back(self):
        self.weights("fox", hop=(0.2, 0.3, 0.1), all=(0.2, 0.3, 0.1))
        self.weights("wolf", hop=(0.2, 0.3, 0.1), idle=(0.1, 0.1, 0.11), all=(0.2, 0.3, 0.12))
        self.weights("mage", hop=(0.2, 0.3, 0.19), all=(0.2, 0.3, 0.19))
        self.write("gallery/mage" + page.TISSUE, "of an earlier run")
        text = self.make()
        self.assertEqual(self.shipped(), ["fox" + page.TISSUE])
        self.assertIn("| Fox | 0.200 | 0.300 | 0.100 | yes |", text.splitlines())
        self.assertIn("| wolf | 0.200 | 0.300 | 0.120 | no |", text.splitlines())
        self.assertIn("| mage | 0.200 | 0.300 | 0.190 | no |", text.splitlines())
        self.assertIn("more than 1.05: 1 of 3", text)
        self.assertLessEqual(len(text.split()), MOST_WORDS)
        summary = {row["character"]: row for row in self.table("summary.csv")}
        fox, wolf = (summary[name] for name in ("fox", "wolf"))
        self.assertEqual([fox[k] for k in ("motions_trained_on", "motions_held_out", "best_after_minutes")], ["2", "1", "3.21"])
        self.assertEqual([fox[k] for k in ("truth_against_finer_steps", "truth_against_finer_cells")], ["0.02", "0.2"])
        self.assertEqual((wolf["own_worst_motion"], wolf["own_worst_of_base"]), ("idle", "1.1"))
        motions = {(r["character"], r["motion"], r["method"]): r["ratio"] for r in self.table("errors.csv")}
        self.assertEqual(motions["wolf", "idle", TUNED], "0.11")
        self.assertEqual(len(motions), 3 * (2 + 3 + 2))
        self.assertTrue(os.path.getsize(os.path.join(self.out, "errors.png")) > 1000)

    def test_weights_that_state_nothing_are_refused_by_name_and_nothing_is_shipped(self):
        self.weights("fox", hop=(0.2, 0.3, 0.1), all=(0.2, 0.3, 0.1))
        save(os.path.join(self.work, "wolf" + page.TISSUE), {"w": np.zeros(3, np.float32)}, {})
        with self.assertRaisesRegex(BadData, "wolf.*states no errors.*sinew-train --keep"):
            self.make()
        self.assertEqual(self.shipped(), [])

    def test_weights_begun_with_others_than_the_shipped_are_refused(self):
        with mock.patch.object(page, "GENERIC", "mine"):
            self.weights("fox", hop=(0.2, 0.3, 0.1), all=(0.2, 0.3, 0.1))
        with self.assertRaisesRegex(BadData, "fox.*from the shipped weights"):
            self.make()

    def test_where_the_motions_are_gone_nothing_is_shipped(self):
        self.weights("fox", **{"hop #1 x1": (0.2, 0.3, 0.1), "all": (0.2, 0.3, 0.1)})
        with self.assertRaisesRegex(BadData, "fox.train holds no hop #1 x1"):
            page.characters(self.work, self.out, self.temporary.name, "bake")
        self.assertEqual(self.shipped(), [])

    def test_a_folder_that_is_not_the_assets_is_refused(self):
        self.weights("fox", hop=(0.2, 0.3, 0.1), all=(0.2, 0.3, 0.1))
        os.remove(self.place("evaluation/truth/some_clips.csv"))
        with self.assertRaisesRegex(BadData, "some_clips.csv.*give the folder with gallery and evaluation"):
            self.make()
        self.assertFalse(os.path.exists(self.out))

    def test_a_folder_without_weights_is_refused(self):
        with self.assertRaisesRegex(BadData, "holds no .*tissue"):
            self.make()


if __name__ == "__main__":
    unittest.main()
