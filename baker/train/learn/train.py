"""Trains one network on roll-outs: its own output is fed back, as at run time."""
import json
import math
import os
import time
from dataclasses import replace

import torch

from ..data import dataset
from ..data.dataset import Union
from ..files.safetensors import BadData
from ..files.write_file import write_json, written
from ..model.alt_conv_lstm import AltConvLSTM, ModelOptions
from ..model.inputs import INPUT_WIDTH
from ..model.rollout import State, error_ratio, roll_out, single_steps, stand_at, start, tick, truth
from ..model.vanilla import FORMS, ConvLSTM
from ..model.weights import save_weights
from .episode import Episode
from .options import TrainOptions
from .scaling import measure_scaling

VALIDATED_TICKS = (50, 150)  # and the whole sequence
LOST = 5  # times the largest displacement of the truth, shown or not
LEAST_ERROR = 0.03  # of its mean over sequences, in a region: where the base is exact an error counts for no more


def _new_model(o):
    wiring = dict(output_scale=o.output_scale, hidden_leak=o.hidden_leak, state_clamp=o.state_clamp)
    options = ModelOptions(INPUT_WIDTH, tuple(o.channels), self_weights=True, **wiring)
    model = ConvLSTM(options, o.form) if o.form else AltConvLSTM(options)
    return model.start_for_training().to(o.device)


def error_weights(group):
    """(R, S), 1/m: one over what the modal base leaves in each region and sequence, so that flesh that hardly moves counts
    as much as flesh that swings far."""
    distance = (roll_out(None, None, group) - truth(group)).norm(dim=-1)  # (T+1, N, S)
    of = lambda r: distance[:, torch.as_tensor(group.body.region == r)].mean((0, 1))
    error = torch.stack([of(r) for r in range(group.regions)])
    return 1 / (error + LEAST_ERROR * error.mean(1, keepdim=True) + 1e-7)


class Trainer:
    """start: (model, scaling) to go on from; without: a new model, scaled by the training data."""

    def __init__(self, train_groups, validation_groups, options, log=print, start=None):
        self.options, self.validation, self.log = options, validation_groups, log
        self.bodies = Union(train_groups)
        torch.manual_seed(options.seed)
        first = train_groups[0].trajectories[0]
        self.rate_hz = first.rate_hz
        self.model, self.scaling = start or (
            _new_model(options),
            replace(measure_scaling(train_groups), without=tuple(options.without)),
        )
        self.optimizer = torch.optim.Adam(self.model.parameters(), options.learning_rate)
        self.weights, self.bound = ([f(g) for g in train_groups] for f in (error_weights, self._bound))
        self.bound = torch.cat(self.bound)
        self.elapsed_s, self.updates, self.best, self.best_model, self.curve = 0.0, 0, float("inf"), None, []

    def begin_anew(self, options, scaling):
        """With weights drawn for these options."""
        self.options, self.model, self.scaling = options, _new_model(options), scaling
        self.optimizer = torch.optim.Adam(self.model.parameters(), options.learning_rate)

    def _bound(self, g):
        """Of |l| in each region, (R, 1, 1) metres: what goes far beyond is lost."""
        return g.largest_m[:, None, None]

    def fraction(self):
        if self.options.updates:
            return self.updates / self.options.updates
        return self.elapsed_s / (60 * self.options.minutes)

    def _set_rate(self):
        warm = min(1.0, self.updates / 30 + 0.1)
        cosine = 0.5 * (1 + math.cos(math.pi * min(1.0, self.fraction())))
        for group in self.optimizer.param_groups:
            group["lr"] = self.options.learning_rate * warm * (0.97 * cosine + 0.03)

    def _without_the_lost(self, episode):
        g, state = episode.group, episode.state.map(torch.Tensor.detach)
        fine = ((state.base.l.norm(dim=-1) < LOST * self.bound) | ~g.mask[..., None]).all(1).all(0)  # false where not a number
        if bool(fine.all()):
            return state
        rest, keep = start(self.model, g, episode.size), fine[:, None]
        return State(
            state.base.where(fine, rest.base),
            torch.where(keep, state.l_before, rest.l_before),
            [tuple(torch.where(keep, x, torch.zeros_like(x)) for x in layer) for layer in state.memory],
            state.corrected.where(fine, rest.corrected),
        )

    def _tick_loss(self, episode, u, true):
        """Distance to the truth over what the modal base leaves of it: 1 is the base. u, true (R, n, B, 3)."""
        distance = ((u - true).square().sum(-1) + 1e-12).sqrt()
        return (distance * episode.weight * episode.group.share).sum() / u.shape[2]

    def _run_window(self, episode):
        felt, drive, turn, true = episode.next_window()
        state, packed, loss = self._without_the_lost(episode), self.model.packed(), 0.0
        for t in range(len(felt)):
            now = (turn[0][t], turn[1][t])
            fixed = (self.model, packed, episode.group, self.scaling, episode.static)
            state = tick(*fixed, state, felt[t], drive[t], now, episode.mirror)
            loss = loss + self._tick_loss(episode, state.base.u, true[t])
            if self.options.teacher_forced:
                state = stand_at(episode.group, self.scaling, true[t], state.base.u_before, state)
        episode.state = state
        return loss / len(felt)

    def update(self, episode):
        self._set_rate()
        loss = self._run_window(episode)
        self.optimizer.zero_grad()
        loss.backward()
        norm = torch.nn.utils.clip_grad_norm_(self.model.parameters(), 1.0)
        if torch.isfinite(norm):
            self.optimizer.step()
        self.updates += 1
        return float(loss)

    def new_episode(self):
        return Episode(self.bodies, self.scaling, self.options, self.model, self.weights)

    def validate(self):
        """Ratios to skinning, by ticks, of roll-outs from rest, or of single steps if they were trained;
        averaged over the bodies."""
        ratios, predict = {}, single_steps if self.options.teacher_forced else roll_out
        for g in self.validation:
            y, u = predict(self.model, self.scaling, g), truth(g)
            for k in [k for k in VALIDATED_TICKS if k < g.ticks] + ["all"]:
                ratios.setdefault(k, []).append(error_ratio(y, u, g.ticks if k == "all" else k))
        return {k: sum(v) / len(v) for k, v in ratios.items()}

    def consider(self, losses):
        ratios = self.validate()
        score = sum(ratios.values()) / len(ratios)
        if math.isfinite(score) and score < self.best:
            self.best, self.best_model = score, {k: v.clone() for k, v in self.model.state_dict().items()}
        self.curve.append(
            {
                "minutes": round(self.elapsed_s / 60, 3),
                "updates": self.updates,
                "loss": round(sum(losses) / max(1, len(losses)), 5),
                **{f"ratio_{k}": round(v, 4) for k, v in ratios.items()},
            }
        )
        self.log(
            f"{self.elapsed_s / 60:6.2f} min  {self.updates:5d} updates  loss {self.curve[-1]['loss']:.4f}  "
            "validation ratio " + "  ".join(f"{k}: {v:.3f}" for k, v in ratios.items()),
            flush=True,
        )

    def checkpoint(self):
        return {
            "model": self.model.state_dict(),
            "optimizer": self.optimizer.state_dict(),
            "best": self.best,
            "best_model": self.best_model,
            "elapsed_s": self.elapsed_s,
            "updates": self.updates,
            "curve": self.curve,
            "random": torch.get_rng_state(),
            "options": vars(self.options),
        }

    def resume(self, saved):
        self.model.load_state_dict(saved["model"])
        self.optimizer.load_state_dict(saved["optimizer"])
        self.best, self.best_model = saved["best"], saved["best_model"]
        self.elapsed_s, self.updates, self.curve = saved["elapsed_s"], saved["updates"], saved["curve"]
        torch.set_rng_state(saved["random"].cpu())

    def run(self, save_checkpoint):
        """To the end of the time, or of the updates; save_checkpoint() is called after every validation."""
        clock = (
            time.thread_time if self.options.device == "cpu" else time.monotonic
        )  # a busy machine must not make a worse network
        last, losses, episode = clock(), [], None
        next_s = self.elapsed_s + min(15.0, 6 * self.options.minutes)
        while self.fraction() < 1:
            if episode is None or episode.ticks_left() < 2:
                episode = self.new_episode()
            losses.append(self.update(episode))
            now = clock()
            self.elapsed_s, last = self.elapsed_s + now - last, now
            if self.elapsed_s >= next_s:
                self.consider(losses)
                save_checkpoint()
                losses = []
                next_s = self.elapsed_s + max(5.0, 60 * self.options.minutes / 16)
                last = clock()  # judging is not training
        self.consider(losses)
        self.model.load_state_dict(self.best_model or self.model.state_dict())
        return self


