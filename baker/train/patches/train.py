"""Trains DeepEmulator's network on patches of simulated bodies: single ticks of some, then roll-outs of whole bodies.

Long waves are small in a patch, and what a network leaves of them adds up: a roll-out's error goes back through its ticks.
"""
import os
import time
from dataclasses import asdict, dataclass

import numpy as np
import torch

from ..files.safetensors import BadData, save
from ..files.write_file import write_json
from .data import Patches, patches_of, read_runs, take_step
from .model import Scaled


@dataclass
class PatchTrainOptions:
    """Defaults are the recipe of the shipped weights, whose time and width retrain_patches.sh states."""

    latent: int = 16
    minutes: float = 30.0  # of one core's time
    seed: int = 0
    patches: int = 256  # in a gradient
    ticks: int = 16  # that they are drawn from
    learning_rate: float = 2e-3
    rolled_share: float = 0.5  # of the time, of roll-outs
    rolled_ticks: int = 12  # that a gradient goes back through at the end; a third at first
    rolled_rate: float = 2e-4
    singles_weight: float = 30.0  # of the loss of single ticks beside a roll-out's
    largest_body: int = 1100  # nodes, that is rolled out
    noise: float = 0.02  # largest standard deviation, in cells, of what histories are disturbed by
    floor: float = 0.01  # cells: errors of answers below weigh alike

    def check(self):
        if self.latent < 16 or self.latent % 16 != 0 or self.latent > 64:
            raise BadData(f"--latent {self.latent}: the runtime takes 16, 32, 48 and 64")
        for name in ("minutes", "patches", "ticks", "learning_rate", "rolled_rate", "floor"):
            if not getattr(self, name) > 0:
                raise BadData(f"--{name.replace('_', '-')} {getattr(self, name)}: must be above 0")
        if self.noise < 0:
            raise BadData(f"--noise {self.noise}: must not be below 0")
        if not 0 <= self.rolled_share <= 1:
            raise BadData(f"--rolled-share {self.rolled_share}: must be 0 to 1")
        if self.rolled_ticks < 3:
            raise BadData(f"--rolled-ticks {self.rolled_ticks}: must be 3 or more")


def answers_of(model, patches):
    return model(patches.centre, patches.material, patches.patch, patches.owner)


def step_of(model, run, t, dynamic):
    """u_{t+1}, from u_t, u_{t-1}."""
    return take_step(run, t, answers_of(model, patches_of(run, t, run.free, dynamic)), dynamic)


def roll(model, run, t, ticks, dynamic):
    """The last two of u after each of so many ticks from t, newest first."""
    states = []
    for k in range(ticks):
        dynamic = [step_of(model, run, t + k, dynamic), dynamic[0]]
        states.append(dynamic)
    return states


def miss(run, t, u):
    """Root mean square over free nodes of the distance to the truth, cells."""
    return float((u - run.moved(t))[run.free].square().sum(1).mean().sqrt())


