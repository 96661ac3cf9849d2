"""The vanilla ConvLSTM computes each of its forms, trains, and is compared in a table."""
import csv
import json
import os
import tempfile
import unittest
from unittest import mock

import support

support.leave_without_torch()
import torch  # noqa: E402

from train.cli import main as trainer  # noqa: E402
from train.data import dataset  # noqa: E402
from train.files.safetensors import BadData, load, save  # noqa: E402
from train.judge import paper_forms  # noqa: E402
from train.judge.export import export  # noqa: E402
from train.learn.options import TrainOptions  # noqa: E402
from train.learn.scaling import measure_scaling  # noqa: E402
from train.learn.train import Trainer  # noqa: E402
from train.model.alt_conv_lstm import ModelOptions, normalized_adjacency  # noqa: E402
from train.model.inputs import FEEDBACK, INPUT_WIDTH, ORDER, STATIC, columns, crossed_with  # noqa: E402
from train.model.rollout import roll_out, single_steps, truth  # noqa: E402
from train.model.vanilla import FORMS, ConvLSTM  # noqa: E402
from train.model.weights import read_weights  # noqa: E402

EQUATION_TOLERANCE = 1e-6  # double against double, but for fast_tanh's 1e-7
NODES = 5


def network(form, scale=0.5, clamp=float("inf"), seed=1):
    torch.manual_seed(seed)
    model = ConvLSTM(ModelOptions(INPUT_WIDTH, (7, 4, 3), True, scale, state_clamp=clamp), form).double()
    with torch.no_grad():
        for p in model.parameters():
            p.copy_(torch.randn(p.shape) * 0.4)
    return model


def run(model, z, y=None):
    """(T, 1, n, 1, 3) of a model on inputs (T, 1, n, 1, INPUT_WIDTH), from y or zero."""
    P = normalized_adjacency(NODES, [(i, i + 1) for i in range(NODES - 1)])[None]
    y, out = torch.zeros(1, NODES, 1, 3).double() if y is None else y, []
    state = model.zero_state(1, NODES, 1)
    with torch.no_grad():
        for now in z:
            y, state = model.step(model.packed(), P, now, state, y)
            out.append(y)
    return torch.stack(out)


def inputs(ticks=6, seed=2):
    torch.manual_seed(seed)
    return torch.randn(ticks, 1, NODES, 1, INPUT_WIDTH).double()


class Equations(unittest.TestCase):
    def test_follows_shi_et_al_node_by_node(self):
        model, z, clamp = network("NP_Y", clamp=0.7), inputs(), 0.7
        P = normalized_adjacency(NODES, [(i, i + 1) for i in range(NODES - 1)])
        memory = [[torch.zeros(NODES, f).double()] * 2 for f in (7, 4, 3)]
        found, largest = run(model, z), 0.0
        with torch.no_grad():
            for t, now in enumerate(z):
                x = now[0, :, 0]
                for l, (layer, (h, c)) in enumerate(zip(model.layers, memory)):
                    gates = ((P @ x) @ layer.W_x + x @ layer.W_s + (P @ h) @ layer.W_h + layer.b).chunk(4, -1)
                    w_i, w_f, w_o = layer.w_c.chunk(3)
                    i, f = torch.sigmoid(gates[0] + w_i * c), torch.sigmoid(gates[1] + w_f * c)
                    c = (f * c + i * torch.tanh(gates[3])).clamp(-clamp, clamp)
                    x = torch.sigmoid(gates[2] + w_o * c) * torch.tanh(c)
                    memory[l], largest = [x, c], max(largest, float(c.abs().max()))
                want = 0.5 * (torch.cat([h for h, _ in memory], -1) @ model.W_out + model.b_out)
                self.assertLess(float((found[t, 0, :, 0] - want).abs().max()), EQUATION_TOLERANCE)
        self.assertEqual(largest, clamp)  # it was reached

    def test_a_cell_of_zeros_holds_still(self):
        y = torch.randn(1, NODES, 1, 3).double()
        for form in FORMS:
            model = network(form)
            with torch.no_grad():
                for p in model.parameters():
                    p.zero_()
            still = y if form.endswith("dY") else 0 * y
            self.assertTrue(torch.equal(run(model, inputs(), y), still.expand(6, 1, NODES, 1, 3)))

    def test_the_change_form_adds_up_what_the_whole_form_says(self):
        for pose in ("CP", "NP"):
            whole, change = run(network(f"{pose}_Y"), inputs()), run(network(f"{pose}_dY"), inputs())
            self.assertLess(float((change - whole.cumsum(0)).abs().max()), 1e-12)  # two orders of a sum

    def test_the_whole_form_does_not_carry_its_output_on(self):
        y = torch.randn(1, NODES, 1, 3).double()
        self.assertTrue(torch.equal(run(network("NP_Y"), inputs(), y), run(network("NP_Y"), inputs())))

    def test_only_the_next_pose_forms_see_a_ticks_own_drive(self):
        for form in FORMS:
            for name in [k for k in ORDER if k not in (*STATIC, *FEEDBACK)]:
                z = inputs()
                z[3][..., columns(name)] += 1
                same = (run(network(form), z) == run(network(form), inputs())).flatten(1).all(1).tolist()
                first_changed = 4 if form.startswith("CP") else 3
                self.assertEqual(same, [t < first_changed for t in range(6)], (form, name))

    def test_both_poses_see_their_own_displacement_at_once(self):
        for form in FORMS:
            z = inputs()
            z[3][..., columns("displacement")] += 1
            self.assertFalse(torch.equal(run(network(form), z)[3], run(network(form), inputs())[3]))


