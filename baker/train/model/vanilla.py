"""The vanilla ConvLSTM that Deng, Mu, Hu 2020 measure Alt-ConvLSTM against: Shi et al. 2015 (Eq. 3, with
peepholes) on a graph. A baseline; the runtime does not run it.

    i, f = sigmoid(P x W_x + x W_s + P h W_h + w_c * c_{t-1} + b)
    c_t  = f * c_{t-1} + i * tanh(P x W_x + x W_s + P h W_h + b)
    o    = sigmoid(P x W_x + x W_s + P h W_h + w_c * c_t + b),   h_t = o * tanh(c_t)

P x W_x + x W_s takes the place of the image convolution (x W_s is its centre, as in the shipped network), a
peephole weighs each channel alike at all nodes, and h goes on to the next layer. The output is linear in the
h of all layers at the node: Shi et al.'s 1 x 1 convolution, which unlike h is not bounded.

Shapes as in alt_conv_lstm.py."""
import torch

from .alt_conv_lstm import FIRST_OUTPUT, fast_tanh
from .inputs import FEEDBACK, ORDER, STATIC, columns

# The paper's: given the current (last tick's) or the next pose, it predicts Y or its change.
FORMS = ("CP_dY", "CP_Y", "NP_dY", "NP_Y")


class Cell(torch.nn.Module):
    """One layer. Gates i, f, o, then the candidate for c; w_c: i, f, o."""

    def __init__(self, f_in, f):
        super().__init__()
        scale = (2 * f_in + f) ** -0.5
        draw = lambda rows: torch.nn.Parameter(torch.randn(rows, 4 * f) * scale)
        self.W_x, self.W_s, self.W_h = draw(f_in), draw(f_in), draw(f)
        self.w_c = torch.nn.Parameter(torch.zeros(3 * f))
        self.b = torch.nn.Parameter(torch.zeros(4 * f))

    def forward(self, weights, x, px, ph, c, clamp):
        """weights: W_x, W_s, W_h stacked. Returns h and c of this tick."""
        f = c.shape[-1]
        a = torch.cat([px, x, ph], -1) @ weights + self.b
        i = torch.sigmoid(a[..., :f] + self.w_c[:f] * c)
        forget = torch.sigmoid(a[..., f : 2 * f] + self.w_c[f : 2 * f] * c)
        c = (forget * c + i * fast_tanh(a[..., 3 * f :])).clamp(-clamp, clamp)
        o = torch.sigmoid(a[..., 2 * f : 3 * f] + self.w_c[2 * f :] * c)
        return o * fast_tanh(c), c


class ConvLSTM(torch.nn.Module):
    """In place of an AltConvLSTM, as tick() runs it. form: one of FORMS. A layer's state is (P h, c); the
    first one's also holds the last tick's z."""

    def __init__(self, options, form):
        super().__init__()
        self.options, self.form = options, form
        widths = (options.input_width, *options.channels)
        self.layers = torch.nn.ModuleList(Cell(a, b) for a, b in zip(widths, widths[1:]))
        self.W_out = torch.nn.Parameter(torch.randn(sum(options.channels), 3) * sum(options.channels) ** -0.5)
        self.b_out = torch.nn.Parameter(torch.zeros(3))
        late = torch.zeros(options.input_width, dtype=torch.bool)
        if form.startswith("CP"):
            for name in set(ORDER) - set(STATIC) - set(FEEDBACK):
                late[columns(name)] = True
        self.register_buffer("late", late, persistent=False)  # a tick: the drive, and products with it

    def start_for_training(self):
        """Long memory (Jozefowicz et al. 2015); a small output."""
        with torch.no_grad():
            for layer, f in zip(self.layers, self.options.channels):
                layer.b[f : 2 * f] += 1
            self.W_out.mul_(FIRST_OUTPUT)
        return self

    def zero_state(self, regions, nodes, batch):
        zero = lambda f: self.b_out.new_zeros(regions, nodes, batch, f)
        state = [(zero(f), zero(f)) for f in self.options.channels]
        return [(*state[0], zero(self.options.input_width)), *state[1:]]

    def packed(self):
        return [torch.cat([layer.W_x, layer.W_s, layer.W_h]) for layer in self.layers]

    def step(self, packed, P, z, state, y, carry=None):
        """As AltConvLSTM.step; carry counts where the change of y is predicted."""
        aggregate = lambda x: torch.bmm(P, x.reshape(x.shape[0], x.shape[1], -1)).view(x.shape)
        x = torch.where(self.late, state[0][2], z)
        px, memory, hidden = aggregate(x), [], []
        for layer, weights, (ph, c, *_) in zip(self.layers, packed, state):
            x, c = layer(weights, x, px, ph, c, self.options.state_clamp)
            px = aggregate(x)
            memory.append((px, c))
            hidden.append(x)
        memory[0] = (*memory[0], z)
        out = self.options.output_scale * (torch.cat(hidden, -1) @ self.W_out + self.b_out)
        if self.form.endswith("dY"):
            out = out + y if carry is None else out + y + carry
        return out, memory
