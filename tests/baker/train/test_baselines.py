"""Plain models are what they claim to be, fit what they can be, and are stable whatever the fit."""
import math
import unittest

import support

support.leave_without_torch()
import torch  # noqa: E402

from train.judge.baselines import Modal, Springs, plain_models, single_step  # noqa: E402
from train.model.modal_base import recurrence  # noqa: E402
from train.model.rollout import error_ratio, truth  # noqa: E402

LINEAR = dict(ticks=60, hardening=0, linear=True)


def ratio(model, group):
    return error_ratio(model.predict(group), truth(group), group.ticks)


def detuned(base, factor):
    """The same modes, `factor` times as fast."""
    rad_per_s = base.rad_per_s * factor
    values = recurrence(rad_per_s, base.damping_ratio, base.tick_s)
    base.rad_per_s = rad_per_s
    base.a1, base.a2, base.gain = (v[..., None] for v in values)


class Modes(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(0)

    def test_a_body_that_is_linear_modal_needs_no_fit(self):
        group = support.synthetic_group((0, 1), **LINEAR)
        self.assertLess(ratio(Modal(group, False), group), 1e-5)  # float against double
        self.assertGreater(ratio(Modal(group, True), group), 0.05)

    def test_a_body_that_bends_with_its_modes_needs_the_warped_ones(self):
        group = support.synthetic_group((0, 1), ticks=60, hardening=0)
        self.assertLess(ratio(Modal(group, True), group), 1e-5)
        self.assertGreater(ratio(Modal(group, False), group), 0.05)

    def test_fitting_finds_frequencies_again(self):
        group = support.synthetic_group((0, 1), **LINEAR)
        detuned(group.base, 1.15)
        before = ratio(Modal(group, False), group)
        self.assertLess(ratio(Modal(group, False).fit(group, 15, 2), group), 0.5 * before)

    def test_judging_leaves_the_groups_own_base_in_place(self):
        group = support.synthetic_group((0,), **LINEAR)
        base = group.base
        Modal(group, False).fit(group, 1, 1).predict(group)
        self.assertIs(group.base, base)
        self.assertTrue(base.warping and base.frame_terms)


class OneSpring(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(0)
        self.group = support.synthetic_group((0, 1, 2, 3), **LINEAR)

    def made_of(self, each_node):
        """Springs, and the group moved by them."""
        made = Springs(self.group, each_node)
        made.log_w.data += 0.2
        made.log_zeta.data.fill_(math.log(0.25))
        made.felt.data *= 1.5
        if each_node:
            made.turning.data.normal_(0, 0.05)
        self.group.displacement = made.predict(self.group).permute(2, 0, 1, 3).contiguous()
        return made

    def test_a_spring_a_region_is_found_again(self):
        made = self.made_of(False)
        fitted = Springs(self.group, False).fit(self.group)
        self.assertLess(ratio(fitted, self.group), 0.03)
        self.assertLess(float((fitted.log_w - made.log_w).abs().max()), 0.02)

    def test_a_spring_a_node_is_found_again(self):
        self.made_of(True)
        start = Springs(self.group, True)
        before = ratio(start, self.group)
        self.assertLess(ratio(start.fit(self.group), self.group), 0.3 * before)

    def test_a_steady_pull_is_answered_by_its_compliance(self):
        springs = Springs(self.group, False)
        springs.log_zeta.data.fill_(0.0)
        drive = torch.zeros(400, 16, 1, 12)
        drive[1:, :, :, :3] = torch.tensor([1.0, -2, 3])
        with torch.no_grad():
            found = springs.roll_out(drive)[-1, :, 0]
        want = (springs.felt * springs.unit)[springs.region][:, None] * torch.tensor([1.0, -2, 3])
        self.assertLess(float((found - want).abs().max()), 1e-4 * float(want.abs().max()))

    def test_is_stable_whatever_its_parameters(self):
        springs = Springs(self.group, True)
        for p in springs.parameters:
            p.data.normal_(0, 4)
        w, zeta = springs.log_w.exp().double(), springs.log_zeta.exp().double()
        a1, a2, _ = (v.detach() for v in recurrence(w, zeta, 1 / 60))
        companion = torch.stack([torch.stack([a1, a2], -1), torch.stack([a1 * 0 + 1, a1 * 0], -1)], -2)
        self.assertLess(float(torch.linalg.eigvals(companion).abs().max()), 1)


class All(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.group = support.synthetic_group((0, 1), ticks=50)
        torch.manual_seed(0)
        cls.fitted = {
            "spring": Springs(cls.group, False).fit(cls.group, 10),
            "node_springs": Springs(cls.group, True).fit(cls.group, 10),
            "modal_linear_fitted": Modal(cls.group, False).fit(cls.group, 4, 2),
            "modal_warped_fitted": Modal(cls.group, True).fit(cls.group, 4, 2),
        }

    def test_without_training_data_only_the_eigenproblems_models_are_judged(self):
        self.assertEqual(list(plain_models(self.group, None)), ["modal_linear", "modal_warped"])

    def test_driven_three_times_too_hard_and_left_alone_all_come_to_rest(self):
        driven = support.synthetic_group((0,), ticks=50)
        driven.drive = torch.cat([3 * driven.drive, torch.zeros(1, 550, *driven.drive.shape[2:])], 1)
        for name in ("rotation", "displacement"):
            a = getattr(driven, name)
            setattr(driven, name, torch.cat([a, a[:, -1:].expand(-1, 550, -1, -1)], 1))
        driven.ticks = 600
        for name, model in {**plain_models(driven, None), **self.fitted}.items():
            size = model.predict(driven).norm(dim=-1).amax((1, 2))
            self.assertLess(float(size.max()), 1.0, name)  # metres, of a body of a decimetre
            self.assertGreater(float(size[:51].max()), 0.01, name)
            self.assertLess(float(size[-1]), 1e-3 * float(size.max()), name)

    def test_a_single_step_keeps_a_steady_velocity_and_holds_what_stands(self):
        group = support.synthetic_group((0,), ticks=50)
        t = torch.arange(51.0)[:, None, None]
        group.displacement = (t * 1e-3).expand_as(group.displacement)
        mean = 26  # of 2 .. 50
        self.assertEqual(single_step(group), {"hold": round(1 / mean, 4), "constant_velocity": 0})


if __name__ == "__main__":
    unittest.main()
