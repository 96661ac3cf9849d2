"""Input scales and envelopes, measured on the training data with the modal base running."""
import torch

from ..model.inputs import DRIVE, ORDER, STATIC, Scaling
from ..model.rollout import raw_inputs, start, tick

SCALED_SIZE = 0.3  # mean size of a scaled input
ENVELOPE_MARGIN = 1.2  # of the largest input seen in training
LENGTH_UNIT = 0.1  # region radii


def _round(value, digits=2):
    return float(f"{value:.{digits - 1}e}")


class Sizes:
    """Sum, count and largest of values by name."""

    def __init__(self):
        self.seen = {}

    def add(self, name, values):
        v = values.abs()
        total, count, top = self.seen.get(name, (0.0, 0, 0.0))
        self.seen[name] = (total + float(v.double().sum()), count + v.numel(), max(top, float(v.max())))

    def mean(self, name):
        return self.seen[name][0] / self.seen[name][1]

    def largest(self, name):
        return self.seen[name][2]


def _run_base(group, sizes):
    """What a network would be fed along the roll-outs of the modal base alone."""
    plain = Scaling({}, LENGTH_UNIT, {})
    s = torch.arange(group.count, device=group.device)
    state, mask = start(None, group, len(s)), group.mask
    with torch.no_grad():
        for first in range(0, group.ticks, 50):
            n = min(50, group.ticks - first)
            felt, drive, turn, _ = group.window(s, torch.full_like(s, first), n)
            for t in range(n):
                now = (turn[0][t], turn[1][t])
                _, l, force = group.base.predict(state.base, felt[t], now)
                for k, v in raw_inputs(group, plain, state.base, state.l_before, drive[t], l, force).items():
                    sizes.add(k, v[mask])
                state = tick(None, None, group, plain, None, state, felt[t], drive[t], now)


def measure_scaling(groups):
    """Scales from the mean size in the training data (a few violent motions would rule a mean square),
    envelopes from its largest values."""
    sizes = Sizes()
    for g in groups:
        _run_base(g, sizes)
        for k in STATIC:
            sizes.add(k, g.static[k][g.mask])
    of = lambda k: _round(SCALED_SIZE / sizes.mean(k)) if sizes.mean(k) > 1e-6 else 1.0
    scale = {k: 1.0 if k in STATIC else of(k) for k in ORDER}
    return Scaling(
        scale,
        LENGTH_UNIT,
        {k: max(1e-3, _round(ENVELOPE_MARGIN * sizes.largest(k) * scale[k], 4)) for k in ORDER},
    )
