"""The pictures of the study `hump-day`: catch-ups over the hump speed, over-speeds over gaps."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scripts.studies.humping.closed_loops import REGULATED, REGULATORS
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
    from scripts.studies.humping.couplings import AimedFigures
    from scripts.studies.humping.findings import HumpDay
    from scripts.studies.humping.frontier import Curve

LEAST_SHARE = 2e-4
"""Shares below are drawn here: the axis is logarithmic."""


def catch_ups(found: HumpDay) -> Figure:
    """Share of catch-ups over the mean hump speed with normal positions, a panel an exactness."""
    stds = sorted(found.inputs.stds_m_s)
    panels = {f"σ {std:g} m/s": of_positions(found, sigma(std)) for std in stds}
    return curves(found, panels, "Catch-ups over the mean hump speed")


def positions(found: HumpDay) -> Figure:
    """The same with every kind of positions, a panel a control."""
    stds = sorted(found.inputs.stds_m_s, reverse=True)
    kinds = [*map(sigma, stds), *REGULATORS]
    shown = {(each.positions, each.control): each for each in found.curves}
    panels = {
        control: {name: shown[name, control] for name in kinds if (name, control) in shown} for control in REGULATED
    }
    return curves(found, panels, "Catch-ups over the mean hump speed, by the kind of positions")


def of_positions(found: HumpDay, name: str) -> dict[str, Curve]:
    """Curves of one kind of positions by control."""
    return {curve.control: curve for curve in found.curves if curve.positions == name}


def curves(found: HumpDay, shown: Mapping[str, Mapping[str, Curve]], title: str) -> Figure:
    """A panel for each of `shown`, with its lines by name."""
    figure = new_figure(3.8 * max(len(shown), 2), 4.8, title,
                        f"{found.inputs.trains} trains; bars: 95 % intervals; a point for each program; dotted: the "
                        "shares that are told")  # fmt: skip
    place(figure, left=0.8, right=0.4, bottom=1.0, top=0.85, w=0.12)
    panels = np.atleast_1d(figure.subplots(1, len(shown), sharey=True))
    for axes, (head, lines) in zip(panels, shown.items(), strict=True):
        dress(axes, head, "mean hump speed, m/s", "share of cuts" if axes is panels[0] else "")
        for k, (name, curve) in enumerate(lines.items()):
            line(axes, curve, name, k)
        for at in found.curves[0].at_limits:
            axes.axhline(at.limit, color=GREY, linewidth=0.8, linestyle=":")
    logarithmic_y(panels[0], (LEAST_SHARE, 0.5))  # after all are dressed, which share this axis
    legend_below(figure, panels[0].get_legend_handles_labels()[0], 6)
    return figure


def line(axes: Axes, curve: Curve, name: str, k: int) -> None:
    """One curve."""
    days = [point.figures for point in curve.points]
    speeds = np.array([day.hump_speed_m_s.value for day in days])
    shares = np.array([max(day.catch_ups.value, LEAST_SHARE) for day in days])
    low, high = (np.array([max(day.catch_ups.ci95[side], LEAST_SHARE) for day in days]) for side in (0, 1))
    axes.errorbar(
        speeds, shares, yerr=np.maximum((shares - low, high - shares), 0.0), color=LINE_COLOURS[k],
        linestyle=LINE_STYLES[k], marker=LINE_MARKERS[k], markersize=4, capsize=2, linewidth=1.2, label=name,
    )  # fmt: skip


def couplings(found: HumpDay) -> Figure:
    """Over-speeds over gaps, a panel a length of the free tracks."""
    frees = list(dict.fromkeys(each.aimed.free for each in found.couplings))
    figure = new_figure(9.6, 4.8, "Over-speeds over the gap a cut",
                        f"{found.inputs.trains} trains, with feedback; bars: 95 % intervals")  # fmt: skip
    place(figure, left=0.8, right=0.4, bottom=1.0, top=0.85, w=0.2)
    panels = np.atleast_1d(figure.subplots(1, len(frees)))
    for axes, free in zip(panels, frees, strict=True):
        dress(axes, f"tracks free {free[0]:g}–{free[1]:g}", "gap a cut, m", "share above 1.39 m/s")
        rows = [each for each in found.couplings if each.aimed.free == free]
        for k, std in enumerate(dict.fromkeys(each.aimed.std_m_s for each in rows)):
            cross(axes, [each for each in rows if each.aimed.std_m_s == std], k)
        axes.set_ylim(bottom=0.0)
    legend_below(figure, panels[0].get_legend_handles_labels()[0], 5)
    return figure


def cross(axes: Axes, rows: list[AimedFigures], k: int) -> None:
    """All ways of commanding one exactness."""
    days = [each.found.feedback for each in rows]
    gaps, shares = ([value.value for value in of] for of in ([d.gap_m for d in days], [d.overspeed for d in days]))
    errors = [
        np.transpose([(v.value - v.ci95[0], v.ci95[1] - v.value) for v in of])
        for of in ([d.gap_m for d in days], [d.overspeed for d in days])
    ]
    place_of = k % len(LINE_COLOURS)
    axes.errorbar(
        gaps, shares, xerr=errors[0], yerr=errors[1], color=LINE_COLOURS[place_of], linestyle="",
        marker=LINE_MARKERS[k % len(LINE_MARKERS)], markersize=5, capsize=2, label=f"σ {rows[0].aimed.std_m_s:.3g}",
    )  # fmt: skip


def figures(found: HumpDay) -> Mapping[str, Figure]:
    """All of them by name."""
    return {"catch-ups": catch_ups(found), "positions": positions(found), "couplings": couplings(found)}
