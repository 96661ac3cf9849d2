"""What a network has to beat: one or two damped springs for each node and axis, fitted on the training
roll-outs."""
import math

import torch

from .inputs import DRIVE

FORCE_PARTS = (
    "linear_acceleration",
    "euler_acceleration",
    "centrifugal_acceleration",
    "articulation_acceleration",
    "gravity_change",
)
ROTATION_PARTS = ("euler_acceleration", "centrifugal_acceleration")


def forces(drive, split):
    """Raw drive (T+1, N, B, 21) to the accelerations of each spring, (springs, T+1, N, B, 3) m/s^2, looked
    half a tick ahead: 1.5 f_t - 0.5 f_{t-1} is the middle of the tick to come. split: rotation drives a
    spring of its own."""
    total = sum(drive[..., DRIVE[k]] for k in FORCE_PARTS)
    turning = sum(drive[..., DRIVE[k]] for k in ROTATION_PARTS)
    f = torch.stack([total - turning, turning] if split else [total])
    before = torch.cat([f[:, :1], f[:, :-1]], 1)
    return 1.5 * f - 0.5 * before


class Springs:
    """u'' = gain f - w^2 u - 2 zeta w u', solved exactly for a force that is constant over a tick.
    Parameters (springs, N, 1, 3)."""

    def __init__(self, group, split):
        self.split, self.tick_s = split, 1 / group.trajectories[0].rate_hz
        n = len(group.body.region)
        new = lambda value: torch.full((1 + split, n, 1, 3), value, device=group.device, requires_grad=True)
        self.log_w, self.logit_zeta, self.log_gain = new(math.log(2 * math.pi * 4)), new(-2.0), new(0.0)
        self.parameters = [self.log_w, self.logit_zeta, self.log_gain]

    def _transition(self):
        """(a, b, c, d, 1/w^2): u' = a u + b v, v' = c u + d v about the equilibrium."""
        w, zeta, h = (
            self.log_w.exp(),
            torch.sigmoid(self.logit_zeta),
            self.tick_s,
        )  # 0 < zeta < 1: stable whatever the fit
        wd = w * (1 - zeta * zeta).clamp(min=1e-4).sqrt()
        e, cos, sin = torch.exp(-zeta * w * h), torch.cos(wd * h), torch.sin(wd * h)
        return (
            e * (cos + zeta * w / wd * sin),
            e * sin / wd,
            -e * w * w / wd * sin,
            e * (cos - zeta * w / wd * sin),
            1 / (w * w),
        )

    def roll_out(self, force):
        """force (springs, T+1, N, B, 3) -> displacement (T+1, N, B, 3) metres, from rest."""
        a, b, c, d, give = self._transition()
        rest = force * (self.log_gain.exp() * give)[:, None]
        u, v = torch.zeros_like(rest[:, 0]), torch.zeros_like(rest[:, 0])
        out = [u.sum(0)]
        for t in range(1, rest.shape[1]):
            q = u - rest[:, t]
            u, v = rest[:, t] + a * q + b * v, c * q + d * v
            out.append(u.sum(0))
        return torch.stack(out)

    def fit(self, group, iterations=150, batch=8, ticks=150, rate=0.05):
        ticks, optimizer = min(ticks, group.ticks), torch.optim.Adam(self.parameters, rate)
        for i in range(iterations):
            optimizer.param_groups[0]["lr"] = rate * (
                0.05 + 0.95 * 0.5 * (1 + math.cos(math.pi * i / iterations))
            )
            s = torch.randperm(group.count)[:batch]
            drive = group.drive[s, : ticks + 1].permute(1, 2, 0, 3)
            true = group.displacement[s, : ticks + 1].permute(1, 2, 0, 3)
            error = (
                (self.roll_out(forces(drive, self.split)) - true)
                .square()
                .sum(-1)
                .add(1e-12)
                .sqrt()
                .mean((0, 2))
            )
            loss = (error / true.norm(dim=-1).mean((0, 2)).clamp(min=1e-6)).mean()
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
        return self

    def predict(self, group, sequences=None, ticks=None):
        """(T+1, N, B, 3) metres."""
        s = slice(None) if sequences is None else sequences
        end = None if ticks is None else ticks + 1
        with torch.no_grad():
            return self.roll_out(forces(group.drive[s, :end].permute(1, 2, 0, 3), self.split))


def fit_springs(group, split, seed=0):
    torch.manual_seed(seed)
    return Springs(group, split).fit(group)
