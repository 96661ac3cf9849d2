"""Errors of the candidates on the held-out motions, which of them is baked, and the table that says so."""
from dataclasses import dataclass

MARGIN = 0.05  # a network is baked where it leaves so much less than the base's error
BASE, TUNED = "modal base", "fine-tuned"


@dataclass
class Row:
    """One held-out motion: its name, and of each candidate (error in mm, ratio to skinning's)."""

    motion: str
    errors: dict

    def skinning_mm(self):
        return next((mm / ratio for mm, ratio in self.errors.values() if ratio > 0), 0.0)


def pooled(rows):
    """name -> (mean error in mm, ratio) over all motions, which are equally long."""
    skinning = sum(row.skinning_mm() for row in rows)
    sums = {name: sum(row.errors[name][0] for row in rows) for name in rows[0].errors}
    return {name: (mm / len(rows), mm / skinning) for name, mm in sums.items()}


def best_of(errors):
    """The name to bake. A ratio that is not finite never wins."""
    networks = {name: ratio for name, (_, ratio) in errors.items() if name != BASE}
    name = min(networks, key=lambda n: (not networks[n] >= 0, networks[n]), default=BASE)
    return name if networks and networks[name] <= (1 - MARGIN) * errors[BASE][1] else BASE


def table(rows):
    """Lines: a motion each, and all together. In mm, and as a share of skinning's error."""
    names = list(rows[0].errors)
    width = max(len("held-out motion"), *(len(row.motion) for row in rows))
    lines = [f"{'held-out motion':{width}}  {'skinning':>12}" + "".join(f"  {n:>16}" for n in names)]

    def line(motion, skinning_mm, errors):
        cells = "".join(f"  {mm:7.3f} mm {ratio:.3f}" for mm, ratio in (errors[n] for n in names))
        lines.append(f"{motion:{width}}  {skinning_mm:9.3f} mm{cells}")

    for row in rows:
        line(row.motion, row.skinning_mm(), row.errors)
    line("all", sum(row.skinning_mm() for row in rows) / len(rows), pooled(rows))
    return lines


def reason(winner, errors):
    """Why it is baked, in words and numbers."""
    base, own = errors[BASE][1], errors[winner][1]
    if winner != BASE:
        return f"the {winner} network, {own:.3f} of skinning's error; the modal base alone leaves {base:.3f}"
    others = ", ".join(f"{name} {ratio:.3f}" for name, (_, ratio) in errors.items() if name != BASE)
    return f"the modal base alone, {base:.3f}: no network is better by {MARGIN:.0%} ({others})"
