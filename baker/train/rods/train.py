"""Trains a network that corrects a rod's continued start, on states that the solver visited."""
import os
import time
from dataclasses import asdict, dataclass

import numpy as np
import torch

from ..files.safetensors import BadData, save
from ..files.write_file import write_json
from .data import LOG_SCALE, read_runs
from .model import CopingNet


@dataclass
class RodTrainOptions:
    """Defaults are the recipe of the shipped weights."""

    latent: int = 8
    blocks: int = 1
    depth: int = 1
    minutes: float = 8.0  # of one core's time
    seed: int = 0
    strands: int = 24  # steps of strands in a gradient
    learning_rate: float = 3e-3
    floor: float = 0.05  # mean square of a triple's answers below which errors stop to weigh more
    patience: int = 30  # validations without a better one, then it ends

    def check(self):
        good = self.latent >= 8 and self.latent % 8 == 0 and self.latent <= 64
        if not good:
            raise BadData(f"--latent {self.latent}: the runtime takes multiples of 8 up to 64")
        for name in ("blocks", "depth", "strands", "patience", "minutes", "learning_rate", "floor"):
            if not getattr(self, name) > 0:
                raise BadData(f"--{name.replace('_', '-')} {getattr(self, name)}: must be above 0")


class Batch:
    """Steps of strands side by side in one graph."""

    def __init__(self, picks):
        """picks: (run, steps) each."""
        nodes, answers, edges, senders, receivers, owner, first = [], [], [], [], [], [], 0
        for run, steps in picks:
            n, m = run.told.shape[1], len(run.parents)
            for step in steps:
                nodes.append(run.told[step])
                answers.append(run.answers[step])
                edges.append(run.joints)
                senders.append(run.parents + first)
                receivers.append(np.arange(1, n) + first)
                owner.append(np.full(n, len(owner)))
                first += n
            assert m == n - 1
        join = lambda parts: torch.as_tensor(np.concatenate(parts))
        self.nodes, self.answers, self.edges = join(nodes), join(answers), join(edges)
        self.senders, self.receivers, self.owner = join(senders), join(receivers), join(owner)
        self.strands = len(nodes)

    def guess(self, model):
        """(rows, 12): a node's outputs and its joint's, the root's zero."""
        node, edge = model(self.nodes, self.edges, self.senders, self.receivers)
        joint = torch.zeros_like(node).index_add(0, self.receivers, edge)
        return torch.cat([node, joint], 1)

    def mean_squares(self, values):
        """(strands, 4): of each triple over the strand."""
        square = values.square().reshape(-1, 4, 3).sum(2)
        sums = torch.zeros(self.strands, 4).index_add(0, self.owner, square)
        count = torch.zeros(self.strands).index_add(0, self.owner, torch.ones(len(values)))
        return sums / count[:, None]


def loss_of(model, batch, floor):
    left = batch.mean_squares(batch.guess(model) - batch.answers)
    return (left / (batch.mean_squares(batch.answers) + floor)).mean()


def share_left(guess_of, runs, steps_at_once=32):
    """Of the continuation's miss what a guess leaves, root mean square over a strand's step and triple; the
    median over all, each triple: acceleration, angular acceleration, force, moment."""
    shares = []
    with torch.no_grad():
        for run in runs:
            for begin in range(0, len(run.told), steps_at_once):
                batch = Batch([(run, range(begin, min(begin + steps_at_once, len(run.told))))])
                left = batch.mean_squares(guess_of(batch) - batch.answers)
                shares.append((left / batch.mean_squares(batch.answers).clamp(min=1e-12)).sqrt())
    return torch.cat(shares).median(0).values.tolist()


