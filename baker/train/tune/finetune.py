"""Goes on training given weights, by the clock on the wall, on one character's motions."""
import time
from dataclasses import replace

import torch

from ..learn.options import TrainOptions
from ..learn.scaling import measure_scaling
from ..learn.train import Trainer
from ..model.alt_conv_lstm import with_more_channels
from ..model.rollout import roll_out, truth

JUDGED_TIMES = 16  # in the whole time
LEAST_BETWEEN_S = 3.0  # judgements
CHANNELS = (16, 3)  # at least: a character's own network pays for its size
FOREIGN = 1.2  # of the base's error: weights that leave more know nothing of this character, so that it begins anew
EXACT_M = 1e-9  # an error that is none
HOPELESS = 0.98  # of the base's error, still left after
HOPELESS_AFTER = 0.4  # of the time: the rest would not do it


def widened(scaling, seen):
    """The scaling with an envelope that also holds what this character's motions show."""
    reach = {k: seen.envelope[k] / seen.scale[k] * scaling.scale[k] for k in scaling.envelope}
    return replace(scaling, envelope={k: max(v, reach[k]) for k, v in scaling.envelope.items()})


def errors_of(model, scaling, groups):
    """Mean distances to the truth, of each motion."""
    return [e for g in groups for e in (roll_out(model, scaling, g) - truth(g))[1:].norm(dim=-1).mean((0, 1)).tolist()]


class FineTuner(Trainer):
    """start: (model, scaling) that is trained on. Errors on validation motions are told over the modal base's."""

    def __init__(self, groups, validation, start, options, stop, clock=time.monotonic):
        torch.manual_seed(options.seed)
        model, scaling = with_more_channels(start[0], CHANNELS), start[1]
        scaling = widened(scaling, measure_scaling(groups))
        options = replace(options, channels=tuple(model.options.channels))
        super().__init__(groups, validation, options, lambda *a, **k: None, (model.train(), scaling))
        self.stop, self.clock, self.hopeless, self.improved = stop, clock, False, False
        self.of_base = [max(e, EXACT_M) for e in errors_of(None, None, validation)]
        self.given_ratio = self.validate()["of_base"]
        self.anew = self.given_ratio > FOREIGN
        if self.anew:
            self.begin_anew(_options(options.seed, channels=CHANNELS), measure_scaling(groups))

    def validate(self):
        """Motions alike, so that what gets worse on a calm one counts."""
        own = errors_of(self.model, self.scaling, self.validation)
        return {"of_base": sum(a / b for a, b in zip(own, self.of_base)) / len(own)}

    def _ended(self, end_s):
        return self.stop.asked or self.hopeless or self.clock() >= end_s

    def tune(self, end_s, report=lambda tuner: None, keep=lambda tuner: None):
        """Until end_s, or until it is clear that nothing is gained. The weights that it began with are judged first,
        and are the best until others are better on the validation motions. report(self): after every update; keep(self):
        when better ones are found."""
        began_s = self.clock()
        self.consider([])
        judging_s = self.clock() - began_s
        begin_s, end_s = self.clock(), end_s - judging_s
        between_s = max(LEAST_BETWEEN_S, 4 * judging_s, (end_s - begin_s) / JUDGED_TIMES)
        judged_s, losses, episode = begin_s, [], None
        self.options.minutes = max(1e-3, (end_s - begin_s) / 60)  # what the learning rate goes by
        while not self._ended(end_s):
            if episode is None or episode.ticks_left() < 2:
                episode = self.new_episode()
            losses.append(self.update(episode))
            self.elapsed_s = self.clock() - begin_s
            if self.clock() - judged_s >= between_s:
                self._judge(losses, keep)
                losses, judged_s = [], self.clock()
                self.hopeless = self.fraction() > HOPELESS_AFTER and self.best > HOPELESS
            report(self)
        if losses:
            self._judge(losses, keep)
        self.model.load_state_dict(self.best_model)
        return self

    def _judge(self, losses, keep):
        before = self.best
        self.consider(losses)
        if self.best < before:
            self.improved = True
            keep(self)


def _options(seed, **wiring):
    """The shipped weights' recipe; of one character more sequences fit into a batch, and its mirror image is nobody."""
    return TrainOptions(seed=seed, batch=12, mirror=False, **wiring)


def tuning_options(model, seed):
    """On the wiring of a given network."""
    o = model.options
    wiring = dict(hidden_leak=o.hidden_leak, output_scale=o.output_scale, state_clamp=o.state_clamp)
    return _options(seed, **wiring)
