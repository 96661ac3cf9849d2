"""sinew-train: what it refuses, which motions it trains on and which it judges by, that it goes on where it
was cut, what tuning does to weights, and what is baked."""
import contextlib
import io
import json
import os
import shutil
import sys
import tempfile
import time
import unittest
from unittest import mock

import support

support.leave_without_torch()
import torch  # noqa: E402

import synthetic  # noqa: E402
from train.data import dataset  # noqa: E402
from train.files.safetensors import BadData, load, save  # noqa: E402
from train.learn.scaling import measure_scaling  # noqa: E402
from train.model.alt_conv_lstm import AltConvLSTM, ModelOptions  # noqa: E402
from train.model.inputs import INPUT_WIDTH, ORDER  # noqa: E402
from train.tune import SHIPPED, finetune, learn  # noqa: E402
from train.tune.finetune import FineTuner, tuning_options, widened  # noqa: E402
from train.tune.motions import MOST_MOTIONS, held_out_clips, motions_of  # noqa: E402
from train.tune.packs import Baker  # noqa: E402
from train.tune.program import main  # noqa: E402
from train.tune.run import Run  # noqa: E402
from train.tune.simulate import MOST_FAILURES, Simulation  # noqa: E402
from train.tune.start import read_start  # noqa: E402
from train.tune.stop import Stop  # noqa: E402
from train.tune.time_budget import TimeBudget, in_words  # noqa: E402
from train.tune.verdict import BASE, Error, Row, best_of, reason, table  # noqa: E402

SPLITS = ("train", "validation", "test")
UPDATES = 25


class Folder(support.Folder):
    """A folder with a pretended sinew-bake."""

    def setUp(self):
        super().setUp()
        program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pretend_bake.py")
        self.bake = self.write("bake", f'#!/bin/sh\nexec "{sys.executable}" "{program}" "$@"\n')
        os.chmod(self.bake, 0o755)
        self.log, self.glb = self.write("log", ""), self.write("c.glb", "any")
        self.environment = mock.patch.dict(os.environ, SINEW_PRETEND_LOG=self.log)
        self.environment.start()

    def tearDown(self):
        self.environment.stop()
        super().tearDown()

    def calls(self, command):
        with open(self.log) as file:
            return [line for line in file if line.startswith(command)]


