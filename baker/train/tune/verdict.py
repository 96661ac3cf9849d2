"""Errors of the candidates on the held-out motions, which of them is baked, and the table that says so."""
from typing import NamedTuple

MARGIN = 0.05  # a network is baked where it leaves so much less than the base's error,
HARM = 0.05  # and nowhere so much more
BASE, TUNED = "modal base", "fine-tuned"


class Error(NamedTuple):
    """Distances to the truth, mean and 95th percentile; the mean, and that of velocities, as shares of skinning's."""

    mean_mm: float
    ratio: float
    p95_mm: float
    velocity_ratio: float


class Row(NamedTuple):
    """A held-out motion, or all of them together: its name, and the Error of each candidate by its name."""

    motion: str
    errors: dict

    def skinning_mm(self):
        return next((e.mean_mm / e.ratio for e in self.errors.values() if e.ratio > 0), 0.0)

    def of_base(self, name):
        return self.errors[name].ratio / self.errors[BASE].ratio


def worst(rows, name):
    """The motion on which a network is worst against the base, and its error over the base's there."""
    row = max(rows, key=lambda row: (not row.of_base(name) >= 0, row.of_base(name)))
    return row.motion, row.of_base(name)


def may_win(rows, all_of_them, name):
    """By compare, so that what is not finite never does."""
    return all_of_them.of_base(name) <= 1 - MARGIN and worst(rows, name)[1] <= 1 + HARM


def best_of(rows, all_of_them):
    """The name to bake."""
    able = [n for n in all_of_them.errors if n != BASE and may_win(rows, all_of_them, n)]
    return min(able, key=all_of_them.of_base, default=BASE)


def table(rows, all_of_them):
    """Lines: a motion each, and all together. In mm, and as a share of skinning's error; of networks also over the base's."""
    names = list(all_of_them.errors)
    rows = [*rows, all_of_them]
    width = max(len("held-out motion"), *(len(row.motion) for row in rows))
    head = "".join(f"  {n:>16}" + ("" if n == BASE else "  of base") for n in names)
    lines = [f"{'held-out motion':{width}}  {'skinning':>12}{head}"]
    for row in rows:
        cells = ""
        for n in names:
            cells += f"  {row.errors[n].mean_mm:7.3f} mm {row.errors[n].ratio:.3f}"
            cells += "" if n == BASE else f"  {row.of_base(n):7.3f}"
        lines.append(f"{row.motion:{width}}  {row.skinning_mm():9.3f} mm{cells}")
    return lines


def reason(winner, rows, all_of_them):
    """Why it is baked, in words and numbers."""
    base = all_of_them.errors[BASE].ratio
    if winner != BASE:
        own = all_of_them.errors[winner].ratio
        return f"the {winner} network, {own:.3f} of skinning's error; the modal base alone leaves {base:.3f}"
    others = []
    for name in all_of_them.errors:
        if name == BASE:
            continue
        motion, most = worst(rows, name)
        good = all_of_them.of_base(name) <= 1 - MARGIN
        others.append(f"{name} {all_of_them.errors[name].ratio:.3f}" + (f", but {most:.2f} of the base's in {motion}" if good else ""))
    return f"the modal base alone, {base:.3f}: no network is better by {MARGIN:.0%} and nowhere worse ({'; '.join(others)})"