def _save_checkpoint(path, trainer):
    with written(path, "wb") as file:
        torch.save(trainer.checkpoint(), file)


def _same_run(saved, options):
    plain = lambda o: {k: v for k, v in o.items() if k not in ("device",)}
    return plain({**vars(TrainOptions()), **saved["options"]}) == plain(vars(options))


def _read(data, split, bodies):
    if not bodies:
        return dataset.read_split(data, split)
    return [pair for body in bodies for pair in dataset.read_split(data, split, body)]


def train(data, out, options, log=print):
    """Writes out/weights.safetensors, out/curve.json and out/checkpoint.pt; goes on from the checkpoint of a
    run that was cut."""
    options.check()
    if options.form and options.form not in FORMS:
        raise BadData(f"--form {options.form}: no such form; give one of {', '.join(FORMS)}, or none")
    train_set, validation_set = (_read(data, split, options.bodies) for split in ("train", "validation"))
    trainer = Trainer(
        dataset.group(train_set, options.device), dataset.group(validation_set, options.device), options, log
    )
    os.makedirs(out, exist_ok=True)
    checkpoint = os.path.join(out, "checkpoint.pt")
    if os.path.exists(checkpoint):
        saved = torch.load(checkpoint, map_location=options.device)
        if _same_run(saved, options):
            trainer.resume(saved)
            log(f"goes on from {checkpoint} at {trainer.elapsed_s / 60:.1f} minutes")
    parameters = sum(p.numel() for p in trainer.model.parameters())
    log(
        f"{len(train_set)} training and {len(validation_set)} validation sequences, {parameters} parameters, "
        f"seed {options.seed}",
        flush=True,
    )
    trainer.run(lambda: _save_checkpoint(checkpoint, trainer))
    _save_checkpoint(checkpoint, trainer)
    found = {"parameters": parameters, "best": trainer.best, "curve": trainer.curve}
    write_json(os.path.join(out, "curve.json"), {"options": vars(options), **found})
    save_weights(
        os.path.join(out, "weights.safetensors"),
        trainer.model,
        trainer.scaling,
        trainer.rate_hz,
        {
            "seed": options.seed,
            "recipe": json.dumps(vars(options)),
            "trained_minutes": f"{trainer.elapsed_s / 60:.2f}",
            "updates": trainer.updates,
            "validation_ratio": f"{trainer.best:.4f}",
            **({"sinew.model": "conv_lstm", "form": options.form} if options.form else {}),
        },
    )
    return trainer
