"""The modal base that a network corrects (runtime/tissue/modes/modal_base.hpp), for batches of sequences.

Shapes: R regions of n nodes, K modes, B sequences. Displacements are (R, n, B, 3) in metres along the nodes'
own frames; l is what the modes add up to, u the same after warping (Choi and Ko 2005) and as far as it may be shown."""
import math
from dataclasses import dataclass

import numpy as np
import torch

from .limit import swing_share, within

LARGEST_TURN = 2.0  # rad: beyond it a linear turn means nothing
PROJECTION_RIDGE = 1e-3  # shapes of one region are far from independent at few nodes


def projection(shape, rad_per_s):
    """(K, 3n): the modal coordinates of a displacement, those with little energy first."""
    ridge = PROJECTION_RIDGE * len(shape) / 3 * np.diag((rad_per_s / rad_per_s[0]) ** 2)
    return np.linalg.solve(shape.T @ shape + ridge, shape.T)


def recurrence(rad_per_s, damping_ratio, tick_s):
    """a1, a2, gain of q_t = a1 q_{t-1} + a2 q_{t-2} + gain p, the oscillator's own poles, damped below or above
    the critical ratio 1. What swings by half a turn and more in a tick answers at once. Tensors of any one
    shape; zero where rad_per_s is."""
    swung, below = rad_per_s * tick_s, 1 - damping_ratio.square()
    decay, root = damping_ratio * swung, swung * below.abs().clamp(min=1e-12).sqrt()
    swings, creeps = 2 * (-decay).exp() * root.cos(), (root - decay).clamp(max=0).exp() + (-root - decay).exp()
    a1, a2 = torch.where(below >= 0, swings, creeps), -(-2 * decay).exp()
    remembers = ((swung > 0) & ((below < 0) | (root < math.pi))).to(swung.dtype)
    a1, a2, there = a1 * remembers, a2 * remembers, (swung > 0).to(swung.dtype)
    return a1, a2, (1 - a1 - a2) / rad_per_s.square().clamp(min=1e-12) * there


def cross(a, b):
    """torch.cross over the last axis; four times faster on a CPU."""
    ax, ay, az = a.unbind(-1)
    bx, by, bz = b.unbind(-1)
    return torch.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], -1)


def _length(theta):
    """|theta|, never zero, and its square."""
    squared = theta.square().sum(-1, keepdim=True).clamp(min=1e-12)
    return squared.sqrt(), squared


def _less_cosine(x, squared):
    """(1 - cos x) / x^2, by half the angle, which cancels nothing."""
    return 2 * (0.5 * x).sin().square() / squared


def turned(theta, v, transposed=False):
    """exp([theta]x) v, or its transpose times v."""
    x, squared = _length(theta)
    sine, first = x.sin() / x, cross(theta, v)
    return v + (-sine if transposed else sine) * first + _less_cosine(x, squared) * cross(theta, first)


def warped(theta, l):
    """The mean of exp(s [theta]x) l over s in 0..1: a linear displacement bent with the flesh's own turn."""
    x, squared = _length(theta)
    first = cross(theta, l)
    return l + _less_cosine(x, squared) * first + (x - x.sin()) / (squared * x) * cross(theta, first)


def held(theta):
    """No longer than LARGEST_TURN."""
    length = theta.square().sum(-1, keepdim=True).clamp(min=1e-12).sqrt()
    return theta * (LARGEST_TURN / length).clamp(max=1)


@dataclass
class BaseState:
    """Of the last two ticks: u (R, n, B, 3), q (R, K, B), and rest (R, n, B, 3), what the modes left out add to
    l; of the last: l, theta."""

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


def _of_region(basis, tick_s):
    """name -> tensor in double precision, of one region."""
    b = {k: torch.as_tensor(np.array(v, float)) for k, v in basis.items()}
    w = b["rad_per_s"]
    a1, a2, gain = (v[:, None] for v in recurrence(w, b["damping_ratio"], tick_s))
    rest_a1, rest_a2, _ = (v.view(1, 1, 1) for v in recurrence(*b["rest_oscillator"], tick_s))
    return {
        **dict(first=b["first"][0], rad_per_s=w, damping_ratio=b["damping_ratio"], a1=a1, a2=a2, gain=gain),
        **dict(shape=b["shape"], turn=b["turn"], force=b["force"]),
        "project": torch.as_tensor(projection(b["shape"].numpy(), w.numpy())),
        **dict(rest=b["rest"], rest_a1=rest_a1, rest_a2=rest_a2),
    }


def _side_by_side(rows):
    """Tensors of several regions as one (R, ...): zeros where one has fewer nodes or modes."""
    out = rows[0].new_zeros([len(rows)] + [max(sizes) for sizes in zip(*(r.shape for r in rows))])
    for to, row in zip(out, rows):
        to[tuple(slice(n) for n in row.shape)] = row
    return out


