"""The trainer's network against the reference, and against its equations written out node by node."""
import importlib.util
import os
import unittest

import support

support.leave_without_torch()
import torch  # noqa: E402

from train.files.safetensors import load  # noqa: E402
from train.model.alt_conv_lstm import AltConvLSTM, ModelOptions, normalized_adjacency, with_more_channels  # noqa: E402
from train.model.weights import read_weights  # noqa: E402

PAPER_TOLERANCE = 1e-5  # float32 against float64 over the golden's steps
EQUATION_TOLERANCE = 1e-10  # double against double, two orders of summation


def _reference():
    path = os.path.join(support.SHARED, "reference", "alt_conv_lstm.py")
    if not os.path.exists(path):
        return None
    spec = importlib.util.spec_from_file_location("reference", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _sigmoid(x):
    return 1 / (1 + torch.exp(-x))


def _literal_step(model, P, z, states):
    """The equations of pack/format.hpp, one layer after the other; states: [h, c, y] a layer, updated in
    place."""
    o, x = model.options, z
    for l, (layer, s) in enumerate(zip(model.layers, states)):
        h, c, y = s
        f, last = layer.channels, l == len(states) - 1
        a = (P @ x) @ layer.W_x + (P @ h) @ layer.W_h + layer.b
        if layer.W_s is not None:
            a = a + x @ layer.W_s
        gate = _sigmoid(a[:, : 2 * f] + (P @ y) @ layer.W_y[:, : 2 * f])
        c = (gate[:, f:] * c + gate[:, :f] * torch.tanh(a[:, 2 * f : 3 * f])).clamp(
            -o.state_clamp, o.state_clamp
        )
        y = (1 - o.output_leak) * y + o.output_scale * c if last else (1 - o.hidden_leak) * y + c
        h = _sigmoid(a[:, 3 * f :] + (P @ y) @ layer.W_y[:, 2 * f :]) * torch.tanh(c)
        s[:] = [h, c, y]
        x = c
    return states[-1][2]


class Widening(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(0)
        self.narrow = AltConvLSTM(ModelOptions(9, (4, 3), True, 0.3, 0.0, 0.2, 8.0)).double()
        self.wide = with_more_channels(self.narrow, (10, 3))

    def run_of(self, model):
        torch.manual_seed(1)
        P, y = torch.rand(1, 6, 6, dtype=torch.float64) / 6, torch.zeros(1, 6, 2, 3, dtype=torch.float64)
        state, out = model.zero_state(1, 6, 2), []
        for _ in range(20):
            z = torch.randn(1, 6, 2, 9, dtype=torch.float64)
            y, state = model.step(model.packed(), P, z, state, y)
            out.append(y)
        return torch.stack(out)

    def test_a_widened_network_answers_as_before(self):
        self.assertEqual(self.wide.options.channels, (10, 3))
        narrow, wide = self.run_of(self.narrow), self.run_of(self.wide)
        self.assertLess(float((narrow - wide).abs().max()), EQUATION_TOLERANCE)
        self.assertGreater(float(wide.abs().max()), 0.1)

    def test_what_is_new_in_it_can_learn(self):
        self.run_of(self.wide).square().sum().backward()
        last = self.wide.layers[1]
        for rows in (last.W_x, last.W_s):
            self.assertFalse(rows[4:].any())
            self.assertTrue(bool(rows.grad[4:].any()))

    def test_a_network_as_wide_or_of_other_layers_stays_as_it_is(self):
        self.assertIs(with_more_channels(self.wide, (10, 3)), self.wide)
        self.assertIs(with_more_channels(self.wide, (8, 3)), self.wide)
        self.assertIs(with_more_channels(self.wide, (16, 8, 3)), self.wide)


class Model(unittest.TestCase):
    def test_reproduces_the_goldens_in_the_papers_wiring(self):
        folder = os.path.join(support.SHARED, "golden", "alt_conv_lstm")
        if not os.path.isdir(folder):
            self.skipTest(f"no goldens in {folder}; set SINEW_SHARED_DIR")
        for name in ("tiny", "small", "paper"):
            model, scaling, _ = read_weights(os.path.join(folder, f"{name}.weights.safetensors"))
            self.assertIsNone(scaling)
            v, _ = load(os.path.join(folder, f"{name}.vectors.safetensors"))
            self.assertLess(
                self._golden_error(model, {k: torch.tensor(a.copy()) for k, a in v.items()}),
                PAPER_TOLERANCE,
                name,
            )

    def _golden_error(self, model, v):
        n, x, y = v["x"].shape[1], v["x"], v["y0"][None, :, None]
        P = normalized_adjacency(n, v["edges"]).float()[None]
        state, worst, offset = model.zero_state(1, n, 1), 0.0, v["y0"] - v["x"][0]
        with torch.no_grad():
            for t in range(1, len(x)):
                z = torch.cat([x[t], x[t] - x[t - 1], offset], 1)[None, :, None]
                y, state = model.step(model.packed(), P, z, state, y, carry=(x[t] - x[t - 1])[None, :, None])
                worst = max(worst, float((y[0, :, 0] - v["y"][t - 1]).abs().max()))
        return worst

    def test_agrees_with_the_reference_module_for_random_weights(self):
        reference = _reference()
        if reference is None:
            self.skipTest("no reference/alt_conv_lstm.py; set SINEW_SHARED_DIR")
        torch.manual_seed(1)
        theirs = reference.AltConvLSTM((8, 4, 3)).double()
        ours = AltConvLSTM(ModelOptions(9, (8, 4, 3))).double()
        ours.load_state_dict(theirs.state_dict())
        n, edges = 7, [(i, i + 1) for i in range(6)]
        P, x = (
            reference.normalized_adjacency(n, edges, torch.float64),
            torch.randn(6, n, 3, dtype=torch.float64) * 0.1,
        )
        s, y, state = theirs.initial_state(n, x[0]), x[0][None, :, None], ours.zero_state(1, n, 1)
        s = [[v.double() for v in layer] for layer in s]
        for t in range(1, 6):
            want = theirs.step(P, s, x[t], x[t - 1], x[0] * 0)
            z = torch.cat([x[t], x[t] - x[t - 1], x[0] * 0], 1)[None, :, None]
            y, state = ours.step(
                ours.packed(),
                normalized_adjacency(n, edges)[None],
                z,
                state,
                y,
                (x[t] - x[t - 1])[None, :, None],
            )
            self.assertLess(float((y[0, :, 0] - want).abs().max()), EQUATION_TOLERANCE)

    def test_follows_the_equations_with_every_addition_on(self):
        torch.manual_seed(2)
        regions, n, batch = 2, 6, 3
        model = AltConvLSTM(ModelOptions(5, (7, 4, 3), True, 0.4, 0.03, 0.2, 0.6)).double()
        P = torch.stack([normalized_adjacency(n, [(i, (i + k) % n) for i in range(n)]) for k in (1, 2)])
        z = torch.randn(9, regions, n, batch, 5, dtype=torch.float64) * 2
        y, state = torch.zeros(regions, n, batch, 3, dtype=torch.float64), model.zero_state(regions, n, batch)
        literal = {
            (r, b): [
                [torch.zeros(n, layer.channels, dtype=torch.float64) for _ in range(3)]
                for layer in model.layers
            ]
            for r in range(regions)
            for b in range(batch)
        }
        with torch.no_grad():
            for step in z:
                y, state = model.step(model.packed(), P, step, state, y)
                for (r, b), s in literal.items():
                    want = _literal_step(model, P[r], step[r, :, b], s)
                    self.assertLess(float((y[r, :, b] - want).abs().max()), EQUATION_TOLERANCE)
        self.assertEqual(max(float(c.abs().max()) for _, c, _ in state), 0.6)  # the clamp was reached

    def test_a_padded_node_does_not_touch_the_others(self):
        torch.manual_seed(3)
        model, n = AltConvLSTM(ModelOptions(4, (5, 3), True)), 4
        P = torch.zeros(1, n + 2, n + 2)
        P[0, :n, :n] = normalized_adjacency(n, [(0, 1), (1, 2), (2, 3)]).float()
        z = torch.randn(1, n + 2, 1, 4)
        run = lambda k: model.step(
            model.packed(), P[:, :k, :k], z[:, :k], model.zero_state(1, k, 1), torch.zeros(1, k, 1, 3)
        )[0]
        with torch.no_grad():
            self.assertLess(float((run(n + 2)[:, :n] - run(n)).abs().max()), 1e-6)


if __name__ == "__main__":
    unittest.main()
