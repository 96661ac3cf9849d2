"""One picture: three panels next to each other and the curves, as a small PNG."""
import io

import matplotlib
import numpy as np
from PIL import Image

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

WIDTH, HEIGHT, DPI, MOST_BYTES = 1100, 360, 100, 150_000
PANEL_WIDTH, PANEL_HEIGHT, LEFT, TOP, GAP = 232, 276, 8, 58, 5
CURVES_LEFT, CURVES_HEIGHT = LEFT + 3 * (PANEL_WIDTH + GAP) + 48, PANEL_HEIGHT - 24
WORDS, COLOURS = ("low", "medium", "high"), ("#1b9aaa", "#33415c", "#d1495b")
INK, FAINT = "#1d2433", "#6b7280"
TINT_FULL = 0.08  # of the height
OUTLINE_LEGEND, TINT_LEGEND = "dashed: the outline by skinning alone", f"; yellow to red: displacement up to {100 * TINT_FULL:g} % of the height"


class Sheet:
    """A figure; positions are pixels from its top left corner."""

    def __init__(self):
        self.figure = plt.figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI, facecolor="white")

    def axes(self, left, top, width, height):
        return self.figure.add_axes((left / WIDTH, 1 - (top + height) / HEIGHT, width / WIDTH, height / HEIGHT))

    def write(self, left, top, text, color=INK, **how):
        """Returns where the text ends."""
        written = self.figure.text(left / WIDTH, 1 - top / HEIGHT, text, va="top", color=color, **how)
        return written.get_window_extent(self.figure.canvas.get_renderer()).x1

    def image(self):
        buffer = io.BytesIO()
        self.figure.savefig(buffer, format="png", dpi=DPI)
        plt.close(self.figure)
        return Image.open(buffer).convert("RGB")


def add_panel(sheet, left, picture, outline):
    """outline: how much of each pixel skinning alone covers, masked where it is not to be drawn."""
    axes = sheet.axes(left, TOP, PANEL_WIDTH, PANEL_HEIGHT)
    axes.imshow(picture, interpolation="none", aspect="auto")
    if outline.count() and outline.min() < 0.5 < outline.max():
        shown = outline.filled(np.nan)
        axes.contour(shown, levels=[0.5], colors=["white"], linewidths=2.2, alpha=0.55)
        axes.contour(shown, levels=[0.5], colors=[INK], linewidths=1.1, linestyles=[(0, (3, 2))])
    axes.set_axis_off()


def add_curves(sheet, times, curves, labels, shown):
    axes = sheet.axes(CURVES_LEFT, TOP, WIDTH - CURVES_LEFT - 10, CURVES_HEIGHT)
    for curve, label, colour in zip(curves, labels, COLOURS):
        axes.plot(times, curve, color=colour, linewidth=1.7, label=label)
    axes.axvline(times[shown], color=FAINT, linewidth=0.9, linestyle=":")
    low, high = axes.get_ylim()
    axes.set(xlim=(times[0], times[-1]), ylim=(low, high + 0.22 * (high - low)))  # room for the legend
    axes.grid(color="#e5e7eb", linewidth=0.8)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=9.5, colors=INK, length=3)
    axes.legend(loc="upper right", ncol=3, fontsize=9.5, frameon=False, handlelength=1.1, columnspacing=1.0, borderaxespad=0.1)
    axes.spines[["top", "right"]].set_visible(False)


def compose(scene, pictures, outlines, times, curves, shown):
    sheet, labels = Sheet(), [scene.label.format(value) for value in scene.values]
    sheet.write(sheet.write(LEFT, 8, scene.title, fontsize=13, weight="bold") + 8, 11, scene.note, fontsize=10.5)
    for i, (picture, outline) in enumerate(zip(pictures, outlines)):
        left = LEFT + i * (PANEL_WIDTH + GAP)
        sheet.write(left + 2, TOP - 21, f"{WORDS[i]}: {labels[i]}", COLOURS[i], fontsize=11, weight="bold")
        add_panel(sheet, left, picture, outline)
    sheet.write(LEFT, HEIGHT - 19, OUTLINE_LEGEND + (TINT_LEGEND if scene.view.tint else ""), fontsize=9.5)
    sheet.write(CURVES_LEFT - 36, TOP - 20, f"{scene.view.part}, {scene.view.towards} displacement (% of height)", fontsize=10)
    add_curves(sheet, times, curves, labels, shown)
    sheet.write(WIDTH - 10, HEIGHT - 19, "time (s); dotted: moment shown", fontsize=9.5, ha="right")
    return sheet.image()


def palette_of(image, colours):
    """The picture's own colours, and those of the curves, which few pixels have."""
    fixed = [int(colour[i:i + 2], 16) for colour in (*COLOURS, INK, "#ffffff") for i in (1, 3, 5)]
    most = image.quantize(colours - len(fixed) // 3, kmeans=1).getpalette()[:3 * colours - len(fixed)]
    out = Image.new("P", (1, 1))
    out.putpalette([*most, *fixed])
    return out


def write_png(image, path):
    part = path.with_suffix(".part")
    for colours in (256, 128, 64):
        image.quantize(palette=palette_of(image, colours), dither=Image.Dither.FLOYDSTEINBERG).save(part, format="PNG", optimize=True)
        if part.stat().st_size <= MOST_BYTES:
            break
    part.rename(path)
