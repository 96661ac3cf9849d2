"""The modal base that a network corrects (runtime/tissue/modal_base.hpp), for batches of sequences.

Shapes: R regions of n nodes, K modes, B sequences. Displacements are (R, n, B, 3) in metres along the nodes'
own axes; l is what the modes add up to, u the same after warping (Choi and Ko 2005)."""
from dataclasses import dataclass

import numpy as np
import torch

LARGEST_TURN = 2.0  # rad: beyond it a linear turn means nothing
# Of the modes' own turn: a cantilever bent evenly leaves its straight path by 2/3 of its tip's turn; this share
# validated best.
TURN_SHARE = 0.75
PROJECTION_RIDGE = 1e-3  # shapes of one region are far from independent at few nodes


def projection(shape, rad_per_s):
    """(K, 3n): the modal coordinates of a displacement, those with little energy first."""
    ridge = PROJECTION_RIDGE * len(shape) / 3 * np.diag((rad_per_s / rad_per_s[0]) ** 2)
    return np.linalg.solve(shape.T @ shape + ridge, shape.T)


def recurrence(rad_per_s, damping_ratio, tick_s, substeps):
    """a1, a2, gain of q_t = a1 q_{t-1} + a2 q_{t-2} + gain p: what `substeps` backward Euler steps make of an
    oscillator, as in the ground truth. Tensors of any one shape; zero where rad_per_s is."""
    w, h = rad_per_s, tick_s / substeps
    d = 1 + 2 * damping_ratio * w * h + (w * h) ** 2
    rows = [torch.stack([1 - (w * h) ** 2 / d, h / d], -1), torch.stack([-h * w * w / d, 1 / d], -1)]
    tick = torch.linalg.matrix_power(torch.stack(rows, -2), substeps)
    a1 = tick[..., 0, 0] + tick[..., 1, 1]
    a2 = tick[..., 0, 1] * tick[..., 1, 0] - tick[..., 0, 0] * tick[..., 1, 1]
    there = (w > 0).to(w.dtype)
    return a1 * there, a2 * there, (1 - a1 - a2) / (w * w).clamp(min=1e-12) * there


def cross(a, b):
    """torch.cross over the last axis; four times faster on a CPU."""
    ax, ay, az = a.unbind(-1)
    bx, by, bz = b.unbind(-1)
    return torch.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], -1)


def turned(theta, v, transposed=False):
    """exp([theta]x) v, or its transpose times v; series good to 1e-6 up to 2 rad."""
    s = theta.square().sum(-1, keepdim=True)
    sine = 1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110 * (1 - s / 156)))))
    cosine = 0.5 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90 * (1 - s / 132)))))
    first = cross(theta, v)
    return v + (-sine if transposed else sine) * first + cosine * cross(theta, first)


def warped(theta, l):
    """The mean of exp(s [theta]x) l over s in 0..1: a linear displacement bent with the flesh's own turn."""
    s = theta.square().sum(-1, keepdim=True)
    first_share = 0.5 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90 * (1 - s / 132)))))
    second_share = (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110 * (1 - s / 156))))) / 6
    first = cross(theta, l)
    return l + first_share * first + second_share * cross(theta, first)


def held(theta):
    """No longer than LARGEST_TURN."""
    length = theta.square().sum(-1, keepdim=True).clamp(min=1e-12).sqrt()
    return theta * (LARGEST_TURN / length).clamp(max=1)


@dataclass
class BaseState:
    """Of the last two ticks: u (R, n, B, 3), q (R, K, B), and what the modes left out add to l, rest (R, n, B,
    3); of the last: l, theta."""

    l: torch.Tensor
    u: torch.Tensor
    u_before: torch.Tensor
    q: torch.Tensor
    q_before: torch.Tensor
    theta: torch.Tensor
    rest: torch.Tensor
    rest_before: torch.Tensor

    def map(self, change):
        return BaseState(*(change(getattr(self, f)) for f in self.__dataclass_fields__))

    def where(self, kept, otherwise):
        """Sequences (B,) of this state where kept, else of the other."""
        pick = lambda a, b, shape: torch.where(kept.view(shape), a, b)
        return BaseState(
            *(
                pick(getattr(self, f), getattr(otherwise, f), (1, 1, -1) if f[0] == "q" else (1, 1, -1, 1))
                for f in self.__dataclass_fields__
            )
        )


