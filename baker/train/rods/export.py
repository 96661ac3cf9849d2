"""Weights of a trained start with their errors, check vectors, and examples for the k-NN baseline."""
import os

import numpy as np
import torch

from ..files.safetensors import BadData, load, refuse_over, save
from ..files.write_file import write_json
from .data import ANSWERS, read_runs
from .model import CopingNet
from .train import Batch, share_left

NEIGHBOURS = 3
LARGEST_EXAMPLE = 3.0  # of an answer, as the network's norm
VECTOR_STRANDS, VECTOR_STEPS = 2, 3


def read_network(path):
    """(model, metadata); throws BadData naming what is missing or misshaped."""
    tensors, metadata = load(path)
    try:
        sizes = [int(metadata[k]) for k in ("latent", "blocks", "depth")]
    except (KeyError, ValueError):
        raise BadData(f"{path}: metadata latent, blocks or depth is missing; train again") from None
    model = CopingNet(*sizes)
    for name, parameter in model.state_dict().items():
        if name not in tensors or tensors[name].shape != tuple(parameter.shape):
            raise BadData(f"{path}: tensor {name} is missing or misshaped; train again")
        parameter.copy_(torch.as_tensor(np.array(tensors[name])))
    return model.eval(), metadata


def scene_of(run):
    return run.name.split("-")[0]


def judge(guess_of, runs):
    """What is left of the continuation's miss, by scene."""
    scenes = sorted({scene_of(r) for r in runs})
    triples = ("acceleration", "angular_acceleration", "force", "moment")
    left = lambda scene: share_left(guess_of, [r for r in runs if scene_of(r) == scene])
    return {s: dict(zip(triples, (round(v, 4) for v in left(s)))) for s in scenes}


def nearest_guess(inputs, answers):
    inputs, answers = torch.as_tensor(inputs), torch.as_tensor(answers)

    def guess(batch):
        parts = batch.nodes.split(2048)
        nearest = [torch.cdist(p, inputs).topk(NEIGHBOURS, largest=False).indices for p in parts]
        return answers[torch.cat(nearest)].mean(1)

    return guess


def check_vectors(model, runs):
    """Some strands' steps in double precision."""
    picks = [(r, np.linspace(0, len(r.told) - 1, VECTOR_STEPS).astype(int)) for r in runs[:VECTOR_STRANDS]]
    batch = Batch(picks)
    with torch.no_grad():
        node, edge = model.double()(
            batch.nodes.double(), batch.edges.double(), batch.senders, batch.receivers
        )
    model.float()
    return {
        "nodes": batch.nodes.numpy(),
        "edges": batch.edges.numpy(),
        "senders": batch.senders.numpy().astype(np.int32),
        "receivers": batch.receivers.numpy().astype(np.int32),
        "dp": node.float().numpy(),
        "dlambda": edge.float().numpy(),
    }


def export_rods(run, data, out, name):
    """out/name.safetensors, .vectors.safetensors and .json."""
    path = os.path.join(run, "weights.safetensors")
    refuse_over([os.path.join(out, f"{name}.safetensors")], [path])
    model, metadata = read_network(path)
    test, long = read_runs(data, "test"), read_runs(data, "long")
    guess = lambda batch: batch.guess(model)
    metrics = {
        "what": "median over strands and steps of what is left of the extrapolated start's error (r.m.s.)",
        "recipe": metadata,
        "within_50_steps": judge(guess, test),
        "beyond_50_steps": judge(guess, long),
        "test_runs": len(test),
        "long_runs": len(long),
    }
    stated = share_left(guess, test)
    metadata = {**metadata, "test_runs": len(test), "test_share_left": ",".join(f"{v:.4f}" for v in stated)}
    tensors, _ = load(path)
    save(os.path.join(out, f"{name}.safetensors"), tensors, metadata)
    about = {"sinew.vectors": "coping_net", "weights": f"{name}.safetensors"}
    save(os.path.join(out, f"{name}.vectors.safetensors"), check_vectors(model, test), about)
    write_json(os.path.join(out, f"{name}.json"), metrics)
    print(f"{name}: test {stated}")


def export_examples(data, out, name, count, seed):
    """out/name.safetensors: rows of segments drawn from the training runs; .json: what they are worth."""
    random = np.random.default_rng(seed)
    runs = read_runs(data, "train")
    inputs, answers = [], []
    for _ in range(count):
        run = runs[random.integers(len(runs))]
        step, segment = random.integers(len(run.told)), random.integers(1, run.told.shape[1])
        inputs.append(run.told[step, segment])
        answers.append(np.clip(run.answers[step, segment], -LARGEST_EXAMPLE, LARGEST_EXAMPLE))
    inputs, answers = np.stack(inputs), np.stack(answers).reshape(count, ANSWERS)
    about = {"purpose": "examples of starts (baker/research/rods/nearest_start.hpp)", "seed": seed, "train_runs": len(runs)}
    save(os.path.join(out, f"{name}.safetensors"), {"inputs": inputs, "answers": answers}, about)
    test = read_runs(data, "test")[::4]
    metrics = {"count": count, "neighbours": NEIGHBOURS, "test_runs": len(test)}
    metrics["within_50_steps"] = judge(nearest_guess(inputs, answers), test)
    write_json(os.path.join(out, f"{name}.json"), metrics)
    print(f"{name}: {metrics['within_50_steps']}")
