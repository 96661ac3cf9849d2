"""What a network is trained on for a while: a batch of sequences, half of them mirrored, some of them still."""
import torch

from ..model.inputs import INPUT_WIDTH
from ..model.rollout import mirror_signs, start, static_columns


class Episode:
    """A batch of sequences of every body from rest to their end, window by window, with the state carried
    along. group: a Union; weights: (R, S) of each of its bodies, what an error in a sequence counts for."""

    def __init__(self, group, scaling, options, model, weights):
        g, b, device = group, options.batch, group.device
        self.group, self.options, self.size = group, options, b
        self.sequences = g.draw(b)
        self.still = torch.rand(b, device=device) < options.stillness
        self.mirror = None
        if options.mirror:
            ones = torch.ones(INPUT_WIDTH, device=device)
            self.mirror = torch.where((torch.rand(b, device=device) < 0.5)[:, None], mirror_signs(device), ones)
        self.static = static_columns(g, scaling, b)
        self.weight = torch.cat([w[:, s] for w, s in zip(weights, self.sequences)])[:, None]  # (R, 1, B)
        self.state = start(model, g, b)
        self.done = 0

    def ticks_left(self):
        return self.group.ticks - self.done

    def next_window(self):
        """As Group.window; what stands still is not driven and rests."""
        n = min(self.options.window, self.ticks_left())
        starts = torch.full((self.size,), self.done, device=self.group.device)
        self.done += n
        felt, drive, turn, u = self.group.window(self.sequences, starts, n)
        if bool(self.still.any()):
            moves = (~self.still).to(felt.dtype)[:, None]
            eye = torch.eye(3, device=felt.device)
            turn = tuple(torch.where(self.still[:, None, None], eye, m) for m in turn)
            felt, drive, u = felt * moves, drive * moves, u * moves
        return felt, drive, turn, u
