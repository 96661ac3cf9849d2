"""One tick of a network closed on its modal base, and whole roll-outs from rest, as the runtime runs them
(runtime/character/tissue/simulate.cpp).

The network's answer is Alt-ConvLSTM's own Y_t = Y_{t-1} + C_t + (its carry), with what the modes make of l_{t-1} in
the place of the skinning's motion. What it adds to the modes is bounded by a budget (correction.py), what is shown and how
far it swings by the region's limit (limit.py), and a network far outside of what it was trained on is not trusted."""
from dataclasses import dataclass, replace

import torch

from .alt_conv_lstm import largest_cell
from .correction import Corrected, correct, none_yet
from .inputs import AXIAL, CROSSED, DRIVE, FELT, INPUT_WIDTH, ORDER, STATIC, WIDTH, columns
from .limit import within
from .modal_base import BaseState, cross

CLAMPED_SHARE = 0.05  # of a region's inputs outside of the envelope: the network is not trusted at all
FASTER_SHARE = 0.25  # above the largest trained frequency: likewise
ROUNDING = 1e-5  # radians, and of the radius: a pose that moves by no more stays as it is


@dataclass
class State:
    base: BaseState
    l_before: torch.Tensor  # (R, n, B, 3) metres
    memory: list  # of the network
    corrected: Corrected

    def map(self, change):
        memory = self.memory and [tuple(change(x) for x in layer) for layer in self.memory]
        return State(self.base.map(change), change(self.l_before), memory, self.corrected.map(change))


def bounded(values, name, scaling):
    """value x scale, clamped as the runtime clamps it."""
    if name in scaling.without:
        return torch.zeros_like(values)
    return (values * scaling.scale[name]).clamp(-scaling.envelope[name], scaling.envelope[name])


@dataclass
class Static:
    """What a network is told that does not change from tick to tick, and how it is told the rest."""

    z: torch.Tensor  # (R, n, B, 8), scaled and held in the envelope
    scale: torch.Tensor  # of each moving column
    most: torch.Tensor
    held: torch.Tensor  # (R, 1): how many numbers of z are held, but for the frequency's
    trust: torch.Tensor  # (R, 1): as the region's frequency allows


def static_columns(group, scaling, batch):
    outside = lambda k: ((group.static[k] * scaling.scale[k]).abs() > scaling.envelope[k]).sum((1, 2))[:, None]
    fastest = group.static["frequency"].amax((1, 2))[:, None] * scaling.scale["frequency"]
    faster = (fastest / scaling.envelope["frequency"] - 1).clamp(min=0)
    z = torch.cat([bounded(group.static[k], k, scaling) for k in STATIC], -1)
    row = lambda of: torch.tensor([of(k) for k in ORDER if k not in STATIC for _ in range(WIDTH[k])]).to(z)
    return Static(
        z[:, :, None].expand(-1, -1, batch, -1),
        row(lambda k: 0.0 if k in scaling.without else scaling.scale[k]),
        row(lambda k: scaling.envelope[k]),
        sum(outside(k) for k in STATIC if k != "frequency"),
        (1 - faster / FASTER_SHARE).clamp(min=0),
    )


def all_columns(static, raw):
    """What a network is told of a tick, z (R, n, B, .), and how many numbers of each region are held, (R, B)."""
    z = torch.cat([raw[k] for k in ORDER if k in raw], -1) * static.scale
    held = (z.detach().abs() > static.most).sum((1, 3)) + static.held
    return torch.cat([static.z, z.clamp(-static.most, static.most)], -1), held


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


def trust(group, static, held):
    """(R, B): how far a network is trusted of whose inputs so many are held in the envelope."""
    numbers = (INPUT_WIDTH - 1) * group.mask.sum(1)[:, None]
    return (1 - held / (CLAMPED_SHARE * numbers)).clamp(min=0) * static.trust


