"""Weights with their errors, and check vectors, as the baker takes them."""
import json
import os
import shutil

import numpy as np
import torch

from . import dataset
from .dataset import drive_columns, input_columns
from .inputs import FEEDBACK_START
from .model import normalized_adjacency
from .safetensors import BadData, load, save
from .weights import read_weights

# The longest of these that was judged is the weights' stated error.
REPORTED_TICKS = ("600", "200", "100", "50")
VECTOR_TICKS = 120


def stated_error(metrics):
    """Metadata of the weights: held-out error in mm, as a share of skinning's, and over how many ticks."""
    ticks = next((k for k in REPORTED_TICKS if k in metrics["roll_out"]), None)
    if ticks is None:
        raise BadData(
            f"metrics: no roll-out of {', '.join(REPORTED_TICKS)} ticks; evaluate on longer test sequences"
        )
    row = metrics["roll_out"][ticks]["network"]
    return {"error_mm": row["mean_mm"], "error_ratio": row["ratio"], "error_ticks": ticks}


def check_vectors(weights, trajectory, ticks=VECTOR_TICKS):
    """Tensors of a check file: one region's own roll-out in double precision, over the first `ticks` of a
    trajectory.

    edges (m, 2); z (T, n, F_in) with zeros where displacement and velocity go; y0 (n, 3) and y (T, n, 3) in
    length units. Displacement is the last tick's y x its scale, velocity y_{t-1} - y_{t-2} x its scale, with
    y_{-1} = y_0."""
    model, scaling, _ = read_weights(weights)
    model = model.double()
    group = dataset.group([trajectory])[0]
    nodes = int(group.mask[0].sum())
    ticks = min(ticks, group.ticks)
    raw = group.window(torch.zeros(1, dtype=torch.long), torch.zeros(1, dtype=torch.long), ticks)[0][
        :, :1, :nodes
    ]
    static = group.static_columns(scaling, 1)[:1, :nodes]
    edges = np.array(trajectory.body.edges)
    edges = edges[(edges < nodes).all(1)]
    P = normalized_adjacency(nodes, edges)[None]
    y = y_before = torch.zeros(1, nodes, 1, 3, dtype=torch.float64)
    state, zs, ys = model.zero_state(1, nodes, 1), [], []
    with torch.no_grad():
        for t in range(1, ticks + 1):
            z = input_columns(static, drive_columns(raw[t], scaling), y.float(), y_before.float(), scaling)
            feed = z.double()
            feed[..., FEEDBACK_START : FEEDBACK_START + 3] = y * scaling.scale["displacement"]
            feed[..., FEEDBACK_START + 3 :] = (y - y_before) * scaling.scale["velocity"]
            if (feed - z).abs().max() > 1e-4:
                raise BadData(
                    f"{trajectory.path}: drives the network out of its envelope; "
                    "take a calmer sequence for the check vectors"
                )
            z[..., FEEDBACK_START:] = 0
            zs.append(z[0, :, 0])
            y_before = y
            y, state = model.step(model.packed(), P, feed, state, y)
            ys.append(y[0, :, 0].float())
    return {
        "edges": edges.astype(np.int32),
        "z": torch.stack(zs).numpy(),
        "y0": np.zeros((nodes, 3), np.float32),
        "y": torch.stack(ys).numpy(),
    }


def export(weights, run, data, out, name):
    """Writes out/name.safetensors, .metrics.json, .curves.png (where the run has them) and
    .vectors.safetensors."""
    os.makedirs(out, exist_ok=True)
    with open(os.path.join(run, "metrics.json")) as file:
        metrics = json.load(file)
    tensors, metadata = load(weights)
    place = os.path.join(out, name)
    save(
        f"{place}.safetensors",
        {k: np.array(v) for k, v in tensors.items()},
        {**metadata, **stated_error(metrics)},
    )
    save(
        f"{place}.vectors.safetensors",
        check_vectors(weights, dataset.read_split(data, "validation")[0]),
        {"sinew.vectors": "alt_conv_lstm"},
    )
    with open(os.path.join(data, dataset.SHEET)) as file:
        sheet = json.load(file)
    metrics["data"] = {k: v for k, v in sheet.items() if k != "sequences"}
    with open(f"{place}.metrics.json", "w") as file:
        json.dump(metrics, file, indent=1)
        file.write("\n")
    if os.path.exists(os.path.join(run, "curves.png")):
        shutil.copyfile(os.path.join(run, "curves.png"), f"{place}.curves.png")
