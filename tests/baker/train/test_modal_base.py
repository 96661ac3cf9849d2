"""The modal base follows its equations: against closed forms, against steps written out, and in a mirror."""
import copy
import unittest

import support

support.leave_without_torch()
import numpy as np  # noqa: E402
import torch  # noqa: E402

import synthetic  # noqa: E402
from train.data.dataset import Union  # noqa: E402
from train.learn.scaling import measure_scaling  # noqa: E402
from train.model import modal_base  # noqa: E402
from train.model.alt_conv_lstm import AltConvLSTM, ModelOptions  # noqa: E402
from train.model.inputs import AXIAL, INPUT_WIDTH, ORDER, WIDTH, columns  # noqa: E402
from train.model.modal_base import ModalBase, recurrence, turned, warped  # noqa: E402
from train.model.rollout import error_ratio, mirror_signs, roll_out, truth  # noqa: E402

TICK_S = 1 / 60
DOUBLE = dict(dtype=torch.float64)
SERIES = 1e-5  # rad of a unit vector: a hundredth of a millimetre on a decimetre
FLOAT_ROLL_OUT = 1e-5  # of the displacement: rounding of 1e-7, gathered over some twenty ticks of memory
POLAR, AXIAL_SIGNS = torch.tensor([-1.0, 1, 1]), torch.tensor([1.0, -1, -1])


def without_ridge(base):
    """A base whose modal coordinates are exact for what its modes can do."""
    base = copy.copy(base)
    base.project = torch.linalg.pinv(base.shape)
    return base


def swung(w, zeta, q, v, ticks):
    """q at the ticks of q'' + 2 zeta w q' + w^2 q = 0, by its closed form, damped above or below 1."""
    root = w * np.sqrt(np.asarray(zeta**2 - 1, complex))
    first, second = root - zeta * w, -root - zeta * w
    share = (v - second * q) / (first - second)
    t = TICK_S * np.arange(ticks)[:, None]
    return (share * np.exp(first * t) + (q - share) * np.exp(second * t)).real


class Recurrence(unittest.TestCase):
    def setUp(self):
        generator = np.random.default_rng(0)
        self.w, self.zeta = generator.uniform(1, 180, 40), generator.uniform(1e-3, 1.5, 40)

    def of(self):
        return [v.numpy() for v in recurrence(torch.tensor(self.w), torch.tensor(self.zeta), TICK_S)]

    def test_is_a_free_oscillator_at_the_ticks(self):
        a1, a2, _ = self.of()
        q = swung(self.w, self.zeta, np.ones(40), np.full(40, 3.0), 30)
        np.testing.assert_allclose(q[2:], a1 * q[1:-1] + a2 * q[:-2], atol=1e-10)

    def test_comes_to_rest_at_the_static_answer(self):
        a1, a2, gain = self.of()
        q = before = np.zeros(40)
        for _ in range(3000):
            q, before = a1 * q + a2 * before + gain, q
        damped = self.zeta * self.w > 1
        np.testing.assert_allclose(q[damped], 1 / self.w[damped] ** 2, rtol=1e-9)
        np.testing.assert_allclose(gain / (1 - a1 - a2), 1 / self.w**2, rtol=1e-9)

    def test_answers_at_once_where_it_swings_faster_than_ticks_can_tell(self):
        w = torch.tensor([190.0, 377.0], **DOUBLE)
        a1, a2, gain = recurrence(w, torch.full_like(w, 0.1), TICK_S)
        self.assertEqual(a1.tolist() + a2.tolist(), [0, 0, 0, 0])
        np.testing.assert_allclose(gain.numpy(), 1 / w.numpy() ** 2)

    def test_answers_as_a_free_mass_where_the_spring_is_weak(self):
        values = recurrence(*(torch.tensor([x], **DOUBLE) for x in (1e-3, 0.0)), TICK_S)
        np.testing.assert_allclose(torch.cat(values).numpy(), [2, -1, TICK_S**2], rtol=1e-5)

    def test_leaves_out_modes_that_are_not_there(self):
        for value in recurrence(torch.zeros(2), torch.zeros(2), TICK_S):
            self.assertEqual(value.tolist(), [0, 0])


