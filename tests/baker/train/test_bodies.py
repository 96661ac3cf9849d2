"""Bodies and plans of data sets: what is changed, what is refused, what is held out, and that a data set goes
on where it was cut."""
import copy
import json
import os
import sys
import unittest
from unittest import mock

import support

support.leave_without_torch()
import numpy as np  # noqa: E402

from train.data import bodies, plan as plans  # noqa: E402
from train.data.dataset import SPLITS  # noqa: E402
from train.data.generate import generate  # noqa: E402
from train.data.trajectory import read_trajectory  # noqa: E402
from train.files.safetensors import BadData, load, save  # noqa: E402

CREATURE = {
    "name": "small",
    "joints": [{"name": "root", "at": [1, 2, 3], "tip": [0, 1, 0]}],
    "body": [
        {"name": "belly", "at": [1, 1, 1], "radii": [1, 2, 3], "blend_m": 0.1, "joints": ["root"]},
        {"name": "tail", "tube": [[1, 1, 1, 0.5], [2, 2, 2, 0.5]], "joints": ["root"]},
    ],
    "tissue": [{"everywhere": True, "stiffness": 1, "fade_m": 0.1}],
    "skin": {"overlap_m": 0.04, "sharpness": 4},
    "clips": [
        {
            "name": name,
            "duration_s": 1,
            "tracks": [
                {"joints": ["root"], "axis": "move_y", "keys": [[0.5, 1]], "wave": [1, 2, 0.5]},
                {"joints": ["root"], "axis": "turn_y", "keys": [[0.5, 1]]},
            ],
        }
        for name in ("hop", "walk")
    ],
}
LINE = {"body": "one", "split": "train", "seconds": 0.5, "random": 2}
PLAN = {
    "held_out_clip": "hop",
    "sequences": [
        LINE,
        {"body": "one", "split": "validation", "seconds": 0.5, "random": 1, "first_seed": 50},
        {"body": "two", "split": "train", "seconds": 0.5, "clips": 1},
        {"body": "two", "split": "test", "seconds": 4, "held_out": 2, "surface": True},
    ],
}
SHIPPED = os.path.join(bodies.ROOT, "assets", "bodies", "plan.json")


class Folder(support.Folder):
    """A folder with a creature, two bodies of it and a plan."""

    def setUp(self):
        super().setUp()
        self.write("creature.json", CREATURE)
        self.body = {"creature": self.place("creature.json"), "tissue": {"voxels_high": 20}}
        self.write("one.json", self.body)
        self.write("two.json", {**self.body, "proportions": [2, 1, 1]})
        self.write("plan.json", PLAN)

    def refused(self, call, *words):
        """The call is refused in one line that says these words."""
        with self.assertRaises(BadData) as caught:
            call()
        text = str(caught.exception)
        self.assertNotIn("\n", text)
        for word in words:
            self.assertIn(word, text)


