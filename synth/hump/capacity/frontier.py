"""Catch-ups over cars an hour, a line a curve."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from synth.frame.picture.house_style import (
    INK,
    dress,
    graded,
    legend_below,
    logarithmic_y,
    markers,
    named_lines,
    new_figure,
    place,
)
from synth.hump.capacity.curves import Curve, Point

STEPS = 60
"""Of a line between two points, which is bent where the axis is logarithmic."""


def frontier(named: Sequence[tuple[str, Curve]], limit: float) -> Figure:
    """The curves by name; `limit`: the share of catch-ups that is allowed."""
    rows = -(-len(named) // 2)
    figure = new_figure(9.0, 5.4 + 0.2 * rows, "Catch-ups over cars an hour")
    place(figure, left=0.8, right=0.3, bottom=0.8 + 0.2 * rows, top=0.5)
    axes = figure.subplots()
    dress(axes, "", "cars an hour", "cuts that catch up, %")
    for (_, curve), colour, marker in zip(named, graded(len(named)), markers(len(named)), strict=True):
        draw_curve(axes, curve, colour, marker)
    logarithmic_y(
        axes, [*(share for _, curve in named for point in curve.points for share in ends(point)), 100.0 * limit]
    )
    axes.axhline(100.0 * limit, color=INK, linewidth=1.0, linestyle="--", zorder=2)
    legend_below(figure, named_lines([name for name, _ in named]), columns=2)
    return figure


def draw_curve(axes: Axes, curve: Curve, colour: str, marker: str) -> None:
    """Points with their intervals, joined as the limit is read; where no cut caught up, the end of the interval."""
    cars = [point.cars_per_hour.value for point in curve.points]
    shares = [100.0 * point.catch_ups.value for point in curve.points]
    between = np.linspace(0.0, len(cars) - 1.0, STEPS * (len(cars) - 1) + 1)
    places = np.arange(len(cars))
    axes.plot(
        np.interp(between, places, cars), np.interp(between, places, shares), color=colour, linewidth=1.4, zorder=4
    )
    for point in curve.points:
        at, share = point.cars_per_hour, 100.0 * point.catch_ups.value
        if share > 0.0:
            axes.plot(at.value, share, color=colour, marker=marker, markersize=5, zorder=4)
            axes.plot([at.value] * 2, ends(point), color=colour, linewidth=1.0, zorder=3)
            axes.plot([at.low95, at.high95], [share] * 2, color=colour, linewidth=1.0, zorder=3)
        else:
            axes.plot(
                at.value, ends(point)[1], color=colour, marker="v", markersize=6, markerfacecolor="none", zorder=4
            )


def ends(point: Point) -> tuple[float, float]:
    """The interval of the share, in per cent."""
    return 100.0 * point.catch_ups.low95, 100.0 * point.catch_ups.high95