class PatchTrainer:
    def __init__(self, data, options, log=print):
        options.check()
        self.options, self.log = options, log
        self.train, self.validation = read_runs(data, "train"), read_runs(data, "validation")[::2]
        shortest = min(run.ticks for run in self.train)
        if shortest < options.rolled_ticks:
            raise BadData(f"--rolled-ticks {options.rolled_ticks}: the shortest run of {data} has {shortest} ticks")
        torch.manual_seed(options.seed)
        self.random = np.random.default_rng(options.seed)
        self.model = Scaled(options.latent)
        sample = Patches.join([self.draw(disturb=False) for _ in range(200)])
        self.model.fit(sample.centre, sample.material, sample.patch, sample.answer)
        self.optimizer = torch.optim.Adam(self.model.parameters(), options.learning_rate)
        self.updates, self.best, self.best_state, self.curve = 0, float("inf"), None, []
        sizes = sorted(len(run.rest) for run in self.train)
        self.bodies = [r for r in self.train if len(r.rest) <= max(self.options.largest_body, sizes[0])]
        self.ends = []  # of roll-outs that stayed near the truth

    def disturbed(self, run, dynamic):
        """A jolt and a drift that free nodes feel alike or each alone."""
        size = self.options.noise * self.random.random() ** 2
        noise = torch.as_tensor(self.random.normal(0, size, (2, *run.rest.shape)))
        noise = noise * (1 - run.constrained[:, None].double())
        return [u + n for u, n in zip(dynamic, (noise[0], noise[0] + 0.3 * noise[1]))]

    def draw(self, disturb=True):
        """Patches of one tick of one run."""
        run = self.train[self.random.integers(len(self.train))]
        count = max(1, self.options.patches // self.options.ticks)
        nodes = run.free[torch.as_tensor(self.random.integers(0, len(run.free), count))]
        t = int(self.random.integers(0, run.ticks))
        dynamic = run.moving(t)
        if disturb and self.options.noise > 0 and self.random.random() < 0.7:
            dynamic = self.disturbed(run, dynamic)
        return patches_of(run, t, nodes, dynamic)

    def loss(self, batch):
        error = (answers_of(self.model, batch) - batch.answer).square().sum(1)
        size = batch.answer.square().sum(1).sqrt()
        return (error / (size + self.options.floor)).mean()

    def descend(self, loss, rate, share_done):
        """A step of the optimizer, at a rate that falls with the share of a phase that is done."""
        for group in self.optimizer.param_groups:
            group["lr"] = rate * max(0.02, 0.5 * (1 + np.cos(np.pi * share_done)))
        self.optimizer.zero_grad()
        loss.backward()
        if torch.isfinite(torch.nn.utils.clip_grad_norm_(self.model.parameters(), 1.0)):
            self.optimizer.step()
        self.updates += 1
        return float(loss.detach())

    def update(self, share_done):
        batch = Patches.join([self.draw() for _ in range(self.options.ticks)])
        return self.descend(self.loss(batch), self.options.learning_rate, share_done)

    def start_of_roll_out(self, ticks):
        """(run, t, dynamic, age): the truth's, or where an earlier roll-out ended."""
        if self.ends and self.random.random() < 0.5:
            return self.ends.pop(self.random.integers(len(self.ends)))
        run = self.bodies[self.random.integers(len(self.bodies))]
        t = int(self.random.integers(0, run.ticks - ticks + 1))
        return run, t, run.moving(t), 0

    def update_rolled(self, share_done):
        """Of one body; its loss is the mean distance to the truth, over the size of the truth's displacement."""
        far, most_ends, oldest = 0.25, 40, 60  # cells; roll-outs; ticks
        most = self.options.rolled_ticks
        run, t, dynamic, age = self.start_of_roll_out(ticks := round(most * min(1, 1 / 3 + share_done)))
        states, loss = roll(self.model, run, t, ticks, dynamic), 0
        for k, (u, _) in enumerate(states, 1):
            error = (u - run.moved(t + k))[run.free].square().sum(1)
            size = (run.moved(t + k) - run.posed(t + k))[run.free].square().sum(1).mean().sqrt()
            loss = loss + (error + self.options.floor**2).sqrt().mean() / (size + 0.05) / ticks
        end = [u.detach() for u in states[-1]]
        goes_on = t + ticks + most <= run.ticks and age + ticks < oldest and len(self.ends) < most_ends
        if goes_on and miss(run, t + ticks, end[0]) < far:
            self.ends.append((run, t + ticks, end, age + ticks))
        singles = Patches.join([self.draw() for _ in range(self.options.ticks)])
        return self.descend(loss + self.options.singles_weight * self.loss(singles), self.options.rolled_rate, share_done)

    def judge(self):
        """Mean over validation runs, cells: of single ticks, and root mean squares of roll-outs of 48."""
        single, rolled = [], []
        for run in self.validation:
            with torch.no_grad():
                for t in range(2, run.ticks, 40):
                    single.append(miss(run, t + 1, step_of(self.model, run, t, run.moving(t))))
                states = roll(self.model, run, 2, min(48, run.ticks - 2), run.moving(2))
            misses = [min(10.0, np.nan_to_num(miss(run, 3 + k, u), nan=10.0)) for k, (u, _) in enumerate(states)]
            rolled.append(np.sqrt(np.mean(np.square(misses))))
        return float(np.mean(single)), float(np.mean(rolled))

    def validate(self, elapsed_s, training_loss):
        single, rolled = self.judge()
        if rolled + single < self.best:
            self.best = rolled + single
            self.best_state = {k: v.clone() for k, v in self.model.state_dict().items()}
        self.curve.append(
            {"seconds": elapsed_s, "updates": self.updates, "train": training_loss, "single": single, "rolled_48": rolled}
        )
        self.log(
            f"{elapsed_s:7.0f} s {self.updates:7d} updates  train {training_loss:.5f}  single {single:.5f}  48 ticks {rolled:.4f}"
        )

    def run(self):
        begin, losses, next_s = time.process_time(), [], 0.0
        budget_s = 60 * self.options.minutes
        singles_s = (1 - self.options.rolled_share) * budget_s
        while (elapsed_s := time.process_time() - begin) < budget_s:
            if elapsed_s < singles_s:
                losses.append(self.update(elapsed_s / singles_s))
            else:
                losses.append(self.update_rolled((elapsed_s - singles_s) / (budget_s - singles_s)))
            if elapsed_s > next_s:
                self.validate(elapsed_s, float(np.mean(losses)))
                losses, next_s = [], elapsed_s + budget_s / 12
        self.validate(time.process_time() - begin, float(np.mean(losses)) if losses else float("nan"))
        self.model.load_state_dict(self.best_state)
        self.seconds = time.process_time() - begin


def weights_metadata(trainer, extra):
    of = trainer.train[0].metadata
    logs = torch.cat([run.material[:, 2] for run in trainer.train])
    return {
        "sinew.model": "deep_emulator",
        "sinew.version": 1,
        "latent": trainer.options.latent,
        "rate_hz": float(of["rate_hz"]),
        "frame": "going_on",
        **{k: of[k] for k in ("integrator", "substeps", "damping_ratio")},
        "trained.log_stiffness": f"{logs.min():.4f},{logs.max():.4f}",
        **{f"recipe.{k}": v for k, v in asdict(trainer.options).items()},
        "updates": trainer.updates,
        "train_seconds": round(trainer.seconds),
        "train_runs": len(trainer.train),
        **extra,
    }


def train_patches(data, out, options, log=print):
    """Writes out/weights.safetensors and out/curve.json."""
    trainer = PatchTrainer(data, options, log)
    trainer.run()
    os.makedirs(out, exist_ok=True)
    tensors = {k: v.detach().numpy() for k, v in trainer.model.absorbed().state_dict().items()}
    save(os.path.join(out, "weights.safetensors"), tensors, weights_metadata(trainer, {"validation": f"{trainer.best:.5f}"}))
    write_json(os.path.join(out, "curve.json"), {"best": trainer.best, "curve": trainer.curve})
    log(f"{out}: validation {trainer.best:.5f}")
