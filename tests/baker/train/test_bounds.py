"""What holds a network in training as at run time: the budget of its corrections and the limit of what is shown.
That they are the runtime's own is told by as_the_runtime.py."""
import math
import unittest

import support

support.leave_without_torch()
import torch  # noqa: E402

from train.model.correction import MOST_CORRECTION, Corrected, bounded_share, correct, none_yet  # noqa: E402
from train.model.limit import FREE_SHARE, limit_share, within  # noqa: E402
from train.model.modal_base import recurrence  # noqa: E402

REGIONS, MODES, BATCH, NODES = 2, 5, 3, 4
DOUBLE = dict(dtype=torch.float64)
ROUNDING = 1e-9  # of the budget, in double precision


class Base:
    """Modes that swing between 2 and 8 Hz, and one that creeps; a displacement is its coordinates."""

    def __init__(self):
        rad_per_s = 2 * math.pi * torch.linspace(2, 8, MODES, **DOUBLE).repeat(REGIONS, 1)
        damping = torch.full((REGIONS, MODES), 0.1, **DOUBLE)
        damping[:, -1] = 1.5
        self.a1, self.a2, _ = (v[..., None] for v in recurrence(rad_per_s, damping, 1 / 60))
        self.swings = (self.a1.square() + 4 * self.a2 < 0).to(self.a1)
        self.regions, self.modes, self.shape = REGIONS, MODES, self.a1
        self.project = None

    def _gather(self, _, change):
        return change

    def energy(self, now, before):
        terms = (now * now - self.a1 * now * before - self.a2 * before * before) / (1 - self.a1 - self.a2)
        return (terms * self.swings).sum(1)


class Budget(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(0)
        self.base = Base()

    def run_for(self, ticks, loud, stays=False, corrected=None):
        """Random corrections on random modes: of every tick (corrected, how much of p was taken)."""
        corrected = corrected or none_yet(self.base, BATCH)
        still = torch.full((REGIONS, BATCH), stays)
        out = []
        for _ in range(ticks):
            q, p = (size * torch.randn(REGIONS, MODES, BATCH, **DOUBLE) for size in (1, loud))
            taken, corrected = correct(self.base, corrected, q, p, still)
            out.append((corrected, taken / p))
        return out

    def test_what_is_corrected_never_holds_more_than_its_budget(self):
        for corrected, share in self.run_for(50, loud=3):
            held = self.base.energy(corrected.d, corrected.d_before)
            budget = MOST_CORRECTION**2 * corrected.swing
            self.assertTrue(bool((held <= budget * (1 + ROUNDING)).all()))
            self.assertLess(float(share.max()), 1)
        self.assertTrue(bool((held > 0.5 * budget).all()), "nothing was spent, so nothing was shown")

    def test_small_corrections_are_taken_whole_and_creeping_modes_take_none(self):
        for _, share in self.run_for(20, loud=1e-3):
            self.assertTrue(torch.equal(share[:, :-1], torch.ones(REGIONS, MODES - 1, BATCH, **DOUBLE)))
            self.assertFalse(share[:, -1].any())

    def test_at_rest_nothing_is_taken(self):
        (corrected, share), *_ = self.run_for(1, loud=1, stays=True)
        self.assertFalse(share.any() or corrected.d.any())

    def test_under_a_pose_that_stays_the_budget_fades(self):
        moved = self.run_for(30, loud=1)[-1][0]
        still = self.run_for(240, loud=1, stays=True, corrected=moved)[-1][0]
        self.assertLess(float(still.d.abs().max()), 1e-2 * float(moved.d.abs().max()))

    def test_its_gradient_is_that_of_finite_differences(self):
        corrected = self.run_for(10, loud=1)[-1][0]
        p = torch.randn(REGIONS, MODES, BATCH, **DOUBLE, requires_grad=True)
        share = lambda p: bounded_share(self.base.a1, self.base.a2, corrected, corrected.swing, p)
        self.assertTrue(bool((share(p) < 1).any()))
        self.assertTrue(torch.autograd.gradcheck(share, p))

    def test_sequences_are_kept_or_taken_from_another(self):
        ours, theirs = (self.run_for(3, loud=1)[-1][0] for _ in range(2))
        mixed = ours.where(torch.tensor([True, False, True]), theirs)
        for name in ("d", "d_before", "swing"):
            a, b, c = (getattr(one, name)[..., 1] for one in (mixed, theirs, ours))
            self.assertTrue(torch.equal(a, b) and not torch.equal(a, c))
        self.assertIsInstance(mixed, Corrected)


class Limit(unittest.TestCase):
    def of(self, largest, limit=1.0):
        return float(limit_share(torch.tensor(largest, **DOUBLE), torch.tensor(limit, **DOUBLE))) * largest

    def test_what_is_far_below_is_left_alone(self):
        self.assertEqual([self.of(x) for x in (0.0, 0.3, FREE_SHARE)], [0.0, 0.3, FREE_SHARE])

    def test_what_goes_beyond_approaches_it_without_a_step(self):
        lengths = torch.linspace(0.5, 3, 400).tolist()
        shown = [self.of(x) for x in lengths]
        self.assertTrue(all(a <= b for a, b in zip(shown, shown[1:])))
        self.assertTrue(0.99 < shown[-1] <= 1)
        self.assertLess(max(b - a for a, b in zip(shown, shown[1:])), 1.01 * (lengths[1] - lengths[0]))
        self.assertAlmostEqual(self.of(0.8), 0.6 + 0.4 * math.tanh(0.5))

    def test_without_one_everything_is_shown(self):
        self.assertEqual(self.of(1e9, math.inf), 1e9)

    def test_a_region_is_scaled_by_its_own_largest_displacement(self):
        u = torch.zeros(REGIONS, NODES, BATCH, 3, **DOUBLE)
        u[0, 1, 0] = torch.tensor([0, 3.0, 0])
        u[0, 2, 0] = torch.tensor([0.3, 0, 0])
        u[1, 0, 1] = 0.1
        shown = within(torch.tensor([1.0, math.inf], **DOUBLE), u)
        self.assertTrue(torch.equal(shown[1], u[1]))
        self.assertTrue(0.99 < float(shown[0, 1, 0, 1]) < 1)
        self.assertAlmostEqual(float(shown[0, 2, 0, 0] / shown[0, 1, 0, 1]), 0.1)

    def test_its_gradient_is_that_of_finite_differences(self):
        u = torch.randn(REGIONS, NODES, BATCH, 3, **DOUBLE, requires_grad=True)
        self.assertTrue(torch.autograd.gradcheck(lambda u: within(torch.tensor([0.5, math.inf], **DOUBLE), u), u))


if __name__ == "__main__":
    unittest.main()
