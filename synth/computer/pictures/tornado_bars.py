"""Tornado: how far each uncertain input alone moves the net present value."""

from __future__ import annotations

import math

from matplotlib.figure import Figure
from matplotlib.patches import Patch

from synth.computer.economics.uncertainty.tornado import Tornado
from synth.computer.pictures.pay_back_over_traffic import THOUSAND
from synth.frame.picture.house_style import BLUE, INK, ORANGE, dress, legend_below, new_figure, place

MOST_BARS = 14


def tornado_bars(found: Tornado, currency: str) -> Figure:
    """A bar an input from its 5 % to its 95 % quantile, widest on top; ends that are impossible are left open."""
    bars = [bar for bar in found.bars if not math.isnan(bar.swing)][:MOST_BARS]
    left_out = len(found.bars) - len(bars)
    figure = new_figure(
        10.0, 1.9 + 0.34 * max(len(bars), 1), "Which input moves the net present value",
        f"{len(bars)} inputs, each alone, all others at their medians"
        + (f"; {left_out} more are left out" if left_out else ""),
    )  # fmt: skip
    place(figure, left=2.9, right=0.4, bottom=0.95, top=0.8)
    axes = figure.subplots()
    dress(axes, "", f"net present value, thousand {currency}", "")
    middle = found.at_medians / THOUSAND
    for row, bar in enumerate(reversed(bars)):
        for end, colour in ((bar.at_low, ORANGE), (bar.at_high, BLUE)):
            axes.barh(row, end / THOUSAND - middle, left=middle, color=colour, height=0.62, zorder=3)
    axes.set_yticks(range(len(bars)), [bar.input for bar in reversed(bars)], fontsize=8)
    axes.axvline(middle, color=INK, linewidth=0.8, zorder=4)
    axes.grid(False, axis="y")
    handles = [
        Patch(facecolor=ORANGE, label="input at its 5 % quantile"),
        Patch(facecolor=BLUE, label="at its 95 % quantile"),
    ]
    legend_below(figure, handles, columns=2)
    return figure
