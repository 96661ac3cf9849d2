"""Runs a network on its own output, from rest, as the runtime does."""
import torch

from .dataset import drive_columns, input_columns
from .model import largest_cell


def roll_out(model, scaling, group, ticks=None, drive=None, sequences=None, watch=None):
    """Displacement (T+1, N, B, 3) metres of a group's sequences from rest.

    drive: raw, (T+1, R, n, B, 21), in place of the group's. watch: a dict that receives the largest |c| as
    'cell'."""
    s = torch.arange(group.count, device=group.device) if sequences is None else torch.as_tensor(sequences)
    ticks = ticks or (group.ticks if drive is None else len(drive) - 1)
    chunk, out, top = 200, [], 0.0
    with torch.no_grad():
        packed, static = model.packed(), group.static_columns(scaling, len(s))
        state = model.zero_state(group.regions, group.nodes, len(s))
        y = y_before = torch.zeros(group.regions, group.nodes, len(s), 3, device=group.device)
        out.append(group.flatten(y))
        for first in range(0, ticks, chunk):
            n = min(chunk, ticks - first)
            raw = (
                group.window(s, torch.full((len(s),), first, device=group.device), n)[0]
                if drive is None
                else drive[first : first + n + 1]
            )
            scaled = drive_columns(raw, scaling)
            for t in range(1, n + 1):
                z = input_columns(static, scaled[t], y, y_before, scaling)
                y_before = y
                y, state = model.step(packed, group.P, z, state, y)
                out.append(group.flatten(y))
                top = max(top, largest_cell(state)) if watch is not None else top
    if watch is not None:
        watch["cell"] = top
    return torch.stack(out) * scaling.length_unit_m


def truth(group, sequences=None):
    """Displacement (T+1, N, B, 3) metres."""
    d = group.displacement if sequences is None else group.displacement[sequences]
    return d.permute(1, 2, 0, 3)


def error_ratio(predicted, true, ticks):
    """Mean distance over ticks 1..ticks as a share of the mean displacement: 1 is skinning alone."""
    p, u = predicted[1 : ticks + 1], true[1 : ticks + 1]
    return float((p - u).norm(dim=-1).mean() / u.norm(dim=-1).mean())