class Warping(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(0)
        theta = torch.randn(300, 3, **DOUBLE)
        self.theta = theta / theta.norm(dim=-1, keepdim=True) * torch.linspace(0, 2, 300, **DOUBLE)[:, None]
        self.v = torch.nn.functional.normalize(torch.randn(300, 3, **DOUBLE), dim=-1)
        self.generator = torch.tensor(synthetic.skew(self.theta.numpy()))

    def largest(self, found, matrix):
        return float((found - (matrix @ self.v[..., None])[..., 0]).norm(dim=-1).max())

    def test_turns_by_the_exponential_up_to_two_radians(self):
        turn, back = torch.matrix_exp(self.generator), torch.matrix_exp(-self.generator)
        self.assertLess(self.largest(turned(self.theta, self.v), turn), SERIES)
        self.assertLess(self.largest(turned(self.theta, self.v, transposed=True), back), SERIES)

    def test_warps_by_the_mean_of_the_turns_on_the_way(self):
        block = torch.zeros(300, 6, 6, **DOUBLE)  # exp [[A, 1], [0, 0]] holds the integral of exp (s A)
        block[:, :3, :3], block[:, :3, 3:] = self.generator, torch.eye(3, **DOUBLE)
        self.assertLess(self.largest(warped(self.theta, self.v), torch.matrix_exp(block)[:, :3, 3:]), SERIES)

    def test_holds_the_turn_at_two_radians(self):
        long = modal_base.held(self.theta * 3)
        self.assertAlmostEqual(float(long.norm(dim=-1).max()), modal_base.LARGEST_TURN, places=6)
        self.assertLess(float(torch.cross(long, self.theta, dim=-1).norm(dim=-1).max()), 1e-12)
        self.assertTrue(torch.equal(modal_base.held(self.theta * 0.9), self.theta * 0.9))

    def test_unwarping_undoes_it(self):
        bases = support.synthetic_group((0,)).body.bases
        base = without_ridge(ModalBase(bases, synthetic.SIZES, TICK_S, **DOUBLE))
        q = 0.01 * torch.randn(2, synthetic.MODES, 5, **DOUBLE)
        rest = 1e-3 * torch.randn(2, synthetic.SIZES[0], 5, 3, **DOUBLE)
        state, _ = base.arrive(base.start(5), base._apply(base.shape, q) + rest, (q, rest))
        self.assertGreater(float(state.theta.norm(dim=-1).max()), 0.1)
        l, found = base.unwarped(state.u, rest)
        self.assertLess(float((l - state.l).abs().max()), 1e-6)
        self.assertLess(float((found - q).abs().max()), 1e-6)


class Base(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.exact = support.synthetic_group((0, 1), ticks=120, hardening=0)
        cls.group = support.synthetic_group((0, 1), ticks=60)
        cls.scaling = measure_scaling([cls.group])

    def setUp(self):
        """An untrained network, loud enough to be seen."""
        torch.manual_seed(0)
        self.model = AltConvLSTM(ModelOptions(INPUT_WIDTH, (6, 3), True, 0.3, 0.0, 0.2, 8.0)).eval()

    def test_follows_its_equations_written_out_in_double_precision(self):
        u, y = truth(self.exact), roll_out(None, None, self.exact)
        self.assertGreater(float(u.norm(dim=-1).max()), 0.03)
        self.assertLess(float((y - u).norm(dim=-1).max() / u.norm(dim=-1).max()), FLOAT_ROLL_OUT)

    def test_follows_them_without_warping_and_frame_terms(self):
        linear = support.synthetic_group((0,), ticks=60, hardening=0, linear=True)
        linear.base.warping = linear.base.frame_terms = False
        self.assertLess(error_ratio(roll_out(None, None, linear), truth(linear), 60), FLOAT_ROLL_OUT)

    def test_what_the_modes_leave_out_makes_the_static_answer_whole(self):
        """A steady pull ends where all modes of the eigenproblem would end, not only those that are kept."""
        pull = torch.tensor([0.3, -1, 0.5], **DOUBLE)
        bases = self.exact.body.bases
        base = ModalBase(bases, synthetic.SIZES, TICK_S, **DOUBLE)
        base.warping = base.frame_terms = False
        state, felt = base.start(1), base.start(1).u + pull
        for _ in range(2000):
            answer, l, _ = base.predict(state, felt, None)
            state, _ = base.arrive(state, l, answer)
        for r, (b, n) in enumerate(zip(bases, synthetic.SIZES)):
            whole = b["rest"] + (b["shape"] / b["rad_per_s"] ** 2) @ b["force"]
            want = (whole.astype(float) @ np.tile(pull.numpy(), n)).reshape(n, 3)
            np.testing.assert_allclose(state.u[r, :n, 0].numpy(), want, atol=1e-6 * np.abs(want).max())

    def test_a_free_node_flies_straight_however_its_frame_turns(self):
        """Without a spring, frame terms alone must keep R u on a straight line in the world."""
        n, ticks = 2, 30
        one, none = np.eye(3 * n), np.zeros((3 * n, 3 * n))
        basis = dict(rad_per_s=np.full(3 * n, 1e-4), damping_ratio=np.zeros(3 * n), shape=one, turn=none)
        basis.update(force=one, rest=none, rest_oscillator=np.ones(2), first=np.ones(2))
        base = ModalBase([basis], [n], TICK_S, **DOUBLE)
        generator = np.random.default_rng(1)
        frame, _ = synthetic.turn_and_mean(np.cumsum(generator.normal(size=(ticks, n, 3)) * 0.1, 0))
        frame[1] = frame[0]
        begin, step = generator.normal(size=(2, n, 3))
        world = begin + step * TICK_S * np.arange(ticks)[:, None, None]
        local = torch.tensor((frame.swapaxes(-1, -2) @ world[..., None])[..., 0])[:, None, :, None]
        frame = torch.tensor(frame)
        state = base.start(1)
        for t in (0, 1):
            q = base._gather(base.force, local[t])
            state, _ = base.arrive(state, local[t], (q, state.rest))
        for t in range(2, ticks):
            now = [(frame[t].transpose(-1, -2) @ frame[t - k])[None, :, None] for k in (1, 2)]
            answer, l, _ = base.predict(state, torch.zeros(1, n, 1, 3, **DOUBLE), now)
            state, _ = base.arrive(state, l, answer)
            self.assertLess(float((state.u - local[t]).abs().max()), 1e-6)  # what is left of the spring

    def test_a_union_moves_as_each_of_its_bodies_alone(self):
        other = support.synthetic_group((5, 6), ticks=60, body_seed=4)
        union = Union([self.group, other])
        # A product of another shape rounds otherwise on some processors; fed back by a network, that doubles
        # every five ticks.
        for net, ticks in ((None, 40), (self.model, 20)):
            whole = self._run(union, net, self.scaling, torch.tensor([[0, 1], [1, 0]]), ticks)
            first = self._run(self.group, net, self.scaling, torch.tensor([0, 1]), ticks)
            second = self._run(other, net, self.scaling, torch.tensor([1, 0]), ticks)
            for part, rows in ((first, slice(0, 2)), (second, slice(2, 4))):
                found = whole[:, rows, : part.shape[2]]
                self.assertLess(float((found - part).abs().max()), 1e-6 * float(part.abs().max()) + 1e-8)

    def _run(self, *roll_out):
        """(40, R, n, B, 3)"""
        return torch.stack([base.u for base in support.base_states(*roll_out)])

    def test_mirror_signs_undo_themselves_and_know_rotations(self):
        flip = mirror_signs()
        self.assertTrue(torch.equal(flip * flip, torch.ones(INPUT_WIDTH)))
        for name in ORDER:
            want = {1: torch.ones(1), 3: AXIAL_SIGNS if name in AXIAL else POLAR}[WIDTH[name]]
            self.assertTrue(torch.equal(flip[columns(name)], want), name)

    def test_a_mirrored_body_moves_as_the_bodys_mirror_image(self):
        mirrored = support.synthetic_group((0, 1), synthetic.mirrored, ticks=60)
        ours, theirs = roll_out(None, None, self.group), roll_out(None, None, mirrored)
        self.assertLess(float((ours * POLAR - theirs).abs().max()), 1e-5 * float(ours.abs().max()))

    def test_a_mirrored_network_sees_the_mirrored_body(self):
        mirrored = support.synthetic_group((0, 1), synthetic.mirrored, ticks=60)
        s, signs = torch.tensor([0, 1]), mirror_signs().expand(2, -1)
        plain = self._run(self.group, self.model, self.scaling, s, 40)
        ours = self._run(self.group, self.model, self.scaling, s, 40, signs)
        theirs = self._run(mirrored, self.model, self.scaling, s, 40)
        size = float(plain.abs().max())
        self.assertLess(float((ours * POLAR - theirs).abs().max()), 1e-4 * size)  # fed back forty times
        self.assertGreater(float((ours - plain).abs().max()), 1e-2 * size)  # it tells left from right

    def test_driven_three_times_too_hard_it_stays_bounded_and_comes_to_rest(self):
        driven = roll_out(None, None, self.group, 600, gain=3.0, still_after=60)
        plain = roll_out(None, None, self.group)
        self.assertTrue(bool(torch.isfinite(driven).all()))
        times = float(driven.abs().max() / plain.abs().max())
        self.assertTrue(2 < times < 10, times)
        self.assertLess(float(driven[-1].abs().max()), 1e-4 * float(driven.abs().max()))

    def test_a_correction_within_the_modes_is_one_of_their_coordinates(self):
        base = without_ridge(self.group.base)
        state = support.base_states(self.group, None, self.scaling, torch.tensor([0, 1]), 30)[-1]
        change = 0.01 * torch.randn(2, synthetic.MODES, 2)
        found, _ = base.arrive(state, state.l, (state.q, state.rest), change)
        l = base._apply(base.shape, state.q + change) + state.rest
        want, _ = base.arrive(state, l, (state.q + change, state.rest))
        for name in ("l", "u", "q", "theta"):
            a, b = getattr(found, name), getattr(want, name)
            self.assertLess(float((a - b).abs().max()), 1e-5 * float(b.abs().max()), name)

    def test_a_silent_network_is_the_modal_base(self):
        for p in self.model.parameters():
            p.data.zero_()
        found, want = roll_out(self.model, self.scaling, self.group), roll_out(None, None, self.group)
        largest = float((found - want).abs().max())
        self.assertLess(largest, 1e-4 * float(want.abs().max()))  # rounding, fed back sixty times

    def test_a_standing_character_stays_exactly_at_rest(self):
        self.assertEqual(float(roll_out(None, None, self.group, 30, still_after=1).abs().max()), 0)

    def test_standing_at_the_truth_it_goes_on_as_the_truth(self):
        base, s, t = without_ridge(self.exact.base), torch.tensor([0, 1]), 30
        felt, _, turn, u = self.exact.window(s, s * 0, t + 1)
        there = support.base_states(self.exact, None, self.scaling, s, t)[-1]
        state, _ = base.stand_at(u[t - 1], u[t - 2], there)
        answer, l, _ = base.predict(state, felt[t], (turn[0][t], turn[1][t]))
        found = base.arrive(state, l, answer)[0].u
        self.assertLess(float((found - u[t]).abs().max()), 1e-3 * float(u[t].abs().max()))


if __name__ == "__main__":
    unittest.main()