class Bodies(Folder):
    def test_proportions_scale_every_place_length_and_movement(self):
        recipe = bodies.stretch(copy.deepcopy(CREATURE), [1, 2, 4])
        belly, tail = recipe["body"]
        self.assertEqual(recipe["joints"][0], {"name": "root", "at": [1, 4, 12], "tip": [0, 2, 0]})
        self.assertEqual((belly["at"], belly["radii"], belly["blend_m"]), ([1, 2, 4], [1, 4, 12], 0.2))
        self.assertEqual(tail["tube"], [[1, 2, 4, 1], [2, 4, 8, 1]])
        self.assertEqual(recipe["tissue"][0]["fade_m"], 0.2)
        self.assertEqual(recipe["skin"], {"overlap_m": 0.08, "sharpness": 4})
        move, turn = recipe["clips"][0]["tracks"]
        self.assertEqual((move["keys"], move["wave"]), ([[0.5, 2]], [2, 2, 0.5]))
        self.assertEqual(turn["keys"], [[0.5, 1]])

    def test_an_ellipsoid_on_its_side_grows_along_its_own_axes(self):
        for turn_deg, want in (([0, 0, 90], [4, 3, 5]), ([90, 0, 0], [3, 5, 4]), ([0, 90, 0], [5, 4, 3])):
            recipe = copy.deepcopy(CREATURE)
            recipe["body"][0].update(radii=[1, 1, 1], turn_deg=turn_deg)
            self.assertEqual(bodies.stretch(recipe, [3, 4, 5])["body"][0]["radii"], want)

    def test_radii_change_the_named_parts_alone(self):
        recipe = bodies.thicken(copy.deepcopy(CREATURE), {"tail": 2})
        self.assertEqual(recipe["body"][0], CREATURE["body"][0])
        self.assertEqual(recipe["body"][1]["tube"], [[1, 1, 1, 1], [2, 2, 2, 1]])

    def test_tissue_keys_replace_those_of_the_tissue_recipe(self):
        self.write("flesh.json", {"voxels_high": 30, "damping_ratio": 0.3})
        path = self.write("one.json", {**self.body, "tissue_recipe": self.place("flesh.json")})
        self.assertEqual(bodies.read_body(path).tissue, {"voxels_high": 20, "damping_ratio": 0.3})

    def test_a_body_without_changes_is_the_creature_as_it_is(self):
        path = self.write("small.json", {"creature": self.place("creature.json")})
        self.assertEqual(bodies.read_body(path).creature, {**CREATURE, "vertices": 7000})

    def test_the_stamp_is_of_what_is_simulated(self):
        stamp = lambda **changes: bodies.read_body(self.write("one.json", {**self.body, **changes})).stamp()
        self.assertEqual(stamp(), stamp(proportions=[1, 1, 1]))
        self.assertNotEqual(stamp(), stamp(radii={"tail": 1.1}))
        self.assertNotEqual(stamp(), stamp(tissue={"voxels_high": 21}))

    def test_bodies_that_are_not_right_are_refused_by_name(self):
        for change, word in (
            ({"colour": "red"}, "unknown key 'colour'"),
            ({"proportions": [1, 2]}, "proportions"),
            ({"proportions": [1, 2, 0]}, "proportions"),
            ({"radii": {"tail": "big"}}, "radii"),
            ({"radii": {"horn": 2}}, "no body part 'horn'"),
            ({"vertices": 3}, "vertices"),
            ({"tissue": {"young": 3}}, "unknown key 'young'"),
            ({"tissue": 5}, "tissue"),
            ({"tissue_recipe": 5}, "tissue_recipe"),
        ):
            path = self.write("one.json", {**self.body, **change})
            self.refused(lambda: bodies.read_body(path), path, word)
        for text, word in (("{", "not JSON"), ("[]", "object"), ("{}", "--character one=PATH")):
            path = self.write("one.json", text)
            self.refused(lambda: bodies.read_body(path), path, word)
        self.refused(lambda: bodies.read_body(self.place("none.json")), "none.json")
        self.refused(lambda: bodies.read_body(self.write("a b.json", self.body)), "'a b'")

    def test_recipes_that_are_not_right_are_refused_by_name(self):
        path = self.write("one.json", {**self.body, "creature": self.place("none.json")})
        self.refused(lambda: bodies.read_body(path), self.place("none.json"))
        for parts in (5, [5], [{"tube": 3}], [{"at": ["left", 0, 0]}]):
            path = self.write("one.json", {**self.body, "creature": self.write("c.json", {"body": parts})})
            self.refused(lambda: bodies.read_body(path), self.place("c.json"), "not a creature recipe")
        path = self.write("one.json", {**self.body, "creature": self.write("c.json", {})})
        self.refused(lambda: bodies.read_body(path), self.place("c.json"), "not a creature recipe")

    def test_a_characters_tissue_lies_beside_the_plan(self):
        file = self.write("c.glb", "any")
        self.write("fox.json", {"tissue": {"voxels_high": 30}})
        fox = bodies.read_character(self.place(""), "fox", file)
        self.assertEqual(fox.tissue, {"voxels_high": 30})
        self.assertEqual(bodies.read_character(self.place(""), "owl", file).tissue, {})
        self.refused(lambda: bodies.read_character(self.place(""), "fox", self.place("no.glb")), "no.glb")
        self.refused(lambda: bodies.read_character(self.place(""), "one", file), "takes no --character")
        self.refused(lambda: bodies.read_character(self.place(""), "../owl", file), "'../owl'")


