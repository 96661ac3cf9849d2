"""DeepEmulator (Zheng et al. 2021, Eq. 5) as the runtime evaluates it: tissue/network/deep_emulator.hpp."""
import torch

LATENT = 64  # the paper's: widths of alpha; beta's are twice, gamma's three times as wide
MOTION, MATERIAL = 15, 3
CENTRE, PATCH = MOTION + MATERIAL, MOTION + 18 + MATERIAL + 1


class Mlp(torch.nn.ModuleList):
    """Four hidden layers with tanh, one without."""

    def __init__(self, inputs, hidden, outputs):
        widths = [inputs, hidden, hidden, hidden, hidden, outputs]
        super().__init__(torch.nn.Linear(a, b) for a, b in zip(widths, widths[1:]))

    def forward(self, z):
        for k, layer in enumerate(self):
            z = layer(z)
            if k + 1 < len(self):
                z = torch.tanh(z)
        return z


def _blocks(rows):
    """(3 len(rows), 3 k) of {column: factor} a row, each standing for three axes."""
    width = 3 * (1 + max(c for row in rows for c in row))
    out = torch.zeros(3 * len(rows), width)
    for r, row in enumerate(rows):
        for c, factor in row.items():
            for axis in range(3):
                out[3 * r + axis, 3 * c + axis] = factor
    return out


# Of patches that are told two ticks the rows of a third are zero, and second differences say nothing.
# What a node's motion says at a glance: displacement, how u goes on, acceleration, the pose ahead and behind.
_CENTRE_ROWS = [{0: 1}, {1: 1, 0: -1}, {2: 1, 1: -2, 0: 1}, {3: 1, 4: 1}, {3: 1, 4: -1}]
# And a neighbour's: strain and its first two differences, where it stands in the pose, and how that turns.
_NEIGHBOUR_ROWS = [
    {5: 1, 0: -1, 9: -1},
    {6: 1, 1: -1, 5: -1, 0: 1},
    {7: 1, 2: -1, 6: -2, 1: 2, 5: 1, 0: -1},
    {8: 1, 3: -1, 9: -1},
    {9: 1},
    {10: 1, 4: -1, 9: -1},
]


def glance(of_patch):
    """(inputs, inputs): what is fed as the paper has it, as differences; linear, so that first layers absorb it."""
    motion = _blocks(_CENTRE_ROWS + (_NEIGHBOUR_ROWS if of_patch else []))
    rest = MATERIAL + (1 if of_patch else 0)
    return torch.block_diag(motion, torch.eye(rest))


class DeepEmulator(torch.nn.Module):
    def __init__(self, latent=LATENT):
        super().__init__()
        self.latent = latent
        self.alpha = Mlp(CENTRE, latent, latent)
        self.beta = Mlp(PATCH, 2 * latent, 2 * latent)
        self.gamma = Mlp(3 * latent, 3 * latent, 3)

    def forward(self, centre, material, patch, owner):
        """centre (n, 15), material (n, 3), patch (m, 37), owner (m,) of patches. Returns u' - u (n, 3)."""
        summed = torch.zeros(len(centre), 2 * self.latent, dtype=centre.dtype)
        summed = summed.index_add(0, owner, self.beta(patch))
        return self.gamma(torch.cat([self.alpha(torch.cat([centre, material], 1)), summed], 1))


class Scaled(torch.nn.Module):
    """The same network while it is trained: it sees differences of unit size, and answers in its own unit."""

    def __init__(self, latent):
        super().__init__()
        self.net = DeepEmulator(latent)
        for name, of_patch in (("alpha", False), ("beta", True)):
            rows = glance(of_patch)
            self.register_buffer(f"{name}_rows", rows)
            self.register_buffer(f"{name}_mean", torch.zeros(len(rows)))
            self.register_buffer(f"{name}_size", torch.ones(len(rows)))
        self.register_buffer("answer_size", torch.tensor(1.0))

    def fit(self, centre, material, patch, answers):
        """Means and sizes of a sample."""
        for name, z in (("alpha", torch.cat([centre, material], 1)), ("beta", patch)):
            seen = z @ getattr(self, f"{name}_rows").T
            getattr(self, f"{name}_mean").copy_(seen.mean(0))
            getattr(self, f"{name}_size").copy_(seen.std(0).clamp(min=1e-3))
        self.answer_size.copy_(answers.square().mean().sqrt())

    def _see(self, name, z):
        return (z @ getattr(self, f"{name}_rows").T - getattr(self, f"{name}_mean")) / getattr(self, f"{name}_size")

    def forward(self, centre, material, patch, owner):
        seen = self._see("alpha", torch.cat([centre, material], 1))
        net = self.net(seen[:, :MOTION], seen[:, MOTION:], self._see("beta", patch), owner)
        return self.answer_size * net

    def absorbed(self):
        """The network as the paper has it, that answers alike."""
        out = DeepEmulator(self.net.latent)
        out.load_state_dict(self.net.state_dict())
        with torch.no_grad():
            for name in ("alpha", "beta"):
                first = getattr(out, name)[0]
                weight = first.weight.double() / getattr(self, f"{name}_size").double()
                first.bias.copy_(first.bias - weight @ getattr(self, f"{name}_mean").double())
                first.weight.copy_(weight @ getattr(self, f"{name}_rows").double())
                # Seen from where it goes on, the centre is where it was in the ticks before: of equal inputs one is enough,
                # and their differences would be rounding alone.
                first.weight[:, 0:3] += first.weight[:, 3:6] + first.weight[:, 6:9]
                first.weight[:, 3:9] = 0
                if name == "beta":  # a neighbour's third tick is made of its other two
                    first.weight[:, 15:18] -= first.weight[:, 21:24]
                    first.weight[:, 18:21] += 2 * first.weight[:, 21:24]
                    first.weight[:, 21:24] = 0
            last = out.gamma[-1]
            last.weight.mul_(self.answer_size)
            last.bias.mul_(self.answer_size)
        return out
