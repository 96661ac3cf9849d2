"""One tick of a network closed on its modal base, and whole roll-outs from rest, as the runtime runs them.

l_t = (what the modes make of l_{t-1}) + output_scale c_t: Alt-ConvLSTM's own Y_t = Y_{t-1} + C_t + (its
carry), with the modal base in the place of the skinning's motion."""
from dataclasses import dataclass, replace

import torch

from .inputs import AXIAL, CROSSED, DRIVE, INPUT_WIDTH, ORDER, STATIC, STATIC_WIDTH, WIDTH, columns
from .modal_base import BaseState, cross
from .model import largest_cell


@dataclass
class State:
    base: BaseState
    l_before: torch.Tensor  # (R, n, B, 3) metres
    memory: list  # of the network


def bounded(values, name, scaling):
    """value x scale, clamped as the runtime clamps it."""
    if name in scaling.without:
        return torch.zeros_like(values)
    return (values * scaling.scale[name]).clamp(-scaling.envelope[name], scaling.envelope[name])


def static_columns(group, scaling, batch):
    """(R, n, B, 8), scaled and held in the envelope."""
    parts = [bounded(group.static[k], k, scaling) for k in STATIC]
    return torch.cat(parts, -1)[:, :, None].expand(-1, -1, batch, -1)


def moving_columns(raw, scaling):
    """What changes from tick to tick, side by side: scaled and held in the envelope as by bounded()."""
    names = [k for k in ORDER if k in raw]
    row = lambda of: torch.tensor([of(k) for k in names for _ in range(WIDTH[k])], device=raw[names[0]].device)
    scale = row(lambda k: 0.0 if k in scaling.without else scaling.scale[k])
    most = row(lambda k: scaling.envelope[k])
    return (torch.cat([raw[k] for k in names], -1) * scale).clamp(-most, most)


def mirror_signs(device="cpu"):
    """(INPUT_WIDTH,): left to right flips x of vectors, and y and z of rotation vectors."""
    flip = torch.ones(INPUT_WIDTH, device=device)
    for name in ORDER:
        if WIDTH[name] == 3:
            signs = [1.0, -1, -1] if name in AXIAL else [-1.0, 1, 1]
            flip[columns(name)] = torch.tensor(signs, device=device)
    return flip


def raw_inputs(group, scaling, base, l_before, drive, predicted_l, felt):
    """name -> value of what changes from tick to tick, before its scale; lengths in length units."""
    unit = scaling.length_unit * group.radius
    first = group.base.first[:, None, None, None]
    raw = {
        **{k: drive[..., c] for k, c in DRIVE.items()},
        "felt_step": felt / (first * first) / unit,
        "base_step": (predicted_l - base.l) / unit,
        "turn": base.theta,
        "displacement": base.l / unit,
        "velocity": (base.l - l_before) / unit,
    }
    left, right = (torch.stack([raw[pair[i]] for pair in CROSSED.values()]) for i in (0, 1))
    return {**raw, **dict(zip(CROSSED, cross(left, right)))}


def tick(model, packed, group, scaling, static, state, felt, drive, turn_now, mirror=None):
    """The state one tick on. model None: the modal base alone. mirror: (B, INPUT_WIDTH) signs, the network
    sees those sequences mirrored. felt, drive, turn_now: as Group.window gives them, of this tick."""
    base = state.base
    alone = model is not None and "base" in scaling.without
    answer, l, force = (None, base.l, felt) if alone else group.base.predict(base, felt, turn_now)
    if model is None:
        return State(group.base.arrive(base, l, answer), base.l, state.memory)
    unit = scaling.length_unit * group.radius
    raw = raw_inputs(group, scaling, base, state.l_before, drive, l, force)
    z = torch.cat([static, moving_columns(raw, scaling)], -1)
    y, carry = base.l / unit, (l - base.l) / unit
    if mirror is None:
        y, memory = model.step(packed, group.P, z, state.memory, y, carry)
    else:
        flip = mirror[:, columns("displacement")]
        y, memory = model.step(packed, group.P, z * mirror, state.memory, y * flip, carry * flip)
        y = y * flip
    y = y * unit * group.mask[..., None, None]
    if alone:
        return State(replace(base, l=y, u=y, u_before=base.u), base.l, memory)
    return State(group.base.arrive(base, l, answer, y - l), base.l, memory)