class Plans(Folder):
    def jobs(self, sequences=PLAN["sequences"], **changes):
        path = self.write("plan.json", {**PLAN, "sequences": sequences, **changes})
        plan = plans.read_plan(path)
        return plans.jobs_of(path, plan, {"one": ["hop", "walk"], "two": ["hop", "walk"], "fox": []})

    def test_jobs_come_in_the_order_of_the_plan(self):
        self.assertEqual(
            [j.file for j in self.jobs()],
            [
                f"{name}.safetensors"
                for name in (
                    "one/train-random-1",
                    "one/train-random-2",
                    "one/validation-random-50",
                    "two/train-clip-walk-0",
                    "two/test-clip-hop-0",
                    "two/test-clip-hop-1",
                )
            ],
        )

    def test_variants_go_through_the_strengths(self):
        lines = [{**LINE, "random": 3}, {**LINE, "body": "two", "random": 2, "strengths": [2]}]
        jobs = self.jobs(lines, strengths={"random": [0.5, 1]})
        self.assertEqual([j.strength for j in jobs], [0.5, 1, 0.5, 2, 2])

    def test_a_star_is_every_character_that_is_given(self):
        jobs = self.jobs([LINE, {"body": "*", "split": "test", "seconds": 1, "random": 1, "first_seed": 9}])
        self.assertEqual(jobs[-1].file, "fox/test-random-9.safetensors")

    def test_random_motion_of_training_and_validation_leaves_the_held_out_clip_alone(self):
        lines = [{**LINE, "split": s, "first_seed": i * 10 + 1} for i, s in enumerate(SPLITS)]
        held_out = {j.split: j.held_out for j in self.jobs(lines)}
        self.assertEqual(held_out, {"train": ("hop",), "validation": ("hop",), "test": (), "long": ()})

    def test_lines_that_are_not_right_are_refused_by_number(self):
        for change, word in (
            ({"body": 5}, "body"),
            ({"split": "exam"}, "split"),
            ({"seconds": 0}, "seconds"),
            ({"random": 0}, "no motion"),
            ({"random": 1.5}, "random"),
            ({"random": "many"}, "random"),
            ({"first_seed": 0}, "first_seed"),
            ({"strengths": []}, "strengths"),
            ({"strengths": [0]}, "strengths"),
            ({"hops": 3}, "unknown key 'hops'"),
            ({"held_out": 1}, "held-out clip"),
        ):
            self.refused(lambda: self.jobs([LINE, {**LINE, **change}]), "plan.json: sequences[1]", word)

    def test_plans_that_are_not_right_are_refused(self):
        for change, word in (
            ({"sequences": []}, "sequences"),
            ({"substeps": 0}, "substeps"),
            ({"strengths": {"random": 1}}, "random"),
            ({"strengths": {"dance": [1]}}, "unknown key 'dance'"),
            ({"held_out_clip": 5}, "held_out_clip"),
            ({"held_out_clip": "fly"}, "'fly' is in no body"),
            ({"rate": 5}, "unknown key 'rate'"),
        ):
            self.refused(lambda: self.jobs(**change), "plan.json", word)

    def test_a_random_motion_in_two_splits_is_refused(self):
        lines = [LINE, {**LINE, "body": "two", "split": "test", "first_seed": 2}]
        self.refused(lambda: self.jobs(lines), "random seed 2 is in train and test (two)")

    def test_a_sequence_asked_for_twice_is_refused(self):
        self.refused(lambda: self.jobs([LINE, LINE]), "one/train-random-1.safetensors is asked for twice")

    def test_a_held_out_clip_that_the_body_lacks_is_refused(self):
        line = {"body": "*", "split": "test", "seconds": 1, "held_out": 1}
        self.refused(lambda: self.jobs([LINE, line]), "'fox' has no clip 'hop'")

    def test_a_body_without_a_file_is_refused(self):
        path = self.write("plan.json", {"sequences": [{**LINE, "body": "nobody"}]})
        self.refused(lambda: plans.read_bodies(path, plans.read_plan(path), {}), "body 'nobody'")

    def test_the_shipped_plan_trains_on_nothing_that_it_tests(self):
        plan = plans.read_plan(SHIPPED)
        known = plans.read_bodies(SHIPPED, plan, {})
        clips = {n: [c["name"] for c in b.creature["clips"]] for n, b in known.items()}
        jobs = plans.jobs_of(SHIPPED, plan, clips)
        bodies_of = lambda *splits: {j.body for j in jobs if j.split in splits}
        self.assertEqual(bodies_of("test") - bodies_of("train", "validation"), {"momo_unseen", "tail"})
        self.assertEqual(bodies_of("validation") - bodies_of("train"), {"momo_middling"})
        for job in jobs:
            if job.split not in ("train", "validation"):
                continue
            self.assertNotEqual(job.motion, "clip:hop")
            if job.motion in ("random", "leap") and "hop" in clips[job.body]:
                self.assertEqual(job.held_out, ("hop",))
        order = [{"train": 0, "validation": 0, "test": 1, "long": 2}[j.split] for j in jobs]
        self.assertEqual(order, sorted(order))
        self.assertEqual((jobs[-1].seconds, jobs[-1].split), (600, "long"))