class Refusals(Folder):
    def refused(self, *arguments, says, output="out.sinew"):
        """Exit 2 and one line; nothing is written."""
        before = sorted(os.listdir(self.temporary.name))
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors), contextlib.redirect_stdout(io.StringIO()):
            try:
                code = main([*arguments, "-o", self.place(output), "--bake", self.bake])
            except SystemExit as left:
                code = left.code
        text = errors.getvalue()
        self.assertEqual(code, 2, text)
        self.assertRegex(text, r"\Asinew-train: [^\n]*\n\Z")
        self.assertIn(says, text)
        self.assertEqual(sorted(os.listdir(self.temporary.name)), before)

    def test_times_that_are_none(self):
        for minutes in ("0", "-1", "nan", "inf"):
            self.refused(self.glb, "--minutes", minutes, says="--minutes")
        self.refused(self.glb, "--minutes", "soon", says="soon")

    def test_options_that_are_none(self):
        self.refused(self.glb, "--processes", "0", says="--processes")
        self.refused(self.glb, "--colour", says="--colour")
        self.refused(says="C.glb")

    def test_files_that_are_not_there(self):
        self.refused(self.place("no.glb"), says="no.glb: no such file")
        self.refused(self.glb, "--recipe", self.place("no.json"), says="no.json: no such file")
        self.refused(self.glb, "--tissue", self.place("no.safetensors"), says="no.safetensors: no such file")
        self.refused(self.temporary.name, says="is a directory")

    def test_outputs_that_cannot_be_written(self):
        self.refused(self.glb, says="is a directory", output="")
        self.refused(self.glb, says="no folder", output="nowhere/out.sinew")

    def test_outputs_that_are_inputs(self):
        says = "is the input; give another name"
        os.link(self.glb, self.place("same.glb"))
        self.refused(self.glb, says=says, output="same.glb")
        shutil.copy(SHIPPED, self.place("own.tissue.safetensors"))
        beside = self.place("own.tissue.safetensors")  # where own.sinew's weights are written
        self.refused(self.glb, "--tissue", beside, says=says, output="own.sinew")
        with open(self.place("c.gltf"), "w", encoding="utf-8") as f:
            json.dump({"buffers": [{"uri": "own.bin"}]}, f)
        shutil.copy(self.glb, self.place("own.bin"))
        self.refused(self.place("c.gltf"), says=says, output="own.bin")

    def test_weights_that_cannot_be_tuned(self):
        tensors, metadata = load(SHIPPED)
        tensors, path = {k: v.copy() for k, v in tensors.items()}, self.place("w.safetensors")
        without = lambda *keys: {k: v for k, v in metadata.items() if k not in keys}
        for changed, says in (
            ({**metadata, "inputs": metadata["inputs"] + ",colour"}, "metadata inputs"),
            ({**metadata, "inputs": metadata["inputs"].replace("turn,", "")}, "metadata inputs"),
            (without("inputs"), "tensor"),
            (without("input_scales"), "metadata input_scales is missing"),
            ({**metadata, "envelope": "1,2"}, "metadata envelope"),
            ({**metadata, "channels": "8,many"}, "metadata channels"),
            ({**metadata, "sinew.model": "coping_net"}, "coping_net"),
            ({**metadata, "base": "none"}, "modal base"),
            ({**metadata, "base": "modal"}, "modal base"),
            ({**metadata, "rate_hz": "30"}, "30 ticks a second"),
            ({**metadata, "kept": "2"}, "metadata kept is 2"),
            ({**metadata, "kept": "nan"}, "metadata kept is nan"),
            ({**metadata, "kept": "all"}, "metadata kept is 'all', not a number"),
        ):
            save(path, tensors, changed)
            self.refused(self.glb, "--tissue", path, says=says)
        papers = AltConvLSTM(ModelOptions(9, (8, 3))).state_dict()
        save(path, {k: v.numpy() for k, v in papers.items()}, {"sinew.model": "alt_conv_lstm", "channels": "8,3"})
        self.refused(self.glb, "--tissue", path, says="not a network of this version's inputs")
        self.write("w.safetensors", "no weights")
        self.refused(self.glb, "--tissue", self.place("w.safetensors"), says="not a safetensors file")

    def test_weights_that_keep_a_part_of_what_was_learned_are_gone_on_with_as_a_whole(self):
        tensors, metadata = load(SHIPPED)
        path = self.place("w.safetensors")
        save(path, {k: v.copy() for k, v in tensors.items()}, {**metadata, "kept": "0.8"})
        whole = read_start(path).model.options.output_scale
        self.assertAlmostEqual(whole, float(metadata["output_scale"]) / 0.8)

    def test_a_character_without_soft_parts(self):
        self.refused(self.glb, says="no soft parts, so there is nothing to train")

    def test_a_recipe_that_has_a_part_emulated(self):
        for recipe in ('{"model": "deep_emulator"}', '{"regions": [{"name": "belly", "model": "deep_emulator"}]}'):
            self.write("r.json", recipe)
            self.refused(self.glb, "--recipe", self.place("r.json"), says="deep_emulator\", which this does not train")

    def test_a_character_that_cannot_be_baked_is_refused_in_the_bakers_words(self):
        with mock.patch.dict(os.environ, SINEW_PRETEND_FAIL="base.sinew"):
            self.refused(self.glb, says="sinew-train: it is said to fail")

    def test_a_baker_that_is_not_there(self):
        os.remove(self.bake)
        self.refused(self.glb, says="build sinew-bake")


