"""Pictures of the unlocked mode: the surfaces of one stage, and what unlocking gains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

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
from synth.studies.unlocked.laws import CompactController
from synth.studies.unlocked.surfaces import SwitchingSurfaces

SLICES = 4
"""Places of the path at which the lines are drawn over pressure."""


def surface_picture(
    surfaces: SwitchingSurfaces,
    compact: CompactController,
    stage: int,
    stage_kpa: float,
    window_m_s: tuple[float, float],
    subject: str,
) -> Figure:
    """V_lo and V_hi of one commanded stage over path and actual pressure as maps, and slices with the compact lines."""
    figure = new_figure(11.0, 7.4, f"Switching surfaces while stage {stage} ({stage_kpa:g} kPa) is commanded", subject)
    place(figure, left=0.75, right=0.35, bottom=0.95, top=0.9, w=0.26, h=0.4)
    panels = figure.subplots(2, 2)
    pressure, modes = surfaces.of_stage(stage)
    band = surfaces.modes.drive.band_kpa
    sides = ((surfaces.lower_m_s, "V_lo: below it one stage down"), (surfaces.upper_m_s, "V_hi: above it one stage up"))
    for axes, (lines, name) in zip(panels[0], sides, strict=True):
        filled = speed_map(axes, surfaces.nodes_m, pressure, lines[modes], window_m_s)
        axes.axhspan(stage_kpa - band, stage_kpa + band, color=INK, alpha=0.25, linewidth=0)
        dress(axes, f"{name}, m/s (grey: at rest; white: never)", "path of the first axle, m", "actual pressure, kPa")
        bar = figure.colorbar(filled, ax=axes, fraction=0.04, pad=0.02)
        bar.ax.tick_params(labelsize=8)
    places = np.linspace(0.0, surfaces.nodes_m[-1], SLICES + 2)[1:-1]
    for side, (axes, lines, title) in enumerate(
        zip(panels[1], (surfaces.lower_m_s, surfaces.upper_m_s), ("V_lo", "V_hi"), strict=True)
    ):
        slices(axes, surfaces.nodes_m, pressure, lines[modes], places, compact, stage, stage_kpa, side)
        axes.axvspan(stage_kpa - band, stage_kpa + band, color=INK, alpha=0.15, linewidth=0)
        inside = lines[modes][(lines[modes] >= window_m_s[0]) & (lines[modes] <= window_m_s[1])]
        axes.set_ylim(max(inside.min() - 0.1, window_m_s[0]), min(inside.max() + 0.1, window_m_s[1]))
        dress(axes, f"{title} over pressure at four places of the path", "actual pressure, kPa", "speed, m/s")
    handles = [
        Line2D([], [], color=LINE_COLOURS[i], marker=LINE_MARKERS[i], label=f"s = {s:.1f} m", markersize=4)
        for i, s in enumerate(places)
    ]
    handles.append(Line2D([], [], color=GREY, linestyle="--", label="compact form at the same places"))
    legend_below(figure, handles, columns=5)
    return figure


def speed_map(
    axes: Axes,
    path_m: NDArray[np.float64],
    pressure_kpa: NDArray[np.float64],
    lines_m_s: NDArray[np.float64],
    window_m_s: tuple[float, float],
) -> QuadContourSet:
    """One surface as filled contours; infinite places and those outside the window stay white."""
    inside = np.isfinite(lines_m_s) & (lines_m_s >= window_m_s[0]) & (lines_m_s <= window_m_s[1])
    shown = np.where(inside, lines_m_s, np.nan)
    step = 0.05 if np.nanmax(shown) - np.nanmin(shown) < 1.5 else 0.25
    levels = np.arange(np.floor(np.nanmin(shown) / step), np.ceil(np.nanmax(shown) / step) + 1) * step
    filled = axes.contourf(path_m, pressure_kpa, shown, levels=levels, cmap="cividis")
    thin = axes.contour(path_m, pressure_kpa, shown, levels=levels[::2], colors="white", linewidths=0.5)
    axes.clabel(thin, fontsize=7, fmt="%g")
    return filled


def slices(
    axes: Axes,
    path_m: NDArray[np.float64],
    pressure_kpa: NDArray[np.float64],
    lines_m_s: NDArray[np.float64],
    places_m: NDArray[np.float64],
    compact: CompactController,
    stage: int,
    stage_kpa: float,
    side: int,
) -> None:
    """Lines over pressure at some places: of the surfaces with marks, of the compact form dashed."""
    for i, s in enumerate(places_m):
        column = lines_m_s[:, int(np.abs(path_m - s).argmin())]
        column = np.where(np.isfinite(column), column, np.nan)
        axes.plot(pressure_kpa, column, color=LINE_COLOURS[i], marker=LINE_MARKERS[i], markersize=3.5, linewidth=1.2)
        if compact.has_line[stage, side]:
            x, u = 0.01 * (pressure_kpa - stage_kpa), 2.0 * s / compact.exit_m - 1.0
            by_power = np.polynomial.polynomial.polyval(u, compact.coefficients[stage, side].T)
            axes.plot(pressure_kpa, np.polynomial.polynomial.polyval(x, by_power), "--", color=LINE_COLOURS[i])


def gain_picture(rows: Sequence[Mapping[str, Any]], names: Sequence[str], reference: str, figure_of: str) -> Figure:
    """Ratio of the rms `figure_of` ("ratio" or "near_ratio") to that of `reference`, a panel for each valve speed."""
    speeds = sorted({row["valves"] for row in rows})
    cases = list(dict.fromkeys(row["case"] for row in rows))
    what = "rms" if figure_of == "ratio" else "rms of the cuts within 0.3 m/s of the target"
    figure = new_figure(4.0 * len(speeds) + 1.8, 0.55 * len(cases) + 2.3, f"What unlocking gains: {what}",
                        f"ratio to: {reference}; bars: 95 %, paired; left of 1: better")  # fmt: skip
    place(figure, left=1.75, right=0.2, bottom=1.0, top=0.85, w=0.06)
    panels = np.atleast_1d(figure.subplots(1, len(speeds), sharey=True, sharex=True))
    for axes, speed in zip(panels, speeds, strict=True):
        for i, name in enumerate(names):
            for row in rows:
                if row["valves"] != speed:
                    continue
                ratio, (low, high) = row["controllers"][name][figure_of], row["controllers"][name][f"{figure_of}_ci95"]
                y = len(cases) - 1 - cases.index(row["case"]) + 0.16 * (0.5 * (len(names) - 1) - i)
                axes.errorbar([ratio], [y], xerr=[[ratio - low], [high - ratio]], color=LINE_COLOURS[i],
                              marker=LINE_MARKERS[i], markersize=5, capsize=2, linewidth=1.0)  # fmt: skip
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