class RollOuts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.group = support.synthetic_group((0,), ticks=40)
        cls.scaling = measure_scaling([cls.group])
        # drive x what is fed back is seen a tick late as a whole, with the displacement of then
        base = ("base", "base_step", "turn")
        cls.scaling.without = (*base, *crossed_with(*base), "bent_displacement", "spun_velocity")

    def test_the_current_pose_form_is_the_next_pose_form_on_a_drive_a_tick_late(self):
        delayed = lambda tensors: {**tensors, "drive": _delayed(tensors["drive"])}
        late = support.synthetic_group((0,), delayed, ticks=40)
        current, following = (network(form).float() for form in ("CP_dY", "NP_dY"))
        found = roll_out(current, self.scaling, self.group)
        want = roll_out(following, self.scaling, late)
        self.assertTrue(torch.equal(found, want))
        self.assertFalse(torch.equal(found, roll_out(following, self.scaling, self.group)))

    def test_a_single_step_starts_from_the_true_displacement(self):
        still = network("NP_dY").float()
        with torch.no_grad():
            for p in still.parameters():
                p.zero_()
        found, u = single_steps(still, self.scaling, self.group), truth(self.group)
        self.assertLess(float((found[2:] - u[1:-1]).abs().max()), 1e-7)  # metres, scaled and back


def _delayed(drive):
    out = drive.copy()
    out[1:] = drive[:-1]
    return out