class Motions(unittest.TestCase):
    def split(self, clips):
        jobs = motions_of("body", clips)
        return jobs, {s: [j for j in jobs if j.split == s] for s in SPLITS}

    def test_no_motion_is_in_two_splits_or_made_twice(self):
        for clips in ([], ["walk"], ["walk", "run"], ["a/b", "a|b", "a b", "walk"]):
            jobs, by_split = self.split(clips)
            self.assertEqual(len(jobs), MOST_MOTIONS)
            self.assertEqual(len({j.file for j in jobs}), len(jobs))
            self.assertTrue(all(j.file.count("/") == 1 for j in jobs))
            motions = [{(j.motion, j.seed) for j in by_split[s]} for s in SPLITS]
            self.assertEqual(len(set.union(*motions)), len(jobs))

    def test_held_out_clips_are_in_no_other_motion(self):
        for count, held_out in ((3, ["c1"]), (6, ["c1", "c4"]), (12, ["c2", "c6", "c10"])):
            clips = [f"c{i}" for i in range(count)]
            jobs, by_split = self.split(clips)
            self.assertEqual(list(held_out_clips(clips)), held_out)
            held = {f"clip:{name}" for name in held_out}
            self.assertTrue(held <= {j.motion for j in by_split["test"]})
            for job in by_split["train"] + by_split["validation"]:
                self.assertNotIn(job.motion, held)
                self.assertEqual(list(job.held_out), [] if job.motion.startswith("clip:") else held_out)
            used = {j.motion for j in jobs if j.motion.startswith("clip:")}
            self.assertEqual(used, {f"clip:{c}" for c in clips})

    def test_of_fewer_than_two_clips_none_is_held_out(self):
        for clips in ([], ["walk"]):
            self.assertFalse(any(j.held_out for j in self.split(clips)[0]))
            self.assertEqual(held_out_clips(clips), ())
        self.assertTrue(any(j.motion == "clip:walk" for j in self.split(["walk"])[1]["train"]))

    def test_the_first_three_are_one_of_each_split(self):
        for clips in ([], ["walk"], ["walk", "run"]):
            self.assertEqual(sorted(j.split for j in self.split(clips)[0][:3]), sorted(SPLITS))


class Simulations(Folder):
    def setUp(self):
        super().setUp()
        self.jobs = motions_of("body", ["walk", "run"])[:8]
        os.makedirs(self.place("body"))

    def run_all(self, end_s=1e9, stop=None, report=lambda s: None, processes=2):
        simulation = Simulation(
            Baker(self.bake, self.glb), self.temporary.name, processes, stop or Stop(), report
        )
        return simulation.run(self.jobs, end_s)

    def test_a_second_run_goes_on_with_what_is_there(self):
        self.run_all(0.0)  # the time was over before it began
        self.assertEqual(len(self.calls("truth")), 3)
        simulation = self.run_all()
        self.assertEqual(len(simulation.done), len(self.jobs))
        self.assertEqual((len(simulation.seconds), len(self.calls("truth"))), (5, 8))

    def test_without_time_there_is_still_one_motion_of_each_split(self):
        simulation = self.run_all(0.0)
        self.assertEqual(sorted(j.split for j in simulation.done), sorted(SPLITS))

    def test_a_motion_that_fails_is_made_up_for_by_another_of_its_split(self):
        with mock.patch.dict(os.environ, SINEW_PRETEND_FAIL="clip:run"):
            simulation = self.run_all(0.0)
        self.assertEqual([j.motion for j in simulation.failed], ["clip:run"])
        self.assertEqual(sorted(j.split for j in simulation.done), sorted(SPLITS))

    def test_a_character_that_never_can_be_simulated_is_refused(self):
        with mock.patch.dict(os.environ, SINEW_PRETEND_FAIL="body"):
            with self.assertRaisesRegex(BadData, "cannot be simulated.*said to fail"):
                self.run_all()
        self.assertLess(len(self.calls("truth")), MOST_FAILURES + 2)

    def test_a_broken_file_is_simulated_again(self):
        self.run_all()
        with open(self.place(self.jobs[2].file), "r+b") as file:
            file.truncate(100)
        self.run_all()
        self.assertEqual(len(self.calls("truth")), len(self.jobs) + 1)

    def test_a_wish_to_stop_ends_what_runs_and_keeps_what_is_done(self):
        stop, began_s = Stop(), time.monotonic()

        def ask_in_the_third(simulation):
            if len(simulation.done) == 2:
                os.environ["SINEW_PRETEND_SECONDS"] = "60"
                stop.asked = bool(simulation.running)

        with mock.patch.dict(os.environ):
            simulation = self.run_all(stop=stop, report=ask_in_the_third, processes=1)
        self.assertEqual(len(simulation.done), 2)
        self.assertEqual(simulation.running, [])
        self.assertLess(time.monotonic() - began_s, 50)
        self.assertEqual(len(self.run_all().done), len(self.jobs))


