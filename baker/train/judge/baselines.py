"""What a network has to beat: plain models, fitted on the training roll-outs of the body they are judged on.

All are stable whatever the fit: frequencies and damping ratios are positive by construction, and the
recurrence is that of an oscillator (modal_base.recurrence)."""
import copy
import math

import numpy as np
import torch

from ..model.inputs import FELT
from ..model.modal_base import recurrence
from ..model.rollout import roll_out, start, tick, truth

ANGULAR_ACCELERATION = slice(9, 12)  # of a trajectory's drive
FIT_TICKS = 100
FIRST_SHARE = 0.4  # of an oscillator on its own: what a node moves for each unit of its region


def _fit(parameters, loss_of, iterations, rate):
    optimizer = torch.optim.Adam(parameters, rate)
    for i in range(iterations):
        optimizer.param_groups[0]["lr"] = rate * (0.05 + 0.475 * (1 + math.cos(math.pi * i / iterations)))
        loss = loss_of()
        optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(parameters, 1.0)
        optimizer.step()


class Springs:
    """u'' + 2 zeta w u' + w^2 u = w^2 (G f + H alpha) at each node: f felt, alpha angular acceleration.

    each_node: a frequency, a damping ratio and two 3 x 3 matrices a node; else one frequency, damping ratio
    and factor a region, alpha left out."""

    def __init__(self, group, each_node):
        self.each_node, g = each_node, group
        self.tick_s = g.base.tick_s
        self.region = torch.as_tensor(np.array(g.body.region)).long()
        n = len(self.region) if each_node else g.regions
        w = g.base.first[self.region] if each_node else g.base.first
        self.log_w = w.log().clone()
        self.log_zeta = torch.full((n,), math.log(0.1))
        self.unit = 1 / (w * w)  # s^2: the answer of an oscillator to a steady 1 m/s^2
        each = torch.full((n,), FIRST_SHARE)
        self.felt = each[:, None, None] * torch.eye(3) if each_node else each
        self.turning = torch.zeros(n, 3, 3) if each_node else None
        self.parameters = [self.log_w, self.log_zeta, self.felt] + ([self.turning] if each_node else [])
        for p in self.parameters:
            p.requires_grad_()

    def _goal(self, drive):
        """Where each node is pulled to, (T, N, B, 3) metres; drive (T, N, B, 15)."""
        f = drive[..., FELT]
        if not self.each_node:
            return f * (self.felt * self.unit)[self.region][None, :, None, None]
        pulled = torch.einsum("nij,tnbj->tnbi", self.felt, f)
        pulled = pulled + torch.einsum("nij,tnbj->tnbi", self.turning, drive[..., ANGULAR_ACCELERATION])
        return pulled * self.unit[:, None, None]

    def roll_out(self, drive):
        """drive (T+1, N, B, 15), the first at rest -> (T+1, N, B, 3) metres."""
        a1, a2, _ = recurrence(self.log_w.exp(), self.log_zeta.exp(), self.tick_s)
        if not self.each_node:
            a1, a2 = a1[self.region], a2[self.region]
        a1, a2 = a1[:, None, None], a2[:, None, None]
        goal = self._goal(drive) * (1 - a1 - a2)
        u = u_before = torch.zeros_like(goal[0])
        out = [u]
        for g in goal[1:]:
            u, u_before = a1 * u + a2 * u_before + g, u
            out.append(u)
        return torch.stack(out)

    def _of_regions(self, error, size):
        """Shares of displacement, by region: nodes at a rim hardly move and would ask for stillness."""
        total = lambda v: v.new_zeros(int(self.region.max()) + 1).index_add(0, self.region, v)
        return total(error) / total(size)

    def fit(self, group, iterations=120, batch=6):
        ticks = min(FIT_TICKS, group.ticks)

        def loss():
            s = torch.randperm(group.count)[:batch]
            drive = group.drive[s, : ticks + 1].permute(1, 2, 0, 3)
            true = group.displacement[s, : ticks + 1].permute(1, 2, 0, 3)
            error = ((self.roll_out(drive) - true).square().sum(-1) + 1e-12).sqrt().mean((0, 2))
            size = true.norm(dim=-1).mean((0, 2)).clamp(min=1e-5)
            return (error / size).mean() if self.each_node else self._of_regions(error, size).mean()

        _fit(self.parameters, loss, iterations, 0.03)
        return self

    def predict(self, group):
        """(T+1, N, B, 3) metres."""
        with torch.no_grad():
            return self.roll_out(group.drive.permute(1, 2, 0, 3))


class Modal:
    """The modes of the cage's eigenproblem. warped: as the networks' base, bent with the flesh and with the
    frames' exact terms; else linear and driven by the felt acceleration alone. fit() moves every mode's
    frequency, damping and drive."""

    def __init__(self, group, warped):
        self.base = copy.copy(group.base)
        self.base.frame_terms = self.base.warping = warped
        self.fitted = None

    def _use(self):
        b = self.base
        w, zeta, drive = (p.exp() for p in self.fitted)
        a1, a2, gain = recurrence(b.rad_per_s * w, b.damping_ratio * zeta, b.tick_s)
        b.a1, b.a2, b.gain = a1[..., None], a2[..., None], (gain * drive)[..., None]

    def _run(self, group, sequences, ticks):
        """Mean error of each region over a window from rest, as a share of its displacement."""
        felt, drive, turn, true = group.window(sequences, torch.zeros_like(sequences), ticks)
        state, error = start(None, group, len(sequences)), 0.0
        for t in range(ticks):
            state = tick(None, None, group, None, None, state, felt[t], drive[t], (turn[0][t], turn[1][t]))
            error = error + ((state.base.u - true[t]).square().sum(-1) + 1e-12).sqrt().mean((1, 2)) / ticks
        return (error / true.norm(dim=-1).mean((0, 2, 3)).clamp(min=1e-5)).mean()

    def fit(self, group, iterations=40, batch=6):
        self.fitted = [torch.zeros_like(self.base.rad_per_s).requires_grad_() for _ in range(3)]
        ticks, kept = min(FIT_TICKS, group.ticks), group.base

        def loss():
            self._use()
            return self._run(group, torch.randperm(group.count)[:batch], ticks)

        group.base = self.base
        try:
            _fit(self.fitted, loss, iterations, 0.02)
            with torch.no_grad():
                self._use()
        finally:
            group.base = kept
        return self

    def predict(self, group):
        """(T+1, N, B, 3) metres."""
        kept, group.base = group.base, self.base
        try:
            return roll_out(None, None, group)
        finally:
            group.base = kept


def plain_models(group, fit_on):
    """name -> model, of the body of `group`; those that need data are fitted on fit_on, a Group of the same
    body, and left out where that is None."""
    models = {"modal_linear": Modal(group, False), "modal_warped": Modal(group, True)}
    if fit_on is not None:
        torch.manual_seed(0)
        models["spring"] = Springs(fit_on, False).fit(fit_on)
        models["node_springs"] = Springs(fit_on, True).fit(fit_on)
        models["modal_linear_fitted"] = Modal(fit_on, False).fit(fit_on)
        models["modal_warped_fitted"] = Modal(fit_on, True).fit(fit_on)
    return models


def single_step(group):
    """Error of one tick from the true state, as a share of skinning's: the displacement held, and its
    velocity kept."""
    u = truth(group)
    size = u[2:].norm(dim=-1).mean()
    share = lambda p: round(float((p - u[2:]).norm(dim=-1).mean() / size), 4)
    return {"hold": share(u[1:-1]), "constant_velocity": share(2 * u[1:-1] - u[:-2])}
