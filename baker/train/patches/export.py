"""Weights of a trained emulator with their errors stated, check vectors, and the page's tables and plots."""
import os

import numpy as np
import torch

from ..files.safetensors import BadData, load, refuse_over, save
from ..files.write_file import write_json
from .data import patches_of, read_runs, take_step
from .model import LATENT, DeepEmulator
from .train import answers_of, miss, step_of

ROLLED = (24, 48)
EXPLODED = 1e3  # cells
VECTOR_STEPS = 6


class Answering(torch.nn.Module):
    """Weights as they are exported, called as the trainer calls its own."""

    def __init__(self, net):
        super().__init__()
        self.net = net

    def forward(self, centre, material, patch, owner):
        return self.net(centre, material, patch, owner)


def read_network(path):
    """(model, metadata); throws BadData naming what is missing or misshaped."""
    tensors, metadata = load(path)
    if metadata.get("sinew.model") != "deep_emulator":
        raise BadData(f"{path}: metadata sinew.model is not deep_emulator; give weights of train-patches")
    net = DeepEmulator(int(metadata.get("latent", LATENT)))
    for name, parameter in net.state_dict().items():
        if name not in tensors or tensors[name].shape != tuple(parameter.shape):
            raise BadData(f"{path}: tensor {name} is missing or misshaped; train again")
        parameter.copy_(torch.as_tensor(np.array(tensors[name])))
    return Answering(net).eval(), metadata


def _going_on(centre, material, patch, owner):
    return torch.zeros(len(centre), 3)


def errors_of(model, run):
    """(single, rolled), cells, tick by tick after the first."""
    dynamic, single, rolled, exploded = run.moving(1), [], [], False
    with torch.no_grad():
        for t in range(1, run.ticks):
            single.append(miss(run, t + 1, step_of(model, run, t, run.moving(t))))
            if not exploded:
                dynamic = [step_of(model, run, t, dynamic), dynamic[0]]
                exploded = not miss(run, t + 1, dynamic[0]) < EXPLODED
            rolled.append(EXPLODED if exploded else miss(run, t + 1, dynamic[0]))
    return np.array(single), np.array(rolled)


def skinning_of(run):
    return np.array([miss(run, t + 1, run.posed(t + 1)) for t in range(1, run.ticks)])


def _row(pairs):
    """Means over runs of the root mean squares over ticks; of roll-outs over their first ones."""
    rms = lambda values: float(np.sqrt(np.mean(np.square(values))))
    row = {"single": float(np.mean([rms(s) for s, _ in pairs]))}
    for n in ROLLED:
        row[f"rolled_{n}"] = float(np.mean([rms(r[:n]) for _, r in pairs]))
    row["rolled_all"] = float(np.mean([rms(r) for _, r in pairs]))
    row["exploded"] = int(sum(r.max() >= EXPLODED for _, r in pairs))
    return {k: v if k == "exploded" else round(v, 5) for k, v in row.items()}


def judge(model, runs):
    """Errors over held-out runs in shortest edges, ours and those of what one would do without."""
    of = {"network": [errors_of(model, run) for run in runs], "going on": [errors_of(_going_on, run) for run in runs]}
    still = [skinning_of(run) for run in runs]
    of["skinning"] = list(zip(still, still))
    for substeps in (1, 50, 100):
        name = f"explicit.{substeps}"
        if all(f"{name}.single" in run.tensors for run in runs):
            clip = lambda v: np.minimum(v[1:].astype(np.float64), EXPLODED)
            of[f"central differences, {substeps} substeps"] = [
                (clip(run.tensors[f"{name}.single"]), clip(run.tensors[f"{name}.rolled"])) for run in runs
            ]
    rows = {name: _row(pairs) for name, pairs in of.items()}
    curves = {run.name: rolled.tolist() for run, (_, rolled) in zip(runs, of["network"])}
    return rows, curves


def roll_out_vectors(model, run, steps):
    """A roll-out in double precision, told from where the body was at its start."""
    double = DeepEmulator(model.net.latent).double()
    double.load_state_dict(model.net.state_dict())
    first = next(t for t in range(1, run.ticks - steps - 1) if miss(run, t, run.posed(t)) > 0.02)
    origin = run.place[first]
    dynamic = run.moving(first)
    started, axes, y = dynamic, [], []
    with torch.no_grad():
        for t in range(first, first + steps):
            patches = patches_of(run, t, run.free, dynamic)
            wide = lambda v: v.double()
            answer = double(wide(patches.centre), wide(patches.material), wide(patches.patch), patches.owner)
            dynamic = [take_step(run, t, answer, dynamic), dynamic[0]]
            y.append(dynamic[0])
            axes.append(run.turn[t + 1].T.reshape(9))
    x = [run.posed(t) for t in range(first - 1, first + steps + 2)]
    pairs = [(i, int(j)) for i in range(len(run.rest)) for j in run.columns[run.rows[i] : run.rows[i + 1]] if i < j]
    to = lambda v: np.asarray(v, np.float32)
    return {
        "edges": np.array(pairs, np.int32),
        "x": to(torch.stack(x) - origin),
        "material": to(run.material),
        "constrained": np.array(run.constrained, np.int32),
        "axes": to(torch.stack(axes)),
        **{name: to(u - origin) for name, u in zip(("u_1", "u_0"), started)},
        "y": to(torch.stack(y) - origin),
    }


def plot(rows, curves, runs, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(8, 4))
    for run in runs:
        axes.plot(curves[run.name], label=f"{run.metadata['shape']}, ln k = {float(run.material[:, 2].median()):.1f}", lw=1)
    axes.set_xlabel("ticks rolled out"), axes.set_ylabel("root mean square error, shortest edges")
    axes.set_title(f"Roll-outs of held-out bodies; mean {rows['network']['rolled_all']:.3f}, skinning {rows['skinning']['rolled_all']:.3f}")
    axes.set_ylim(bottom=0), axes.legend(fontsize=6, ncol=2)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)


def export_patches(run, data, out, name, page):
    """out/name.safetensors and .vectors.safetensors; page/name.json and .png."""
    path = os.path.join(run, "weights.safetensors")
    refuse_over([os.path.join(out, f"{name}.safetensors")], [path])
    model, metadata = read_network(path)
    test = read_runs(data, "test")
    rows, curves = judge(model, test)
    stated = rows["network"]
    metadata = {**metadata, "test_runs": len(test), **{f"test_{k}": v for k, v in stated.items()}}
    tensors, _ = load(path)
    save(os.path.join(out, f"{name}.safetensors"), tensors, metadata)
    about = {"sinew.vectors": "deep_emulator", "weights": f"{name}.safetensors"}
    smallest = min(test, key=lambda r: len(r.rest))
    save(os.path.join(out, f"{name}.vectors.safetensors"), roll_out_vectors(model, smallest, VECTOR_STEPS), about)
    os.makedirs(page, exist_ok=True)
    what = "root mean square over free nodes of the distance to the truth, shortest edges; means over held-out runs"
    write_json(os.path.join(page, f"{name}.json"), {"what": what, "recipe": metadata, "errors": rows})
    plot(rows, curves, test, os.path.join(page, f"{name}.png"))
    for row, values in rows.items():
        print(f"{name}: {row}: {values}")