class Generation(Folder):
    def setUp(self):
        super().setUp()
        program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pretend_bake.py")
        self.bake = self.write("bake", f'#!/bin/sh\nexec "{sys.executable}" "{program}" "$@"\n')
        os.chmod(self.bake, 0o755)

    def generate(self, fail="none", **given):
        """The sheet and the calls of the pretended program, as `truth one/train-random-1`."""
        log = self.write("log", "")
        with mock.patch.dict(os.environ, SINEW_PRETEND_LOG=log, SINEW_PRETEND_FAIL=fail):
            try:
                self.sheet = generate(self.bake, self.place("plan.json"), self.place("data"), **given)
            finally:
                with open(log) as file:
                    calls = [line.split() for line in file]
                self.calls = [f"{c} {os.path.relpath(o, self.place('data')).split('.')[0]}" for c, o in calls]

    def truths(self):
        return sorted(c[6:] for c in self.calls if c.startswith("truth"))

    def test_every_sequence_is_made_and_told(self):
        self.generate()
        files = [e["file"] for e in self.sheet["sequences"]]
        self.assertEqual(len(files), 6)
        for file in files:
            read_trajectory(os.path.join(self.place("data"), file))
        self.assertEqual(self.sheet["counts"], {"train": 3, "validation": 1, "test": 2, "long": 0})
        self.assertEqual(sorted(self.calls)[:2], ["creature one/body", "creature two/body"])
        with open(self.place("data/data_sheet.json")) as file:
            self.assertEqual(json.load(file), self.sheet)

    def test_a_second_call_simulates_nothing(self):
        self.generate()
        first = self.sheet
        self.generate()
        self.assertEqual((self.calls, self.sheet), ([], first))

    def test_files_that_are_missing_cut_or_of_an_older_version_are_made_again(self):
        self.generate()
        path = lambda name: self.place(f"data/one/{name}.safetensors")
        os.remove(path("train-random-1"))
        os.truncate(path("train-random-2"), 500)
        tensors, metadata = load(path("validation-random-50"))
        save(path("validation-random-50"), tensors, {**metadata, "sinew.trajectory": 0})
        self.generate()
        want = ["one/train-random-1", "one/train-random-2", "one/validation-random-50"]
        self.assertEqual(self.truths(), want)

    def test_what_the_plan_changes_is_made_again(self):
        self.generate()
        self.write("plan.json", {**PLAN, "strengths": {"held_out": [1, 0.5]}})
        self.generate()
        self.assertEqual(self.truths(), ["two/test-clip-hop-1"])
        self.write("plan.json", {**PLAN, "held_out_clip": "walk"})
        self.generate()
        self.assertIn("one/train-random-1", self.truths())

    def test_a_rebuilt_program_keeps_the_data(self):
        self.generate()
        with open(self.bake, "a") as file:
            file.write("# built again\n")
        self.generate()
        self.assertEqual(self.calls, [])

    def test_sequences_of_another_recipe_are_refused_before_simulating(self):
        self.generate()
        self.write("two.json", {**self.body, "proportions": [3, 1, 1]})
        self.refused(self.generate, self.place("data/two"), "another recipe")
        self.assertEqual(self.calls, [])
        os.remove(self.place("data/two/made_from"))
        self.refused(self.generate, self.place("data/two"), "another recipe")

    def test_a_broken_plan_or_body_runs_no_program(self):
        self.write("two.json", "{")
        self.refused(self.generate, "two.json", "not JSON")
        self.assertEqual(self.calls, [])
        self.assertFalse(os.path.exists(self.place("data")))

    def test_a_body_that_cannot_be_made_is_named_before_simulating(self):
        self.refused(lambda: self.generate(fail="two/body"), "body 'two'", "said to fail")
        self.assertEqual(self.truths(), [])

    def test_a_missing_program_is_refused(self):
        self.bake = self.place("no-bake")
        self.refused(self.generate, "no-bake", "sinew-bake")

    def test_too_many_failures_stop_the_work(self):
        start = lambda: self.generate(fail="random", processes=1)
        self.refused(start, "of 6 simulations failed", "one/train")
        self.assertNotIn("one/validation-random-50", self.truths())  # the next may have begun, no more

    def test_few_failures_are_told_and_tried_again(self):
        self.write("plan.json", {**PLAN, "sequences": [{**LINE, "random": 10}, PLAN["sequences"][2]]})
        self.generate(fail="clip:walk")
        self.assertEqual(list(self.sheet["failed"]), ["two/train-clip-walk-0.safetensors"])
        self.assertEqual(len(self.sheet["sequences"]), 10)
        self.generate()
        self.assertEqual((self.truths(), self.sheet["failed"]), (["two/train-clip-walk-0"], {}))

    def test_characters_are_copied_and_tested(self):
        header = json.dumps({"animations": [{"name": "hop"}]}).encode()
        with open(self.place("any.glb"), "wb") as file:
            words = (0x46546C67, 2, 0, len(header), 0x4E4F534A)
            file.write(np.array(words, np.uint32).tobytes() + header)
        line = {"body": "*", "split": "test", "seconds": 1, "held_out": 1}
        self.write("plan.json", {**PLAN, "sequences": [LINE, line]})
        self.generate(characters={"fox": self.place("any.glb")})
        self.assertEqual(self.sheet["sequences"][-1]["file"], "fox/test-clip-hop-0.safetensors")
        with open(self.place("any.glb"), "rb") as a, open(self.place("data/fox/body.glb"), "rb") as b:
            self.assertEqual(a.read(), b.read())
        self.refused(lambda: self.generate(characters={"owl": self.bake}), "not a binary glTF")

    def test_the_sheet_is_there_when_a_split_is_whole(self):
        self.write("plan.json", {**PLAN, "sequences": [LINE, {**PLAN["sequences"][2], "clips": 9}]})
        self.refused(lambda: self.generate(fail="clip:walk", processes=1), "failed")
        with open(self.place("data/data_sheet.json")) as file:
            sheet = json.load(file)
        self.assertEqual([e["body"] for e in sheet["sequences"]], ["one", "one"])

    def test_figures_are_those_of_the_files(self):
        self.generate()
        test = self.sheet["bodies"]["two"]["test"]
        files = [self.place(f"data/two/test-clip-hop-{i}.safetensors") for i in range(2)]
        sizes = np.concatenate([np.linalg.norm(load(f)[0]["displacement"], axis=-1).ravel() for f in files])
        want = {"mean": sizes.mean(), "p95": np.percentile(sizes, 95), "max": sizes.max()}
        for key, value in want.items():  # figures have four digits
            self.assertAlmostEqual(test["displacement_mm"][key] / (1000 * value), 1, delta=1e-3)
        # the pretended drive is (1, 1, 1) at strength 1
        self.assertAlmostEqual(test["felt_acceleration_m_s2"]["max"], 3**0.5, delta=1e-3)
        self.assertEqual((test["sequences"], test["seconds"]), (2, 8.0))
        region = self.sheet["bodies"]["two"]["regions"]["flesh"]
        self.assertEqual(region, {"nodes": 4, "radius_m": 0.1, "first_mode_hz": 5.0})
        # a sine of 3 Hz; the window spreads it over half a hertz
        self.assertGreater(test["power_share"]["2-4 Hz"], 0.99)


if __name__ == "__main__":
    unittest.main()
