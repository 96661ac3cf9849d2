"""Alt-ConvLSTM on control graphs: the equations of runtime/pack/format.hpp (NetworkRecord), for batches of
sequences.

Shapes: R regions of n nodes (shorter ones padded with isolated, unread nodes), B sequences, F channels. A
batch is (R, n, B, F), so that P, one dense (n, n) block a region, and the weights each act by one matrix
product."""
from dataclasses import asdict, dataclass, replace

import torch


FIRST_OUTPUT = 0.06  # share of a usual last layer to start from: a loud start ends in a silent network
OUTPUT_FORGET = 0.0  # bias


@dataclass
class ModelOptions:
    """channels: of every layer, the last is 3. The rest as in NetworkRecord; the defaults are the paper's
    wiring."""

    input_width: int = 9
    channels: tuple = (32, 64, 128, 64, 32, 3)
    self_weights: bool = False
    output_scale: float = 1.0
    output_leak: float = 0.0
    hidden_leak: float = 0.0
    state_clamp: float = float("inf")

    def as_dict(self):
        return asdict(self)


def normalized_adjacency(n, edges):
    """D^-1/2 (A + I) D^-1/2, dense (n, n); edges (m, 2) undirected, no self-loops."""
    a = torch.eye(n, dtype=torch.float64)
    e = torch.as_tensor(edges, dtype=torch.long)
    a[e[:, 0], e[:, 1]] = 1
    a[e[:, 1], e[:, 0]] = 1
    d = a.sum(1).rsqrt()
    return d[:, None] * a * d[None]


def fast_tanh(x):
    """tanh by the sigmoid: four times faster than torch.tanh on a CPU, and 1e-7 away."""
    return torch.sigmoid(2 * x) * 2 - 1


class Layer(torch.nn.Module):
    """Parameters of one layer, named and ordered as in the weights file: gates i, f, c, o; W_y: i, f, o."""

    def __init__(self, f_in, f, self_weights):
        super().__init__()
        scale = (f_in * (1 + self_weights) + f) ** -0.5
        draw = lambda rows, columns, s: torch.nn.Parameter(torch.randn(rows, columns) * s)
        self.W_x = draw(f_in, 4 * f, scale)
        self.W_s = draw(f_in, 4 * f, scale) if self_weights else None
        self.W_h = draw(f, 4 * f, scale)
        self.W_y = draw(f, 3 * f, scale / 2)
        self.b = torch.nn.Parameter(torch.randn(4 * f) * 0.05)

    @property
    def channels(self):
        return self.b.numel() // 4

    def packed(self):
        """(rows of x's aggregate, x itself, P h and P y stacked to one matrix (., 4F), W_y of the output
        gate)."""
        f = self.channels
        peephole = torch.cat([self.W_y[:, : 2 * f], self.W_y.new_zeros(f, 2 * f)], 1)
        rows = (
            [self.W_x, self.W_s, self.W_h, peephole]
            if self.W_s is not None
            else [self.W_x, self.W_h, peephole]
        )
        return torch.cat(rows), self.W_y[:, 2 * f :]


class AltConvLSTM(torch.nn.Module):
    """step() is pure: state in, state out. A layer's state is (P h, c, P y); the last layer's y is the
    caller's to keep, and may be replaced between steps (scheduled sampling)."""

    def __init__(self, options):
        super().__init__()
        self.options = options
        widths = (options.input_width,) + tuple(options.channels)
        self.layers = torch.nn.ModuleList(
            Layer(a, b, options.self_weights) for a, b in zip(widths, widths[1:])
        )

    def start_for_training(self):
        """Biases that trained: open input gates, short memory; a quiet last layer."""
        with torch.no_grad():
            for l, layer in enumerate(self.layers):
                f, last = layer.channels, l == len(self.layers) - 1
                layer.b[:f] += 1
                layer.b[f : 2 * f] += OUTPUT_FORGET if last else -1
            for w in (layer.W_x, layer.W_s, layer.W_h):
                if w is not None:
                    w.mul_(FIRST_OUTPUT)
        return self

    def zero_state(self, regions, nodes, batch):
        p = self.layers[0].b
        zero = lambda f: torch.zeros(regions, nodes, batch, f, dtype=p.dtype, device=p.device)
        return [tuple(zero(layer.channels) for _ in range(3)) for layer in self.layers]

    def packed(self):
        """The weights as step() takes them; once a window of steps, not once a step."""
        return [layer.packed() + (layer.b,) for layer in self.layers]

    def step(self, packed, P, z, state, y, carry=None):
        """One tick. P (R, n, n); z (R, n, B, input_width); y (R, n, B, 3) of the last tick. Returns y and
        state of this tick."""
        aggregate = lambda x: torch.bmm(P, x.reshape(x.shape[0], x.shape[1], -1)).view(x.shape)
        o, out = self.options, []
        x, px = z, aggregate(z)
        for l, ((weights, w_yo, b), (ph, c, py)) in enumerate(zip(packed, state)):
            f, last = c.shape[-1], l == len(packed) - 1
            if last:
                py = aggregate(y)
            a = torch.cat([px, x, ph, py] if o.self_weights else [px, ph, py], -1) @ weights + b
            gates = torch.sigmoid(a[..., : 2 * f])
            c = gates[..., f:] * c + gates[..., :f] * fast_tanh(a[..., 2 * f : 3 * f])
            if o.state_clamp != float("inf"):
                c = c.clamp(-o.state_clamp, o.state_clamp)
            if last:
                y = y * (1 - o.output_leak) + c * o.output_scale
                y = y if carry is None else y + carry
                py = aggregate(y)
            else:
                x, px = c, aggregate(c)
                py = py * (1 - o.hidden_leak) + px  # P y_t = (1 - leak) P y_{t-1} + P c_t
            h = torch.sigmoid(a[..., 3 * f :] + py @ w_yo) * fast_tanh(c)
            out.append((aggregate(h), c, py))
        return y, out


def with_more_channels(model, channels):
    """A model that answers as `model` does, with its hidden layers widened to so many channels, where they have fewer: what is
    new listens, drawn anew, and is not listened to yet."""
    old, widths = model.options, [max(a, b) for a, b in zip(model.options.channels[:-1], channels[:-1])]
    if len(channels) != len(old.channels) or tuple(widths) == tuple(old.channels[:-1]):
        return model
    wide = AltConvLSTM(replace(old, channels=(*widths, old.channels[-1]))).start_for_training().to(model.layers[0].b)
    with torch.no_grad():
        for to, layer in zip(wide.layers, model.layers):
            f, g = layer.channels, to.channels
            own = torch.cat([torch.arange(f) + k * g for k in range(4)])  # columns: a block for each gate
            to.b[own] = layer.b
            for name, gates in (("W_x", 4), ("W_s", 4), ("W_h", 4), ("W_y", 3)):
                a, b = getattr(to, name), getattr(layer, name)
                if a is not None:
                    a[:, own[: gates * f]] = 0
                    a[: len(b), own[: gates * f]] = b
    return wide


def largest_cell(state):
    """Largest |c| over layers: (R, n, B) -> number."""
    return max(float(c.abs().max()) for _, c, *_ in state)