class RodTrainer:
    def __init__(self, data, options, log=print):
        options.check()
        self.options, self.log = options, log
        self.train, self.validation = read_runs(data, "train"), read_runs(data, "validation")
        torch.manual_seed(options.seed)
        self.random = np.random.default_rng(options.seed)
        self.model = CopingNet(options.latent, options.blocks, options.depth)
        self.optimizer = torch.optim.Adam(self.model.parameters(), options.learning_rate)
        self.updates, self.best, self.best_state, self.curve = 0, float("inf"), None, []
        self.judged = Batch([(r, range(0, len(r.told), 8)) for r in self.validation])

    def draw(self):
        picks = self.random.integers(0, len(self.train), self.options.strands)
        step = lambda run: self.random.integers(0, len(run.told))
        return Batch([(self.train[k], [step(self.train[k])]) for k in picks])

    def update(self, share_done):
        rate = self.options.learning_rate * max(0.02, 1 - share_done)
        for group in self.optimizer.param_groups:
            group["lr"] = rate
        loss = loss_of(self.model, self.draw(), self.options.floor)
        self.optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.model.parameters(), 1.0)
        self.optimizer.step()
        self.updates += 1
        return float(loss.detach())

    def validate(self, elapsed_s, training_loss):
        with torch.no_grad():
            value = float(loss_of(self.model, self.judged, self.options.floor))
        if value < self.best:
            self.best = value
            self.best_state = {k: v.clone() for k, v in self.model.state_dict().items()}
        self.curve.append({"seconds": elapsed_s, "updates": self.updates, "train": training_loss, "validation": value})
        self.log(f"{elapsed_s:7.0f} s {self.updates:7d} updates  train {training_loss:.4f}  validation {value:.4f}")

    def run(self):
        begin, losses, since = time.process_time(), [], 0
        budget_s = 60 * self.options.minutes
        while (elapsed_s := time.process_time() - begin) < budget_s and since < self.options.patience:
            losses.append(self.update(elapsed_s / budget_s))
            if self.updates % 200 == 0:
                before = self.best
                self.validate(elapsed_s, float(np.mean(losses)))
                losses, since = [], 0 if self.best < before else since + 1
        if losses:
            self.validate(time.process_time() - begin, float(np.mean(losses)))
        self.model.load_state_dict(self.best_state)
        self.seconds = time.process_time() - begin


def trained_range(runs):
    """Metadata for sinew-bake character (baker/pack/network/trained_rods.hpp): segments, and natural logarithms of compliances, least and most."""
    segments = [run.told.shape[1] for run in runs]
    logs = np.concatenate([run.joints[:, 3:] for run in runs]) * LOG_SCALE
    return {
        "trained.segments": f"{min(segments)},{max(segments)}",
        "trained.log_compliances": f"{logs.min():.4f},{logs.max():.4f}",
    }


def weights_metadata(trainer, extra):
    return {
        "sinew.model": "coping_net",
        "sinew.version": 1,
        **trainer.model.sizes,
        "purpose": "corrects a rod's extrapolated start (rods/start/learned_start.hpp)",
        **{f"recipe.{k}": v for k, v in asdict(trainer.options).items()},
        "updates": trainer.updates,
        "train_seconds": round(trainer.seconds),
        **trained_range(trainer.train),
        **extra,
    }


def train_rods(data, out, options, log=print):
    """Writes out/weights.safetensors and out/curve.json."""
    trainer = RodTrainer(data, options, log)
    trainer.run()
    os.makedirs(out, exist_ok=True)
    left = share_left(lambda batch: batch.guess(trainer.model), trainer.validation)
    extra = {
        "train_runs": len(trainer.train),
        "validation_loss": f"{trainer.best:.4f}",
        "validation_share_left": ",".join(f"{v:.4f}" for v in left),
    }
    tensors = {k: v.detach().numpy() for k, v in trainer.model.state_dict().items()}
    save(os.path.join(out, "weights.safetensors"), tensors, weights_metadata(trainer, extra))
    write_json(os.path.join(out, "curve.json"), {"best": trainer.best, "curve": trainer.curve})
    log(f"{out}: validation {trainer.best:.4f}, fraction of the error left {left}")