def pose_stays(group, drive, turn_now):
    """(R, B): whether the nodes stand as in the last two ticks."""
    moved = (drive[..., FELT] - drive[..., DRIVE["gravity_change"]]).abs().amax((1, 3))  # m/s^2
    eye = torch.eye(3, device=drive.device, dtype=drive.dtype)
    turned = torch.maximum(*((m - eye).abs().amax((1, 3, 4)) for m in turn_now))
    least = ROUNDING * group.radius[:, 0, 0] / group.base.tick_s**2
    return (moved <= least) & (turned <= ROUNDING)


def told(group, scaling, static, state, felt, drive, turn_now):
    """The modes' answer to a tick and its l, what the network is told of it, z (R, n, B, .), and how far it is trusted."""
    answer, l, force = group.base.predict(state.base, felt, turn_now, state.corrected.d)
    z, held = all_columns(static, raw_inputs(group, scaling, state.base, state.l_before, drive, l, force))
    return answer, l, z, trust(group, static, held)


def _alone(model, packed, group, scaling, static, state, felt, drive):
    """A network without a modal base (an ablation)."""
    base, unit = state.base, scaling.length_unit * group.radius
    z, _ = all_columns(static, raw_inputs(group, scaling, base, state.l_before, drive, base.l, felt))
    y, memory = model.step(packed, group.P, z, state.memory, base.l / unit, torch.zeros_like(base.l))
    l = y * unit * group.mask[..., None, None]
    return State(replace(base, l=l, u=l, u_before=base.u), base.l, memory, state.corrected)


def tick(model, packed, group, scaling, static, state, felt, drive, turn_now, mirror=None):
    """The state one tick on. model None: the modal base alone. mirror: (B, INPUT_WIDTH) signs, the network
    sees those sequences mirrored. felt, drive, turn_now: as Group.window gives them, of this tick."""
    base = state.base
    if model is None:
        answer, l, _ = group.base.predict(base, felt, turn_now)
        after, share = group.base.arrive(base, l, answer)
        return State(after, base.l * share[:, None, :, None], state.memory, state.corrected)
    if "base" in scaling.without:
        return _alone(model, packed, group, scaling, static, state, felt, drive)
    unit = scaling.length_unit * group.radius
    answer, l, z, trusted = told(group, scaling, static, state, felt, drive, turn_now)
    y = within(group.base.limit, base.l) / unit
    carry = l / unit - y
    if mirror is None:
        y, memory = model.step(packed, group.P, z, state.memory, y, carry)
    else:
        flip = mirror[:, columns("displacement")]
        y, memory = model.step(packed, group.P, z * mirror, state.memory, y * flip, carry * flip)
        y = y * flip
    change = (y * unit - l) * trusted[:, None, :, None] * group.mask[..., None, None]
    taken, corrected = correct(group.base, state.corrected, answer[0], change, pose_stays(group, drive, turn_now))
    after, share = group.base.arrive(base, l, answer, taken)
    return State(after, base.l * share[:, None, :, None], memory, corrected.scaled(share))


def start(model, group, batch):
    base = group.base.start(batch)
    memory = None if model is None else model.zero_state(group.regions, group.nodes, batch)
    return State(base, base.l, memory, none_yet(group.base, batch))


def _prepared(model, scaling, group, batch):
    """Packed weights and static columns, None for the modal base alone, and the state at rest."""
    state = start(model, group, batch)
    if model is None:
        return None, None, state
    return model.packed(), static_columns(group, scaling, batch), state


def stand_at(group, scaling, u, u_before, state):
    """The state of tissue that is at u and was at u_before a tick ago; the network's memory stays."""
    if scaling is not None and "base" in scaling.without:  # nothing is warped: l is u
        return replace(state, base=replace(state.base, l=u, u=u, u_before=u_before), l_before=u_before)
    base, l_before = group.base.stand_at(u, u_before, state.base)
    return State(base, l_before, state.memory, none_yet(group.base, u.shape[2]))


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
