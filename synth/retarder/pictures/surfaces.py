"""The switching lines as surfaces V_lo(s, P) and V_hi(s, P) over path and pressure."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]  # ships no type information
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection  # type: ignore[import-untyped]  # the same
from numpy.typing import NDArray

from synth.frame.picture.house_style import BLUE, INK, VERMILLION, legend_below, new_figure
from synth.retarder.pictures.stage_surfaces import sheet
from synth.solver.switching_lines import SwitchingLines

PATH_POINTS = 25
POINTS_PER_STAGE = 3
"""Quadrilaterals between two neighbouring stages."""


def surface_figure(
    title: str,
    subject: str,
    lines: SwitchingLines,
    pressure_kpa: NDArray[np.float64],
    window_m_s: tuple[float, float],
) -> Figure:
    """Path in m, pressure in kPa (linear between stages), speed in m/s upwards, cut off at the speeds in the window.

    `pressure_kpa` (stages,) of the stages that are shown: the first of `lines`.
    """
    figure = new_figure(7.6, 6.4, title, subject)
    axes = Axes3D(figure, rect=(0.0, 0.04, 0.95, 0.92), computed_zorder=False)
    figure.add_axes(axes)
    path, stages = lines.nodes_m, len(pressure_kpa)
    for all_speeds, colour, alpha in ((lines.lower_m_s, BLUE, 0.75), (lines.upper_m_s, VERMILLION, 0.45)):
        speeds = all_speeds[:stages]
        has_line = np.isfinite(speeds).any(axis=1)
        if has_line.any():
            shown = np.clip(speeds[has_line], *window_m_s)
            axes.add_collection3d(sheet_of_lines(path, pressure_kpa[has_line], shown, colour, alpha), autolim=False)
            axes.add_collection3d(ribs(path, pressure_kpa[has_line], shown, colour), autolim=False)
    axes.set(xlim=(path[0], path[-1]), ylim=(pressure_kpa[0], pressure_kpa[-1]), zlim=window_m_s)
    axes.set_xlabel("path of the first axle, m", fontsize=9)
    axes.set_ylabel("pressure, kPa", fontsize=9)
    axes.set_zlabel("speed, m/s", fontsize=9)
    axes.set_yticks(pressure_kpa)
    axes.tick_params(labelsize=8)
    axes.view_init(elev=17.0, azim=-52.0)
    axes.set_box_aspect((1.25, 1.0, 0.85), zoom=1.12)
    handles = [
        Patch(facecolor=VERMILLION, alpha=0.6, edgecolor=INK, label="above it: one stage up"),
        Patch(facecolor=BLUE, alpha=0.6, edgecolor=INK, label="below it: one stage down"),
    ]
    legend_below(figure, handles, columns=2, bottom_in=0.12)
    return figure


def sheet_of_lines(
    path_m: NDArray[np.float64],
    pressure_kpa: NDArray[np.float64],
    speed_m_s: NDArray[np.float64],
    colour: str,
    alpha: float,
) -> Poly3DCollection:
    """Quadrilaterals through the stage lines `speed_m_s` (stages, path)."""
    steps = np.linspace(0.0, len(pressure_kpa) - 1.0, POINTS_PER_STAGE * (len(pressure_kpa) - 1) + 1)
    stage = np.arange(len(pressure_kpa))
    p = np.interp(steps, stage, pressure_kpa)
    v = np.array([np.interp(steps, stage, column) for column in speed_m_s.T]).T
    return sheet(path_m, p, v, colour, alpha)


def ribs(
    path_m: NDArray[np.float64], pressure_kpa: NDArray[np.float64], speed_m_s: NDArray[np.float64], colour: str
) -> Line3DCollection:
    """The stage lines themselves, as they are exported."""
    pairs = zip(pressure_kpa, speed_m_s, strict=True)
    lines = [np.column_stack([path_m, np.full_like(path_m, pressure), speed]) for pressure, speed in pairs]
    return Line3DCollection(lines, colors=colour, linewidths=1.8)