class ModalBase:
    """Of one body's regions. `bases`: for each a dict of what trajectory.BASIS names."""

    def __init__(self, bases, regions_nodes, tick_s, substeps, device="cpu", dtype=torch.float32):
        R, n = len(bases), max(regions_nodes)
        K = max(len(b["rad_per_s"]) for b in bases)
        zeros = lambda *shape: torch.zeros(*shape, dtype=dtype)
        self.tick_s, self.substeps = tick_s, substeps
        self.frame_terms = self.warping = True  # off: the plain models of baselines.py
        self.rad_per_s, self.damping_ratio = zeros(R, K), zeros(R, K)
        self.shape, self.turn = zeros(R, 3 * n, K), zeros(R, 3 * n, K)
        self.force, self.project = zeros(R, K, 3 * n), zeros(R, K, 3 * n)
        self.rest, self.first, oscillator = zeros(R, 3 * n, 3 * n), zeros(R), zeros(R, 2)
        for r, b in enumerate(bases):
            k, m = len(b["rad_per_s"]), 3 * regions_nodes[r]
            put = lambda to, a: to.copy_(torch.as_tensor(np.array(a)))
            put(self.rad_per_s[r, :k], b["rad_per_s"])
            put(self.damping_ratio[r, :k], b["damping_ratio"])
            put(self.shape[r, :m, :k], b["shape"])
            put(self.turn[r, :m, :k], TURN_SHARE * np.asarray(b["turn"]))
            put(self.force[r, :k, :m], b["force"])
            put(self.rest[r, :m, :m], b["rest"])
            put(oscillator[r], b["rest_oscillator"])
            put(
                self.project[r, :k, :m],
                projection(np.asarray(b["shape"], float), np.asarray(b["rad_per_s"], float)),
            )
            self.first[r] = float(b["rad_per_s"][0])
        values = recurrence(self.rad_per_s.double(), self.damping_ratio.double(), tick_s, substeps)
        self.a1, self.a2, self.gain = (v.to(dtype)[..., None] for v in values)
        values = recurrence(oscillator[:, 0].double(), oscillator[:, 1].double(), tick_s, substeps)
        self.rest_a1, self.rest_a2 = (v.to(dtype)[:, None, None, None] for v in values[:2])
        for name, value in list(vars(self).items()):
            if torch.is_tensor(value):
                setattr(self, name, value.to(device))
        self.regions, self.nodes, self.modes = R, n, K

    @classmethod
    def union(cls, bases):
        """Regions of several bodies, one after the other, padded with nodes and modes that do nothing."""
        out = cls.__new__(cls)
        out.tick_s, out.frame_terms, out.warping = bases[0].tick_s, True, True
        out.regions, out.nodes, out.modes = (
            sum(b.regions for b in bases), max(b.nodes for b in bases), max(b.modes for b in bases)
        )
        tall, wide, one = (3 * out.nodes, out.modes), (out.modes, 3 * out.nodes), (out.modes, 1)
        size = dict(first=(), a1=one, a2=one, gain=one, shape=tall, turn=tall, force=wide, project=wide)
        size.update(rest=(tall[0], tall[0]), rest_a1=(1, 1, 1), rest_a2=(1, 1, 1))
        for name, shape in size.items():
            to = bases[0].shape.new_zeros((out.regions,) + shape)
            first = 0
            for b in bases:
                a = getattr(b, name)
                to[(slice(first, first + b.regions),) + tuple(slice(0, n) for n in a.shape[1:])] = a
                first += b.regions
            setattr(out, name, to)
        return out

    def _apply(self, matrix, q):
        """(R, 3n, K) on (R, K, B) -> (R, n, B, 3)."""
        return torch.bmm(matrix, q).view(self.regions, self.nodes, 3, -1).transpose(2, 3)

    def _gather(self, matrix, v):
        """(R, K, 3n) on (R, n, B, 3) -> (R, K, B)."""
        return torch.bmm(matrix, v.transpose(2, 3).reshape(self.regions, 3 * self.nodes, -1))

    def start(self, batch):
        zero = self.shape.new_zeros(self.regions, self.nodes, batch, 3)
        q = self.shape.new_zeros(self.regions, self.modes, batch)
        return BaseState(zero, zero, zero, q, q, zero, zero, zero)

    def predict(self, state, felt, turn_now):
        """What the modes alone do in a tick: q, what the modes left out add, and l of the next one, and the
        force in flesh axes that drove them. felt (R, n, B, 3) m/s^2. turn_now: R_t^T R_{t-1} and R_t^T R_{t-2}, each (R, n, B, 3, 3)."""
        if not self.frame_terms:
            f = turned(state.theta, felt, transposed=True) if self.warping else felt
            return self._drive(state, f)
        carried = sum(
            sign * (m * u[..., None, :]).sum(-1)
            for sign, m, u in ((2, turn_now[0], state.u), (-1, turn_now[1], state.u_before))
        )
        frame_term = (carried - (2 * state.u - state.u_before)) / self.tick_s**2
        f = felt + frame_term
        return self._drive(state, turned(state.theta, f, transposed=True) if self.warping else f)

    def _drive(self, state, f):
        q = self.a1 * state.q + self.a2 * state.q_before + self.gain * self._gather(self.force, f)
        goal = self._apply(self.rest, f.transpose(2, 3).reshape(self.regions, 3 * self.nodes, -1))
        swing = self.rest_a1 * state.rest + self.rest_a2 * state.rest_before
        rest = swing + (1 - self.rest_a1 - self.rest_a2) * goal
        return (q, rest), self._apply(self.shape, q) + rest, f

    def unwarped(self, u, rest):
        """l and q with warped(theta(q), l) = u, by a fixed point; good where turns stay below about 1 rad."""
        l = u
        for _ in range(12 if self.warping else 0):
            theta = held(self._apply(self.turn, self._gather(self.project, l - rest)))
            l = l + 0.8 * (u - warped(theta, l))
        return l, self._gather(self.project, l - rest)

    def stand_at(self, u, u_before, state):
        """The state of tissue that is at u and was at u_before a tick ago, and its l of then; what the modes
        left out add is taken from `state`."""
        l, q = self.unwarped(u, state.rest)
        l_before, q_before = self.unwarped(u_before, state.rest_before)
        theta = held(self._apply(self.turn, q)) if self.warping else torch.zeros_like(u)
        return BaseState(l, u, u_before, q, q_before, theta, state.rest, state.rest_before), l_before

    def arrive(self, state, l, answer, correction=None):
        """The state after a tick: l and the answer (q, rest) of predict(), and what a network adds to that l."""
        q, rest = answer
        if correction is not None:
            l, q = l + correction, q + self._gather(self.project, correction)
        if not self.warping:
            return BaseState(l, l, state.u, q, state.q, torch.zeros_like(l), rest, state.rest)
        theta = held(self._apply(self.turn, q))
        return BaseState(l, warped(theta, l), state.u, q, state.q, theta, rest, state.rest)