class ModalBase:
    """Of one body's regions. `bases`: for each a dict of what trajectory.BASIS names."""

    def __init__(self, bases, regions_nodes, tick_s, device="cpu", dtype=torch.float32):
        self.tick_s = tick_s
        self.frame_terms = self.warping = True  # off: the plain models of judge/baselines.py
        self.regions, self.nodes = len(bases), max(regions_nodes)
        self.limit = torch.full((self.regions,), math.inf, device=device, dtype=dtype)  # metres, of what is shown
        self.modes = max(len(b["rad_per_s"]) for b in bases)
        regions = [_of_region(b, tick_s) for b in bases]
        for name in regions[0]:
            setattr(self, name, _side_by_side([r[name] for r in regions]).to(device, dtype))
        self._tell_swings()

    def _tell_swings(self):
        """Which modes take corrections: a budget's proof wants that they swing."""
        self.swings = (self.a1.square() + 4 * self.a2 < 0).to(self.a1.dtype)

    @classmethod
    def union(cls, bases):
        """Regions of several bodies, one after the other."""
        out = cls.__new__(cls)
        out.tick_s = bases[0].tick_s
        out.frame_terms = out.warping = True
        out.regions = sum(b.regions for b in bases)
        out.nodes, out.modes = max(b.nodes for b in bases), max(b.modes for b in bases)
        for name in [k for k, v in vars(bases[0]).items() if torch.is_tensor(v)]:
            setattr(out, name, _side_by_side([row for b in bases for row in getattr(b, name)]))
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

    def predict(self, state, felt, turn_now, corrected=None):
        """What the modes alone do in a tick: (q, what the modes left out add to l), l, and the force along the turned
        flesh that drove them. felt (R, n, B, 3) m/s^2. turn_now: R_t^T R_{t-1} and R_t^T R_{t-2}, each
        (R, n, B, 3, 3). corrected (R, K, B): what a network moved the modes by, which does not turn the force."""
        f = felt + self._frame_term(state, turn_now) if self.frame_terms else felt
        if self.warping:
            theta = state.theta if corrected is None else self._theta(state.q - corrected)
            f = turned(theta, f, transposed=True)
        q = self.a1 * state.q + self.a2 * state.q_before + self.gain * self._gather(self.force, f)
        goal = self._apply(self.rest, f.transpose(2, 3).reshape(self.regions, 3 * self.nodes, -1))
        swing = self.rest_a1 * state.rest + self.rest_a2 * state.rest_before
        rest = swing + (1 - self.rest_a1 - self.rest_a2) * goal
        return (q, rest), self._apply(self.shape, q) + rest, f

    def _frame_term(self, state, turn_now):
        """What a node feels of its frame's turning since u was there, m/s^2: exact for these ticks."""
        apply = lambda m, u: (m * u[..., None, :]).sum(-1)
        carried = 2 * apply(turn_now[0], state.u) - apply(turn_now[1], state.u_before)
        return (carried - (2 * state.u - state.u_before)) / self.tick_s**2

    def unwarped(self, u, rest):
        """l and q with warped(theta(q), l) = u, by a fixed point; good where turns stay below about 1 rad."""
        l = u
        for _ in range(12 if self.warping else 0):
            theta = self._theta(self._gather(self.project, l - rest))
            l = l + 0.8 * (u - warped(theta, l))
        return l, self._gather(self.project, l - rest)

    def stand_at(self, u, u_before, state):
        """The state of tissue that is at u and was at u_before a tick ago, and its l of then; what the modes
        left out add is taken from `state`."""
        l, q = self.unwarped(u, state.rest)
        l_before, q_before = self.unwarped(u_before, state.rest_before)
        theta = self._theta(q) if self.warping else torch.zeros_like(u)
        return BaseState(l, u, u_before, q, q_before, theta, state.rest, state.rest_before), l_before

    def _theta(self, q):
        return held(self._apply(self.turn, q))

    def arrive(self, state, l, answer, taken=None):
        """The state after a tick: the l and (q, rest) of predict(), and what a network moves the modes by, (R, K, B); and
        what its swing is held with, (R, B), which all else that goes on from the tick is to be scaled with."""
        q, rest = answer
        if taken is not None:
            l, q = l + self._apply(self.shape, taken), q + taken
        theta, whole = self._warped(q, l)
        share = swing_share(self.limit, whole)
        of_modes, of_nodes = share[:, None], share[:, None, :, None]
        if bool((share < 1).any()):
            l, q, rest = l * of_nodes, q * of_modes, rest * of_nodes
            theta, whole = self._warped(q, l)
        u = within(self.limit, whole)
        return BaseState(l, u, state.u, q, state.q * of_modes, theta, rest, state.rest * of_nodes), share

    def _warped(self, q, l):
        theta = self._theta(q) if self.warping else torch.zeros_like(l)
        return theta, warped(theta, l) if self.warping else l