def start(model, group, batch):
    base = group.base.start(batch)
    return State(base, base.l, None if model is None else model.zero_state(group.regions, group.nodes, batch))


def _prepared(model, scaling, group, batch):
    """Packed weights and static columns, None for the modal base alone, and the state at rest."""
    state = start(model, group, batch)
    if model is None:
        return None, None, state
    return model.packed(), static_columns(group, scaling, batch), state


def stand_at(group, scaling, u, u_before, state):
    """The state of tissue that is at u and was at u_before a tick ago; the network's memory stays."""
    if scaling is not None and "base" in scaling.without:  # nothing is warped: l is u
        return State(replace(state.base, l=u, u=u, u_before=u_before), u_before, state.memory)
    return State(*group.base.stand_at(u, u_before, state.base), state.memory)


def single_steps(model, scaling, group):
    """As roll_out, but every tick starts from the true displacement; the network's memory is its own."""
    s = torch.arange(group.count, device=group.device)
    with torch.no_grad():
        packed, static, state = _prepared(model, scaling, group, len(s))
        felt, drive, turn, u = group.window(s, torch.zeros_like(s), group.ticks)
        out = [group.flatten(state.base.u)]
        for t in range(group.ticks):
            now = (turn[0][t], turn[1][t])
            state = tick(model, packed, group, scaling, static, state, felt[t], drive[t], now)
            out.append(group.flatten(state.base.u))
            state = stand_at(group, scaling, u[t], u[t - 1] if t else torch.zeros_like(u[t]), state)
    return torch.stack(out)


def roll_out(model, scaling, group, ticks=None, sequences=None, gain=1.0, still_after=None, watch=None):
    """Displacement (T+1, N, B, 3) metres of a group's sequences from rest.

    gain: factor on what drives the tissue. still_after: the character stands still from this tick on, for as
    long as `ticks` says. watch: a dict that receives the largest |c| as 'cell'."""
    s = torch.arange(group.count, device=group.device) if sequences is None else torch.as_tensor(sequences)
    ticks, chunk = ticks or group.ticks, 100
    moving = min(ticks, group.ticks, still_after or ticks)
    with torch.no_grad():
        packed, static, state = _prepared(model, scaling, group, len(s))
        out = [group.flatten(state.base.u)]
        for first in range(0, ticks, chunk):
            n = min(chunk, ticks - first)
            felt, drive, turn, _ = _driven(group, s, first, n, moving)
            for t in range(n):
                now = (turn[0][t], turn[1][t])
                state = tick(model, packed, group, scaling, static, state, gain * felt[t], drive[t], now)
                out.append(group.flatten(state.base.u))
                if watch is not None:
                    _watch(watch, state)
    return torch.stack(out)


def _watch(watch, state):
    watch["cell"] = max(watch.get("cell", 0.0), largest_cell(state.memory) if state.memory else 0.0)


def _driven(group, s, first, n, moving):
    """A window of ticks, of which those after `moving` are still."""
    there = max(0, min(n, moving - first))
    window = group.window(s, torch.full((len(s),), first, device=group.device), there) if there else None
    if there == n:
        return window
    still = _still(group, len(s), n - there)
    if not there:
        return still
    join = lambda a, b: tuple(join(x, y) for x, y in zip(a, b)) if isinstance(a, tuple) else torch.cat([a, b])
    return join(window, still)


def _still(group, batch, ticks):
    """What a character at rest in its bind pose feels."""
    shape = (ticks, group.regions, group.nodes, batch)
    zero = lambda width: torch.zeros(*shape, width, device=group.device)
    eye = torch.eye(3, device=group.device).expand(*shape, 3, 3)
    return zero(3), zero(group.drive.shape[-1]), (eye, eye), zero(3)


def truth(group, sequences=None):
    """Displacement (T+1, N, B, 3) metres."""
    d = group.displacement if sequences is None else group.displacement[sequences]
    return d.permute(1, 2, 0, 3)


def error_ratio(predicted, true, ticks):
    """Mean distance over ticks 1..ticks as a share of the mean displacement: 1 is skinning alone."""
    p, u = predicted[1 : ticks + 1], true[1 : ticks + 1]
    return float((p - u).norm(dim=-1).mean() / u.norm(dim=-1).mean())
