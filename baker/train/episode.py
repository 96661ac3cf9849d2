"""What a network is trained on for a while: a batch of sequences, some overdriven, some mirrored."""
import torch

from .dataset import drive_columns

SILENT_FROM = 0.35  # of an episode: overdriven sequences are left in stillness from here on
SETTLED_TICKS = 100  # after which they should have come to rest


class Episode:
    """A batch of sequences from some tick to their end, window by window, with the network's state carried
    along."""

    def __init__(self, group, scaling, options):
        g, b, device = group, min(options.batch, group.count), group.device
        self.group, self.scaling, self.options, self.size = group, scaling, options, b
        self.sequences = torch.randperm(g.count, device=device)[:b]
        late = torch.rand(b, device=device) < 0.4
        latest = max(1, g.ticks // 4)  # the batch ends with its latest
        self.starts = torch.where(
            late,
            torch.randint(1, latest + 1, (b,), device=device),
            torch.zeros(b, dtype=torch.long, device=device),
        )
        self.free = torch.rand(b, device=device) < options.overdrive  # driven beyond the data: no truth
        still = ~self.free & (torch.rand(b, device=device) < options.stillness)
        self.gain = torch.where(self.free, 1 + 2 * torch.rand(b, device=device), (~still).float())
        self.starts = torch.where(still, torch.zeros_like(self.starts), self.starts)
        self.sign = self._mirror_signs(torch.rand(b, device=device) < 0.5 * options.mirror)
        self.static = self._static()
        self.done = 0
        self.state = None

    def _mirror_signs(self, mirrored):
        """(B, 34): left to right flips x of vectors, and y and z of rotation vectors."""
        polar, axial = [-1.0, 1, 1], [1.0, -1, -1]
        flip = torch.tensor(polar * 2 + [1.0] + polar * 4 + axial * 2 + polar * 3, device=mirrored.device)
        return torch.where(mirrored[:, None], flip, torch.ones_like(flip))

    def _static(self):
        return self.group.static_columns(self.scaling, self.size) * self.sign[:, :7]

    def ticks_left(self):
        return int(self.group.ticks - self.starts.max()) - self.done

    def _silent_ticks(self):
        """Ticks since the drive of overdriven sequences went silent."""
        return self.done - SILENT_FROM * (self.group.ticks - int(self.starts.max()))

    def _overdrive(self, drive):
        """Stronger, and silent late in the episode; angular velocity by the root, as its square drives."""
        g = self.gain[:, None].expand(-1, 21).clone()
        g[:, 15:18] = g[:, 15:18].sqrt()
        return drive * torch.where(self.free[:, None] & (self._silent_ticks() > 0), torch.zeros_like(g), g)

    def known(self):
        """(B,) whether there is truth: not for the overdriven, until they have had time to come to rest,
        which is zero."""
        return ~self.free | (self._silent_ticks() > SETTLED_TICKS)

    def next_window(self):
        """Scaled drive (W+1, R, n, B, 21) and truth (W+1, R, n, B, 3) in length units; the first is the tick
        before the window."""
        ticks = min(self.options.window, self.ticks_left())
        drive, u = self.group.window(self.sequences, self.starts + self.done, ticks)
        drive = drive_columns(self._overdrive(drive) * self.sign[:, 7:28], self.scaling)
        u = (
            u
            / self.scaling.length_unit_m
            * self.sign[:, 28:31]
            * (self.gain * ~self.free)[:, None].clamp(max=1)
        )
        self.done += ticks
        return drive, u