class Tuning(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        torch.set_num_threads(1)
        cls.folder = tempfile.TemporaryDirectory()
        support.write_data_set(cls.folder.name, train_count=4, test=0, ticks=60)
        cls.groups = [dataset.group(dataset.read_split(cls.folder.name, s)) for s in ("train", "validation")]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def tuner(self, stop=None, seed=0):
        torch.manual_seed(1)
        model = AltConvLSTM(ModelOptions(INPUT_WIDTH, (8, 3), True, 0.15, 0.0, 0.2, 8.0)).start_for_training()
        scaling = measure_scaling(self.groups[0])
        options = tuning_options(model, seed)
        return FineTuner(*self.groups, (model, scaling), options, stop or Stop())

    def test_weights_get_better_and_the_best_are_told_of(self):
        tuner, kept = self.tuner(Countdown(2 * UPDATES)), []
        tuner.tune(time.monotonic() + 600, keep=lambda t: kept.append(t.best))
        self.assertEqual(tuner.updates, 2 * UPDATES)
        self.assertLess(tuner.best, 0.95 * tuner.given_ratio)
        self.assertEqual((kept[-1], kept), (tuner.best, sorted(kept, reverse=True)))
        self.assertLess(abs(tuner.validate()["of_base"] - tuner.best), 1e-6)

    def test_where_there_is_nothing_to_learn_it_stops_early(self):
        tuner = self.tuner(Countdown(1000))
        tuner.validate = lambda: {"of_base": 0.99}
        with mock.patch.multiple(finetune, LEAST_BETWEEN_S=0.01, HOPELESS_AFTER=0.02):
            tuner.tune(time.monotonic() + 20)
        self.assertTrue(tuner.hopeless)
        self.assertLess(tuner.updates, 500)

    def test_weights_that_know_nothing_of_the_character_are_not_begun_with(self):
        torch.manual_seed(1)
        model = AltConvLSTM(ModelOptions(INPUT_WIDTH, (8, 3), True, 3.0, 0.0, 0.2, 8.0))  # far too loud
        options = tuning_options(model, 0)
        tuner = FineTuner(*self.groups, (model, measure_scaling(self.groups[0])), options, Stop())
        self.assertGreater(tuner.given_ratio, finetune.FOREIGN)
        self.assertLess(tuner.validate()["of_base"], finetune.FOREIGN)
        self.assertEqual(tuner.model.options.channels, finetune.CHANNELS)

    def test_validation_errors_are_told_over_the_bases(self):
        tuner = self.tuner()
        for p in tuner.model.parameters():
            p.data.zero_()
        self.assertAlmostEqual(tuner.validate()["of_base"], 1, places=3)  # a silent network is the base

    def test_without_time_the_weights_are_as_they_were(self):
        tuner = self.tuner()
        before = {k: v.clone() for k, v in tuner.model.state_dict().items()}
        tuner.tune(time.monotonic())
        self.assertEqual((tuner.updates, tuner.best), (0, tuner.given_ratio))
        self.assertTrue(all(torch.equal(v, before[k]) for k, v in tuner.model.state_dict().items()))

    def test_a_wish_to_stop_ends_training_with_the_best(self):
        stop = Stop()
        tuner = self.tuner(stop)

        def ask(t):
            stop.asked = t.updates >= 5

        began_s = time.monotonic()
        tuner.tune(began_s + 600, report=ask)
        self.assertEqual(tuner.updates, 5)
        self.assertLessEqual(tuner.best, tuner.given_ratio)
        self.assertLess(time.monotonic() - began_s, 60)

    def test_the_envelope_grows_to_what_is_seen_and_nothing_else_changes(self):
        scaling = measure_scaling(self.groups[0])
        same = widened(scaling, scaling).envelope
        self.assertTrue(all(abs(same[k] / v - 1) < 1e-6 for k, v in scaling.envelope.items()))
        scaling.envelope["turn"], scaling.scale["turn"] = 1.0, 2.0
        seen = measure_scaling(self.groups[0])
        wide = widened(scaling, seen)
        want = max(1.0, 2 * seen.envelope["turn"] / seen.scale["turn"])
        self.assertAlmostEqual(wide.envelope["turn"], want)
        for k in ORDER:
            self.assertGreaterEqual(wide.envelope[k], scaling.envelope[k])
        self.assertEqual(wide.scale, scaling.scale)


class Countdown(Stop):
    """Asks to stop once it was looked at so many times: after so many updates, on a slow machine as on a fast
    one."""

    def __init__(self, left):
        self.left = left

    @property
    def asked(self):
        self.left -= 1
        return self.left < 0


class Learning(Folder):
    """The training stage, on motions of the synthetic body, from weights that are easily made better."""

    def setUp(self):
        super().setUp()
        self.jobs = motions_of("body", [])[:5]
        self.done = {}
        for number, job in enumerate(self.jobs):
            self.done[job] = support.write_trajectory(self.place(f"{number}.safetensors"), number, ticks=60)
        tensors, metadata = load(SHIPPED)
        loud = {k: v * (3 if k.startswith("layers.1.W") else 1) for k, v in tensors.items()}
        save(self.place("creature.safetensors"), loud, metadata)

    def learn(self, minutes=5, stop=None, without=()):
        start = read_start(self.place("creature.safetensors"))
        run = Run(Baker(self.bake, self.glb), start, TimeBudget(minutes), stop or Countdown(UPDATES), "")
        run.folder = self.temporary.name
        simulation = Simulation(run.baker, "", 1, run.stop)
        simulation.done = {j: p for j, p in self.done.items() if j.split not in without}
        with contextlib.redirect_stdout(io.StringIO()) as said:
            path = learn.train(run, simulation, 0)
        return path, said.getvalue()

    def test_tuned_weights_say_where_they_come_from_and_a_second_run_goes_on(self):
        path, _ = self.learn()
        tensors, metadata = load(path)
        self.assertEqual(metadata["parent"], "creature.safetensors")
        self.assertEqual(len(metadata["parent_sha256"]), 64)
        self.assertEqual(metadata["tuned_for"], "c.glb")
        self.assertTrue(metadata["data"].startswith("3 motions of 4 s: random seed 1 strength 0.8, leap"))
        self.assertIn('"learning_rate"', metadata["recipe"])
        self.assertNotIn("error_mm", metadata)  # the parent's, on another body
        again, said = self.learn()
        self.assertIn("goes on from", said)
        self.assertGreaterEqual(float(load(again)[1]["tuned_minutes"]), float(metadata["tuned_minutes"]))

    def test_it_says_why_it_does_not_train(self):
        self.assertEqual(self.learn(1e-6)[0], None)
        self.assertIn("more --minutes", self.learn(1e-6)[1])
        self.assertIn("no motion to train on", self.learn(without=("validation",))[1])
        stop = Stop()
        stop.asked = True
        self.assertEqual(self.learn(stop=stop), (None, ""))

    def test_where_nothing_better_is_found_there_are_no_weights(self):
        """Weights that know nothing of the character are not begun with, and neither are they given back."""
        tensors, metadata = load(SHIPPED)
        save(self.place("creature.safetensors"), {k: v.copy() for k, v in tensors.items()}, {**metadata, "output_scale": "9"})
        path, said = self.learn(stop=Countdown(1))
        self.assertIn("started again", said)
        self.assertIsNone(path)
        self.assertFalse(os.path.exists(self.place("tuned.safetensors")))

    def test_an_earlier_runs_weights_are_taken_where_this_one_cannot_train(self):
        self.learn()
        stop = Stop()
        stop.asked = True
        self.assertEqual(self.learn(stop=stop)[0], self.place("tuned.safetensors"))


class Verdicts(unittest.TestCase):
    def row(self, base, motion="all", **networks):
        error = lambda ratio: Error(10 * ratio, ratio, 30 * ratio, ratio)
        return Row(motion, {BASE: error(base), **{name: error(ratio) for name, ratio in networks.items()}})

    def best(self, *of_all, rows=(), **networks):
        one = self.row(*of_all, **networks)
        return best_of(list(rows) or [one], one)

    def test_a_network_has_to_beat_the_base_by_a_margin(self):
        self.assertEqual(self.best(0.2, shipped=0.196, tuned=0.191), BASE)
        self.assertEqual(self.best(0.2, shipped=0.196, tuned=0.189), "tuned")
        self.assertEqual(self.best(0.2, shipped=0.15, tuned=0.16), "shipped")

    def test_a_network_that_does_harm_in_any_motion_is_not_baked(self):
        harmed = [self.row(0.2, "hop", shipped=0.15, tuned=0.10), self.row(0.1, "idle", shipped=0.10, tuned=0.106)]
        self.assertEqual(self.best(0.2, rows=harmed, shipped=0.15, tuned=0.10), "shipped")
        told = reason(BASE, harmed, self.row(0.2, shipped=0.199, tuned=0.10))
        self.assertIn("tuned 0.100, but 1.06 of the base's in idle", told)

    def test_what_is_not_a_number_never_wins(self):
        nan = float("nan")
        self.assertEqual(self.best(0.2, shipped=nan), BASE)
        self.assertEqual(self.best(0.2, shipped=nan, tuned=0.1), "tuned")
        self.assertEqual(self.best(0.2, tuned=0.1, shipped=nan), "tuned")
        self.assertEqual(self.best(0.2, rows=[self.row(0.2, tuned=0.1), self.row(0.2, tuned=nan)], tuned=0.1), BASE)

    def test_the_table_has_a_line_for_each_motion_and_one_for_all(self):
        rows = [self.row(0.2, "hop", tuned=0.1), self.row(0.5, "sway", tuned=1.0)]
        self.assertEqual([round(row.skinning_mm(), 6) for row in rows], [10, 10])
        lines = table(rows, self.row(0.3, tuned=0.15))
        self.assertEqual([line.split()[0] for line in lines], ["held-out", "hop", "sway", "all"])
        self.assertEqual([line.split()[-1] for line in lines], ["base", "0.500", "2.000", "0.500"])
        self.assertTrue(all(len(line) <= len(lines[1]) + 1 for line in lines))

    def test_times_are_told_in_words(self):
        want = {-3: "0 s", 9.4: "9 s", 60: "1 min 00 s", 249.6: "4 min 10 s"}
        self.assertEqual({s: in_words(s) for s in want}, want)


if __name__ == "__main__":
    unittest.main()
