"""Pictures of commands at any time: the surfaces of one stage, and what they gain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from scripts.studies.any_time.findings import CUBIC, SHOWN
from synth.present.plots.house_style import (
    GREY,
    INK,
    LINE_COLOURS,
    LINE_MARKERS,
    dress,
    legend_below,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from scripts.studies.any_time.findings import AnyTime, CaseRow, SurfaceMap

SLICES = 4
"""Places of the path at which the lines are drawn over pressure."""

WINDOW_M_S = (2.25, 6.5)
"""Speeds worth drawing."""


def surface_picture(found: SurfaceMap) -> Figure:
    """V_lo and V_hi of one commanded stage over path and actual pressure as maps, and slices with the polynomials."""
    title = f"Switching surfaces while stage {found.stage} ({found.stage_kpa:g} kPa) is commanded"
    figure = new_figure(11.0, 7.4, title, found.case)
    place(figure, left=0.75, right=0.35, bottom=0.95, top=0.9, w=0.26, h=0.4)
    panels = figure.subplots(2, 2)
    sides = (as_array(found.lower_m_s), as_array(found.upper_m_s))
    names = ("V_lo: below it one stage down", "V_hi: above it one stage up")
    for axes, lines, name in zip(panels[0], sides, names, strict=True):
        filled = speed_map(axes, found, lines)
        axes.axhspan(
            found.stage_kpa - found.band_kpa, found.stage_kpa + found.band_kpa, color=INK, alpha=0.25, linewidth=0
        )
        dress(axes, f"{name}, m/s (grey: at rest; white: never)", "path of the first axle, m", "actual pressure, kPa")
        bar = figure.colorbar(filled, ax=axes, fraction=0.04, pad=0.02)
        bar.ax.tick_params(labelsize=8)
    places = np.linspace(0.0, found.path_m[-1], SLICES + 2)[1:-1]
    for side, (axes, lines, title) in enumerate(zip(panels[1], sides, ("V_lo", "V_hi"), strict=True)):
        slices(axes, found, lines, side, places)
        axes.axvspan(
            found.stage_kpa - found.band_kpa, found.stage_kpa + found.band_kpa, color=INK, alpha=0.15, linewidth=0
        )
        inside = lines[(lines >= WINDOW_M_S[0]) & (lines <= WINDOW_M_S[1])]
        axes.set_ylim(max(inside.min() - 0.1, WINDOW_M_S[0]), min(inside.max() + 0.1, WINDOW_M_S[1]))
        dress(axes, f"{title} over pressure at four places of the path", "actual pressure, kPa", "speed, m/s")
    handles = [
        Line2D([], [], color=LINE_COLOURS[i], marker=LINE_MARKERS[i], label=f"s = {s:.1f} m", markersize=4)
        for i, s in enumerate(places)
    ]
    handles.append(Line2D([], [], color=GREY, linestyle="--", label="polished polynomials at the same places"))
    legend_below(figure, handles, columns=5)
    return figure


def as_array(rows: Sequence[Sequence[float | None]]) -> NDArray[np.float64]:
    """A surface; NaN where there is no command."""
    return np.array([[np.nan if value is None else value for value in row] for row in rows])


def speed_map(axes: Axes, found: SurfaceMap, lines_m_s: NDArray[np.float64]) -> QuadContourSet:
    """One surface as filled contours; places without a command and those outside the window stay white."""
    inside = (lines_m_s >= WINDOW_M_S[0]) & (lines_m_s <= WINDOW_M_S[1])
    shown = np.where(inside, lines_m_s, np.nan)
    step = 0.05 if np.nanmax(shown) - np.nanmin(shown) < 1.5 else 0.25
    levels = np.arange(np.floor(np.nanmin(shown) / step), np.ceil(np.nanmax(shown) / step) + 1) * step
    filled = axes.contourf(found.path_m, found.pressure_kpa, shown, levels=levels, cmap="cividis")
    thin = axes.contour(found.path_m, found.pressure_kpa, shown, levels=levels[::2], colors="white", linewidths=0.5)
    axes.clabel(thin, fontsize=7, fmt="%g")
    return filled


def slices(
    axes: Axes, found: SurfaceMap, lines_m_s: NDArray[np.float64], side: int, places_m: NDArray[np.float64]
) -> None:
    """Lines over pressure at some places: of the surfaces with marks, of the polynomials dashed."""
    pressure, powers = np.array(found.pressure_kpa), found.polished[side]
    for i, s in enumerate(places_m):
        column = lines_m_s[:, int(np.abs(np.array(found.path_m) - s).argmin())]
        axes.plot(pressure, column, color=LINE_COLOURS[i], marker=LINE_MARKERS[i], markersize=3.5, linewidth=1.2)
        if powers is not None:
            x, u = 0.01 * (pressure - found.stage_kpa), 2.0 * s / found.exit_m - 1.0
            by_power = np.polynomial.polynomial.polyval(u, np.array(powers).T)
            axes.plot(pressure, np.polynomial.polynomial.polyval(x, by_power), "--", color=LINE_COLOURS[i])


def gain_picture(rows: Sequence[CaseRow], names: Sequence[str], reference: str, near: bool) -> Figure:
    """Ratio of the rms (`near`: of the cuts near the target) to that of `reference`, a panel for each valve speed."""
    speeds = sorted({row.valves for row in rows})
    cases = list(dict.fromkeys(row.case for row in rows))
    what = "rms of the cuts within 0.3 m/s of the target" if near else "rms"
    figure = new_figure(4.0 * len(speeds) + 1.8, 0.55 * len(cases) + 2.3, f"What commands at any time gain: {what}",
                        f"ratio to: {reference}; bars: 95 %, paired; left of 1: better")  # fmt: skip
    place(figure, left=1.75, right=0.2, bottom=1.0, top=0.85, w=0.06)
    panels = np.atleast_1d(figure.subplots(1, len(speeds), sharey=True, sharex=True))
    for axes, speed in zip(panels, speeds, strict=True):
        mine = [row for row in rows if row.valves == speed]
        for i, name in enumerate(names):
            told = [row.controllers[name].near_ratio if near else row.controllers[name].ratio for row in mine]
            shift = 0.16 * (0.5 * (len(names) - 1) - i)
            y = [len(cases) - 1 - cases.index(row.case) + shift for row in mine]
            bars = [[r.value - r.ci95[0] for r in told], [r.ci95[1] - r.value for r in told]]
            axes.errorbar([r.value for r in told], y, xerr=bars, color=LINE_COLOURS[i], marker=LINE_MARKERS[i],
                          markersize=5, capsize=2, linewidth=1.0, linestyle="")  # fmt: skip
        axes.axvline(1.0, color=INK, linewidth=0.8)
        fast = "valves as they are" if speed == 1 else f"valves {speed:g} times as fast"
        dress(axes, fast, "rms / reference", "")
        axes.set_yticks(range(len(cases)), cases[::-1], fontsize=9)
        axes.set_xlim(0.55, 1.65)
    handles = [
        Line2D([], [], color=LINE_COLOURS[i], marker=LINE_MARKERS[i], linestyle="", label=name)
        for i, name in enumerate(names)
    ]
    legend_below(figure, handles, columns=3)
    return figure


def figures(found: AnyTime) -> Mapping[str, Figure]:
    """`gains`, `gains-near`, and `surfaces` where they were kept."""
    drawn = {"gains": gain_picture(found.rows, SHOWN, CUBIC, near=False)}
    drawn["gains-near"] = gain_picture(found.rows, SHOWN, CUBIC, near=True)
    if found.surface is not None:
        drawn["surfaces"] = surface_picture(found.surface)
    return drawn
