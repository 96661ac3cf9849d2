"""Trains one network on roll-outs: its own output is fed back, as at run time."""
import json
import math
import os
import time

import torch

from . import dataset
from .dataset import input_columns
from .episode import Episode
from .inputs import INPUT_WIDTH
from .model import AltConvLSTM, ModelOptions
from .rollout import error_ratio, roll_out, truth
from .weights import save_weights

VALIDATED_TICKS = (50, 150)  # and the whole sequence


class Trainer:
    def __init__(self, train_groups, validation_groups, options, log=print):
        self.options, self.groups, self.validation, self.log = options, train_groups, validation_groups, log
        torch.manual_seed(options.seed)
        self.scaling = dataset.measure_scaling(train_groups)
        self.rate_hz = train_groups[0].trajectories[0].rate_hz
        self.model = (
            AltConvLSTM(
                ModelOptions(
                    INPUT_WIDTH,
                    tuple(options.channels),
                    True,
                    options.output_scale or self._liveliest_speed(),
                    options.output_leak,
                    options.hidden_leak,
                    options.state_clamp,
                )
            )
            .start_for_training()
            .to(options.device)
        )
        self.optimizer = torch.optim.Adam(self.model.parameters(), options.learning_rate)
        self.weight, self.rms, self.bound = zip(*(self._region_figures(g) for g in train_groups))
        self.elapsed_s, self.updates, self.best, self.best_model, self.curve = 0.0, 0, float("inf"), None, []

    def _liveliest_speed(self):
        """Mean speed of the region that moves most, doubled; length units a tick, two digits."""
        speed = [
            (g.displacement[:, 1:] - g.displacement[:, :-1]).norm(dim=-1).mean((0, 1)) for g in self.groups
        ]
        top = max(
            float(s[torch.as_tensor(g.body.region == r)].mean())
            for g, s in zip(self.groups, speed)
            for r in range(g.regions)
        )
        return float(f"{2 * top / self.scaling.length_unit_m:.1e}")

    def _region_figures(self, g):
        """For each region (R, 1, 1): loss weight, root mean square and bound of |u| in length units.

        Errors count by the root of the region's amplitude: between millimetres alike and shares alike."""
        u = (g.displacement[:, ::2] / self.scaling.length_unit_m).norm(dim=-1)
        shape = lambda values: torch.stack(values)[:, None, None]
        of = [u[..., torch.as_tensor(g.body.region == r)] for r in range(g.regions)]
        rms = shape([x.square().mean().sqrt().clamp(min=1e-4) for x in of])
        weight = rms.rsqrt()
        weight = weight / (weight * g.mask[:, :, None]).sum() * g.mask[:, :, None]
        return weight, rms, 1.2 * shape([x.max() for x in of])

    def fraction(self):
        return self.elapsed_s / (60 * self.options.minutes)

    def _set_rate(self):
        warm, cosine = min(1.0, self.updates / 30 + 0.1), 0.5 * (
            1 + math.cos(math.pi * min(1.0, self.fraction()))
        )
        for group in self.optimizer.param_groups:
            group["lr"] = self.options.learning_rate * warm * (0.97 * cosine + 0.03)

    def _start_of_window(self, episode, u, rms):
        """Own output of the last window, here and there replaced by truth, always a little disturbed. u (R,
        n, B, 3): truth there."""
        if episode.state is None:
            episode.state = self.model.zero_state(*u.shape[:3])
            episode.y = u
            episode.y_before = u
        y, y_before = episode.y.detach(), episode.y_before.detach()
        lost = (~torch.isfinite(y)).any(-1).any(1).any(0) | (
            (y - u).norm(dim=-1) > 4 * self.bound[episode.index]
        ).any(1).any(0) & ~episode.free
        help_out = torch.rand(u.shape[2], device=u.device) < max(0.02, 0.5 * (1 - 3 * self.fraction()))
        replaced = (lost | (help_out & ~episode.free))[None, None, :, None]
        episode.state = [
            tuple(torch.where(lost[None, None, :, None], torch.zeros_like(s), s.detach()) for s in layer)
            for layer in episode.state
        ]
        y, y_before = torch.where(replaced, u, y), torch.where(replaced, u, y_before)
        kick = torch.randn(u.shape[0], 1, u.shape[2], 3, device=u.device) * torch.rand(
            1, 1, u.shape[2], 1, device=u.device
        )
        return y + self.options.noise * rms[..., None] * kick, y_before

    def _tick_loss(self, episode, y, u):
        """Weighted distance to truth; where there is none, what exceeds the bound. y, u (R, n, B, 3)."""
        distance = ((y - u).square().sum(-1) + 1e-8).sqrt()
        excess = (y.square().sum(-1) + 1e-8).sqrt() - self.bound[episode.index] * episode.gain
        loss = torch.where(episode.known(), distance, excess.clamp(min=0))
        return (loss * self.weight[episode.index]).sum() / y.shape[2]

    def _run_window(self, episode):
        drive, u = episode.next_window()
        truth_share = max(0.0, 1 - self.fraction() / 0.35)  # scheduled sampling
        y, y_before = self._start_of_window(episode, u[0], self.rms[episode.index])
        packed, state, loss = self.model.packed(), episode.state, 0.0
        for t in range(1, len(u)):
            z = input_columns(episode.static, drive[t], y, y_before, self.scaling)
            y_before = y
            y, state = self.model.step(packed, episode.group.P, z, state, y)
            loss = loss + self._tick_loss(episode, y, u[t])
            if truth_share > 0:
                m = ((torch.rand(u.shape[3], device=u.device) < truth_share) & ~episode.free)[
                    None, None, :, None
                ]
                y, y_before = torch.where(m, u[t], y), torch.where(m, u[t - 1], y_before)
        episode.y, episode.y_before, episode.state = y, y_before, state
        return loss / (len(u) - 1)

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
        ticks = torch.tensor([float(g.count * g.ticks) for g in self.groups])
        index = int(torch.multinomial(ticks, 1))
        episode = Episode(self.groups[index], self.scaling, self.options)
        episode.index = index
        return episode

    def validate(self):
        """Ratios to skinning, by ticks, of roll-outs from rest; averaged over the groups."""
        ratios = {}
        for g in self.validation:
            y, u = roll_out(self.model, self.scaling, g), truth(g)
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
        """To the end of the time; save_checkpoint() is called after every validation."""
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
    torch.save(trainer.checkpoint(), f"{path}.part")
    os.replace(f"{path}.part", path)


def _same_run(saved, options):
    plain = lambda o: {k: v for k, v in o.items() if k not in ("device",)}
    return plain(saved["options"]) == plain(vars(options))


def train(data, out, options, log=print):
    """Writes out/weights.safetensors, out/curve.json and out/checkpoint.pt; goes on from the checkpoint of a
    run that was cut."""
    train_set, validation_set = dataset.read_split(data, "train"), dataset.read_split(data, "validation")
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
    with open(os.path.join(out, "curve.json"), "w") as file:
        json.dump(
            {
                "options": vars(options),
                "parameters": parameters,
                "best": trainer.best,
                "curve": trainer.curve,
            },
            file,
            indent=1,
        )
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
        },
    )
    return trainer
