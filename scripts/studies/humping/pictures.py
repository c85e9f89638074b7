"""The picture of the study `hump-day`: catch-ups over the hump speed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scripts.studies.humping.frontier import sigma
from synth.frame.picture.house_style import (
    GREY,
    LINE_COLOURS,
    LINE_MARKERS,
    LINE_STYLES,
    dress,
    legend_below,
    logarithmic_y,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from scripts.studies.humping.frontier import Curve
    from scripts.studies.humping.study import HumpDay

LEAST_SHARE = 2e-4
"""Shares below are drawn here: the axis is logarithmic."""


def catch_ups(found: HumpDay) -> Figure:
    """Share of catch-ups over the mean hump speed with normal positions, a panel an exactness."""
    stds = sorted(found.inputs.stds_m_s)
    panels = {f"σ {std:g} m/s": [each for each in found.curves if each.positions == sigma(std)] for std in stds}
    figure = new_figure(3.8 * max(len(panels), 2), 4.8, "Catch-ups over the mean hump speed",
                        f"{found.inputs.trains} trains; bars: 95 % intervals; a point for each program; dotted: the "
                        "shares that are told")  # fmt: skip
    place(figure, left=0.8, right=0.4, bottom=1.0, top=0.85, w=0.12)
    every = np.atleast_1d(figure.subplots(1, len(panels), sharey=True))
    for axes, (head, curves) in zip(every, panels.items(), strict=True):
        dress(axes, head, "mean hump speed, m/s", "share of cuts" if axes is every[0] else "")
        for k, curve in enumerate(curves):
            line(axes, curve, k)
        for at in found.curves[0].at_limits:
            axes.axhline(at.limit, color=GREY, linewidth=0.8, linestyle=":")
    logarithmic_y(every[0], (LEAST_SHARE, 0.5))  # after all are dressed, which share this axis
    legend_below(figure, every[0].get_legend_handles_labels()[0], 6)
    return figure


def line(axes: Axes, curve: Curve, k: int) -> None:
    """One curve."""
    days = [point.figures for point in curve.points]
    speeds = np.array([day.hump_speed_m_s.value for day in days])
    shares = np.array([max(day.catch_ups.value, LEAST_SHARE) for day in days])
    low, high = (np.array([max(day.catch_ups.ci95[side], LEAST_SHARE) for day in days]) for side in (0, 1))
    axes.errorbar(
        speeds, shares, yerr=np.maximum((shares - low, high - shares), 0.0), color=LINE_COLOURS[k],
        linestyle=LINE_STYLES[k], marker=LINE_MARKERS[k], markersize=4, capsize=2, linewidth=1.2, label=curve.control,
    )  # fmt: skip


def figures(found: HumpDay) -> Mapping[str, Figure]:
    """The one picture."""
    return {"catch-ups": catch_ups(found)}