class Trained(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        torch.set_num_threads(1)
        cls.folder = tempfile.TemporaryDirectory()
        cls.data, cls.run_folder = (os.path.join(cls.folder.name, name) for name in ("data", "run"))
        os.makedirs(cls.data)
        support.write_data_set(cls.data)
        cls.code = trainer(["train", cls.data, "--out", cls.run_folder, "--form", "NP_Y", *cls.short("0.12"), "--updates", "250"])

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @staticmethod
    def short(minutes):
        return ["--minutes", minutes, "--channels", "16,3", "--batch", "6", *paper_forms.ALONE]

    @property
    def weights(self):
        return os.path.join(self.run_folder, "weights.safetensors")

    def test_a_few_seconds_beat_skinning(self):
        self.assertEqual(self.code, 0)
        with open(os.path.join(self.run_folder, "curve.json")) as file:
            self.assertLess(json.load(file)["best"], 0.9)  # mean of two roll-out lengths; 0.7 usually

    def test_weights_come_back_as_the_form_they_are(self):
        model, scaling, metadata = read_weights(self.weights)
        said = (model.form, metadata["sinew.model"], metadata["base"])
        self.assertEqual(said, ("NP_Y", "conv_lstm", "none"))
        self.assertIn("base", scaling.without)
        self.assertEqual(model.options.channels, (16, 3))

    def test_weights_of_an_unknown_form_are_refused_by_name(self):
        path = os.path.join(self.folder.name, "odd.safetensors")
        tensors, metadata = load(self.weights)
        save(path, tensors, {**metadata, "form": "XP_Y"})
        with self.assertRaisesRegex(BadData, "odd.safetensors: metadata form is 'XP_Y'"):
            read_weights(path)

    def test_the_runtime_does_not_run_it_so_it_is_not_exported(self):
        out = os.path.join(self.folder.name, "weights")
        with self.assertRaisesRegex(BadData, "holds conv_lstm"):
            export(self.run_folder, self.data, {}, out, "odd", "network", support.BODY)
        self.assertFalse(os.path.exists(out))

    def test_forced_training_goes_on_from_the_truth(self):
        groups = [dataset.group(dataset.read_split(self.data, s)) for s in ("train", "validation")]
        for without in (("base", "base_step", "turn"), ()):
            options = TrainOptions(batch=6, window=15, without=without, teacher_forced=True)
            forced = Trainer(*groups, options, lambda *a, **k: None)
            episode = forced.new_episode()
            forced.update(episode)
            starts = torch.full((episode.size,), 14)
            true = episode.group.window(episode.sequences, starts, 1)[3][0] * ~episode.still[:, None]
            self.assertEqual(float((episode.state.base.u - true).abs().max()), 0)

    def test_an_unknown_form_is_refused_before_training(self):
        out = os.path.join(self.folder.name, "none")
        self.assertEqual(trainer(["train", self.data, "--out", out, "--form", "XP_Y"]), 2)
        self.assertFalse(os.path.exists(out))

    def test_one_command_compares_the_forms(self):
        chosen = {k: paper_forms.VARIANTS[k] for k in ("ConvLSTM CP Y", "ConvLSTM NP ΔY, single steps")}
        small = {k: v + self.short("0.02")[:6] for k, v in chosen.items()}
        page = os.path.join(self.folder.name, "page")
        with mock.patch.object(paper_forms, "VARIANTS", small):
            work = ["--work", os.path.join(self.folder.name, "work"), "--processes", "1"]
            code = trainer(["vanilla", self.data, "--body", support.BODY, *work, "--out", page])
        self.assertEqual(code, 0)
        with open(os.path.join(page, "vanilla.json")) as file:
            rows = json.load(file)["rows"]
        self.assertEqual(list(rows)[:2], list(small))
        self.assertEqual(rows["skinning"]["50"]["ratio"], 1)
        for name in small:
            self.assertIn("single step", rows[name])
        with open(os.path.join(page, "vanilla.csv"), encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertIn(("ConvLSTM NP ΔY, single steps", "50"), [(r["model"], r["ticks"]) for r in table])
        (skinning,) = [r for r in table if (r["model"], r["ticks"]) == ("skinning", "50")]
        self.assertEqual(float(skinning["ratio"]), 1)
        self.assertEqual(sorted(os.listdir(page)), ["vanilla.csv", "vanilla.json", "vanilla.png"])
        self.assertGreater(os.path.getsize(os.path.join(page, "vanilla.png")), 1000)


class Refused(unittest.TestCase):
    def test_a_body_without_test_motions_is_refused_before_training(self):
        with tempfile.TemporaryDirectory() as folder:
            support.write_data_set(folder, train_count=1, validation=1, test=0)
            work = os.path.join(folder, "work")
            for command in ("vanilla", "ablate"):
                where = ["--body", support.BODY, "--work", work, "--out", os.path.join(folder, "page")]
                self.assertEqual(trainer([command, folder, *where]), 2)
                self.assertFalse(os.path.exists(work))


class Table(unittest.TestCase):
    def test_a_figure_that_is_no_number_is_empty(self):
        finite = paper_forms._finite({"mean_mm": float("inf"), "sd_mm": 1.0, "ratio": float("nan")})
        self.assertEqual(finite, {"mean_mm": None, "sd_mm": 1.0, "ratio": None})
        (row,) = paper_forms._csv_rows({"ConvLSTM NP Y": {"parameters": 7, "600": finite}})
        self.assertEqual(row, ["ConvLSTM NP Y", 7, "600", None, 1.0, None])


if __name__ == "__main__":
    unittest.main()
