"""The picture of the study `rare-events`: P(over by more than x), a panel a case, bands for intervals and bounds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.present.plots.house_style import (
    BLUE,
    GREEN,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    mark_plainly,
    new_figure,
    place,
)
from synth.studies.rare_events.findings import DENSITY, IMPORTANCE, PLAIN, SUBSET

if TYPE_CHECKING:
    from synth.studies.rare_events.findings import MethodTails, RareEvents

STYLES = {
    DENSITY: (SKY, "-", 5.0),
    PLAIN: (BLUE, "-", 1.2),
    IMPORTANCE: (VERMILLION, "--", 1.2),
    SUBSET: (GREEN, ":", 1.8),
}
"""Colour, line and width of a method, in the order of drawing: they lie on one another."""

LOWEST = 1e-12


def picture(found: RareEvents) -> Figure:
    """All cases."""
    rows = math.ceil(len(found.cases) / 2)
    figure = new_figure(
        10.0, 4.0 * rows, "How often a cut leaves too fast", "bands: 95 % intervals, bound of the density"
    )
    place(figure, left=0.8, right=0.2, bottom=1.0, top=0.8, w=0.18, h=0.28)
    panels = np.atleast_1d(figure.subplots(rows, 2, sharex=True, sharey=True)).ravel()
    handles: list[Line2D] = []
    for axes, case in zip(panels, found.cases, strict=False):
        dress(axes, case.case, "exit speed above target by more than, m/s", "probability")
        by_name = {each.method: each for each in case.methods}
        handles = [curve(axes, found.curve_m_s, by_name[name]) for name in STYLES if name in by_name]
        axes.set(yscale="log", ylim=(1e-9, 1e-1), xlim=(0.0, max(found.curve_m_s)))
        mark_plainly(axes.yaxis, 1e-9, 1e-1)
    for axes in panels[len(found.cases) :]:
        axes.set_visible(False)
    legend_below(figure, handles, len(handles), 0.12)
    return figure


def curve(axes: Axes, curve_m_s: tuple[float, ...], method: MethodTails) -> Line2D:
    """One method; margins at which it saw nothing are left out."""
    seen = [(x, tail) for x, tail in zip(curve_m_s, method.tails, strict=True) if tail[0] > 0.0]
    x = [margin for margin, _ in seen]
    colour, style, width = STYLES[method.method]
    low, high = [max(tail[1], LOWEST) for _, tail in seen], [tail[2] for _, tail in seen]
    axes.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0.0)
    (line,) = axes.plot(x, [tail[0] for _, tail in seen], linestyle=style, color=colour, linewidth=width,
                        label=method.method)  # fmt: skip
    return line


def figures(found: RareEvents) -> Mapping[str, Figure]:
    """A panel a case."""
    return {"": picture(found)}
