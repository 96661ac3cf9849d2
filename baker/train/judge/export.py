"""Weights with their errors, and check vectors, as the baker takes them."""
import os

import numpy as np
import torch

from ..data import dataset
from ..files.safetensors import BadData, load, refuse_over, save
from ..model.inputs import FEEDBACK, columns
from ..model.modal_base import ModalBase
from ..model.rollout import bounded, start, static_columns, tick, told
from ..model.weights import read_weights

# The longest of these that was judged is the weights' stated error.
REPORTED_TICKS = ("600", "200", "100", "50")
VECTOR_TICKS = 120


def stated_error(metrics, model, body):
    """Metadata of the weights: held-out error in mm, as a share of skinning's, and over how many ticks."""
    rows = metrics["bodies"][body]["roll_out"]
    ticks = next((k for k in REPORTED_TICKS if model in rows.get(k, {})), None)
    if ticks is None:
        raise BadData(
            f"metrics: no roll-out of {model} on {body} over {', '.join(REPORTED_TICKS)} ticks; "
            "evaluate on longer test sequences"
        )
    row = rows[ticks][model]
    return {"error_mm": row["mean_mm"], "error_ratio": row["ratio"], "error_ticks": ticks}


def _in_double(group):
    """A group of one sequence, and its base, in double precision."""
    group.base = ModalBase(
        group.body.bases,
        np.bincount(group.body.region),
        1 / group.trajectories[0].rate_hz,
        dtype=torch.float64,
    )
    for name in ("drive", "rotation", "displacement", "P", "radius"):
        setattr(group, name, getattr(group, name).double())
    group.static = {k: v.double() for k, v in group.static.items()}
    return group


def check_vectors(weights, trajectory, ticks=VECTOR_TICKS):
    """Tensors of a check file: a network's own roll-out on one region in double precision, its answers taken as they are,
    told what else there is by a roll-out as the runtime's over the first `ticks` of a trajectory.

    edges (m, 2); z (T, n, F_in) with zeros where displacement and velocity go; carry (T, n, 3), y0 (n, 3) and
    y (T, n, 3) in length units. Displacement is the last tick's y x its scale, velocity y_{t-1} - y_{t-2} x
    its scale, with y_{-1} = y_0. What the frames and the base make of the displacement (turn, bent inputs)
    stands in z as the roll-out had it."""
    model, scaling, _ = read_weights(weights)
    model, group = model.double(), _in_double(dataset.group([("", trajectory)])[0])
    nodes, ticks = int(group.mask[0].sum()), min(ticks, group.ticks)
    unit = float(scaling.length_unit * group.radius[0])
    first = torch.zeros(1, dtype=torch.long)
    felt, drive, turn, _ = group.window(first, first, ticks)
    static, state, packed = static_columns(group, scaling, 1), start(model, group, 1), model.packed()
    zs, ys, carries = [], [], []
    y, y_before, memory = state.base.l, state.base.l, state.memory
    with torch.no_grad():
        for t in range(ticks):
            now = (turn[0][t], turn[1][t])
            _, l, z, _ = told(group, scaling, static, state, felt[t], drive[t], now)
            carry = l / unit - y
            for k, fed in zip(FEEDBACK, (y, y - y_before)):
                z[..., columns(k)] = bounded(fed, k, scaling)
            (y, memory), y_before = model.step(packed, group.P, z, memory, y, carry), y
            for k in FEEDBACK:
                z[..., columns(k)] = 0
            for to, value in ((zs, z), (carries, carry), (ys, y)):
                to.append(value[0, :nodes, 0].float())
            state = tick(model, packed, group, scaling, static, state, felt[t], drive[t], now)
    edges = np.array(trajectory.body.edges)
    return {
        "edges": edges[(edges < nodes).all(1)].astype(np.int32),
        "z": torch.stack(zs).numpy(),
        "carry": torch.stack(carries).numpy(),
        "y0": np.zeros((nodes, 3), np.float32),
        "y": torch.stack(ys).numpy(),
    }


def export(run, data, metrics, out, name, model, body):
    """Writes out/name.safetensors, with its errors as `model` on `body` stated in it, and
    .vectors.safetensors. Throws BadData where the run is not of an Alt-ConvLSTM."""
    weights, place = os.path.join(run, "weights.safetensors"), os.path.join(out, name)
    refuse_over([f"{place}.safetensors"], [weights])
    tensors, metadata = load(weights)
    if metadata.get("sinew.model") != "alt_conv_lstm":
        kind = metadata.get("sinew.model", "no model")
        raise BadData(f"{weights}: holds {kind}, which the runtime does not run; export an alt_conv_lstm run")
    os.makedirs(out, exist_ok=True)
    save(
        f"{place}.safetensors",
        {k: np.array(v) for k, v in tensors.items()},
        {**metadata, **stated_error(metrics, model, body)},
    )
    vectors = check_vectors(weights, dataset.read_split(data, "validation", body)[0][1])
    save(f"{place}.vectors.safetensors", vectors, {"sinew.vectors": "alt_conv_lstm"})
