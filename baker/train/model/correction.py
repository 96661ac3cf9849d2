"""How much of a network's correction a region takes (runtime/tissue/modes/correction_budget.hpp), for batches of sequences.

Shapes: R regions, K modes, B sequences; a1, a2 of the modes are (R, K, 1)."""
from dataclasses import dataclass

import torch

MOST_CORRECTION = 0.5  # kMostCorrection


@dataclass
class Corrected:
    """By how much corrections have moved the modal coordinates, as modes go on with it: (R, K, B) of the last two
    ticks. swing (R, B): what the budget goes by."""

    d: torch.Tensor
    d_before: torch.Tensor
    swing: torch.Tensor

    def map(self, change):
        return Corrected(change(self.d), change(self.d_before), change(self.swing))

    def scaled(self, share):
        """As if all had swung by so much, (R, B), less."""
        return Corrected(self.d * share[:, None], self.d_before * share[:, None], self.swing * share * share)

    def where(self, kept, otherwise):
        """Sequences (B,) of these where kept, else of the other."""
        return Corrected(*(torch.where(kept, a, b) for a, b in zip(self._all(), otherwise._all())))

    def _all(self):
        return self.d, self.d_before, self.swing


def none_yet(base, batch):
    q = base.shape.new_zeros(base.regions, base.modes, batch)
    return Corrected(q, q, q[:, 0])


def swung(base, corrected, alone, stays):
    """swing of this tick. alone (R, K, B): the modes without corrections; stays (R, B): whether the pose is that of the last
    two ticks."""
    fades = (-base.a2).amax(1).clamp(max=1) * corrected.swing
    return torch.where(stays, fades, torch.maximum(fades, alone.square().sum(1)))


def bounded_share(a1, a2, corrected, swing, p):
    """(R, B): the largest share of p (R, K, B) for which the energy of what is corrected stays within its budget."""
    weight, d = 1 / (1 - a1 - a2), corrected.d
    goes_on = a1 * d + a2 * corrected.d_before
    constant = (weight * (goes_on * goes_on - a1 * goes_on * d - a2 * d * d)).sum(1)
    linear = (weight * p * (goes_on - 0.5 * a1 * d)).sum(1)
    square = (weight * p * p).sum(1)
    room = MOST_CORRECTION**2 * swing - constant
    all_of_it = 2 * linear + square <= room
    some = (room > 0) & ~all_of_it & (square > 0)
    one = torch.ones_like(room)  # where what is asked has no root to take, any will do
    linear, square, room_left = (torch.where(some, v, one) for v in (linear, square, room))
    root = (linear * linear + square * room_left).sqrt()
    rising = linear > 0
    share = torch.where(rising, room_left / torch.where(rising, root + linear, one), (root - linear) / square)
    return torch.where(some, share.clamp(0, 1), ((room > 0) & all_of_it).to(share.dtype))


def correct(base, corrected, q, change, stays):
    """(what the modes take of a network's change (R, n, B, 3) of l, as their coordinates (R, K, B); what is corrected from
    then on). q: of the modes before it."""
    p = base._gather(base.project, change) * base.swings
    goes_on = base.a1 * corrected.d + base.a2 * corrected.d_before
    swing = swung(base, corrected, (q - goes_on).detach(), stays)
    taken = p * bounded_share(base.a1, base.a2, corrected, swing, p)[:, None]
    return taken, Corrected(goes_on + taken, corrected.d, swing)
