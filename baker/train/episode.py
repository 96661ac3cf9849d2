"""What a network is trained on for a while: a batch of sequences, some overdriven, some mirrored."""
import torch

from .inputs import INPUT_WIDTH
from .rollout import mirror_signs, start, static_columns

SILENT_FROM = 0.35  # of an episode: overdriven sequences are left in stillness from here on
SETTLED_TICKS = 100  # after which they should have come to rest


class Episode:
    """A batch of sequences of every body from rest to their end, window by window, with the state carried
    along. group: a Union; amplitudes: (R, S) of each of its bodies."""

    def __init__(self, group, scaling, options, model, amplitudes):
        g, b, device = group, options.batch, group.device
        self.group, self.scaling, self.options, self.size = group, scaling, options, b
        self.sequences = g.draw(b)
        self.free = torch.rand(b, device=device) < options.overdrive  # driven beyond the data: no truth
        still = ~self.free & (torch.rand(b, device=device) < options.stillness)
        self.gain = torch.where(self.free, 1 + 2 * torch.rand(b, device=device), (~still).float())
        mirrored = torch.rand(b, device=device) < 0.5 * options.mirror
        ones = torch.ones(INPUT_WIDTH, device=device)
        self.mirror = torch.where(mirrored[:, None], mirror_signs(device), ones)
        self.static = static_columns(g, scaling, b)
        self.weight = self._weights(amplitudes)
        self.state = start(model, g, b)
        self.done = 0

    def _weights(self, amplitudes):
        """(R, 1, B): errors in gentle sequences count for more, by the root of their amplitude."""
        share = lambda a, s: a.square().mean(1, keepdim=True).sqrt() / a[:, s]
        shares = torch.cat([share(a, s) for a, s in zip(amplitudes, self.sequences)])
        return shares.sqrt().clamp(0.3, 4)[:, None]

    def ticks_left(self):
        return self.group.ticks - self.done

    def _silent_ticks(self):
        """Ticks since the drive of overdriven sequences went silent."""
        return self.done - SILENT_FROM * self.group.ticks

    def known(self):
        """(B,) whether there is truth: not for the overdriven, until they have had time to come to rest,
        which is zero."""
        return ~self.free | (self._silent_ticks() > SETTLED_TICKS)

    def next_window(self):
        """As Group.window, with this episode's gains; truth of what is not driven is zero."""
        n = min(self.options.window, self.ticks_left())
        starts = torch.full((self.size,), self.done, device=self.group.device)
        felt, drive, turn, u = self.group.window(self.sequences, starts, n)
        silent = self.free & (self._silent_ticks() > 0)
        gain = torch.where(silent, torch.zeros_like(self.gain), self.gain)
        felt = felt * gain[:, None]
        rests = silent | (self.gain == 0)
        if bool(rests.any()):  # a character that stands still does not turn either
            drive = drive * ~rests[:, None]
            eye = torch.eye(3, device=felt.device)
            turn = tuple(torch.where(rests[:, None, None], eye, m) for m in turn)
        self.done += n
        return felt, drive, turn, u * ((self.gain > 0) & ~self.free)[:, None]
