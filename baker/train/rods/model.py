"""COPINGNet (Shao et al. 2021, Sec. 3.1-3.2) as the runtime evaluates it: rods/start/coping_net.hpp."""
import torch

from .data import JOINT, TOLD


class Mlp(torch.nn.ModuleList):
    """`depth` hidden layers with max(0, x), one without."""

    def __init__(self, inputs, width, outputs, depth):
        widths = [inputs, *([width] * depth), outputs]
        super().__init__(torch.nn.Linear(a, b) for a, b in zip(widths, widths[1:]))

    def forward(self, z):
        for k, layer in enumerate(self):
            z = layer(z)
            if k + 1 < len(self):
                z = torch.relu(z)
        return z


class CopingNet(torch.nn.Module):
    def __init__(self, latent, blocks, depth, norm=3.0):
        super().__init__()
        chain = lambda inputs, outputs: Mlp(inputs, latent, outputs, depth)
        pair = lambda node, edge: torch.nn.ModuleDict({"node": node, "edge": edge})
        self.sizes = {"latent": latent, "blocks": blocks, "depth": depth}
        self.encoder = pair(chain(TOLD, latent), chain(JOINT, latent))
        self.blocks = torch.nn.ModuleList(
            pair(chain(2 * latent, latent), chain(3 * latent, latent)) for _ in range(blocks)
        )
        self.decoder = pair(chain(latent, 6), chain(latent, 6))
        fixed = lambda: torch.nn.Parameter(torch.full((6,), norm), requires_grad=False)
        self.norm = torch.nn.ParameterDict({"node": fixed(), "edge": fixed()})

    def forward(self, nodes, edges, senders, receivers):
        """nodes (n, 14), edges (m, 5), senders and receivers (m,). Returns (n, 6) and (m, 6)."""
        v, e = self.encoder["node"](nodes), self.encoder["edge"](edges)
        for block in self.blocks:
            e = e + block["edge"](torch.cat([e, v[senders], v[receivers]], 1))
            s = torch.zeros_like(v).index_add(0, senders, e).index_add(0, receivers, e)
            v = v + block["node"](torch.cat([v, s], 1))
        out = lambda of, x: torch.tanh(self.decoder[of](x)) * self.norm[of]
        return out("node", v), out("edge", e)
