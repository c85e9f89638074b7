"""The surfaces V_lo and V_hi over path and pressure: of a table for commands at any time, and through lines."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]  # ships no type information
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection  # type: ignore[import-untyped]  # the same

from plant_models.frozen_arrays import Floats
from synth.frame.picture.house_style import BLUE, INK, VERMILLION, legend_below, new_figure
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import lines_of
from tuning_tables.table import ControllerTable

PATH_POINTS, PRESSURE_POINTS = 25, 9

COLUMNS = 3


def stage_surfaces(table: ControllerTable, subject: str, window_m_s: tuple[float, float]) -> Figure:
    """A panel for each stage that `table`, which has a gauge, raises to; speeds cut off at the window.

    Path in m, actual pressure in kPa, speed in m/s upwards; heavy lines: at the pressure of the stage.
    """
    stages = table.highest_raised + 1
    rows, columns = math.ceil(stages / COLUMNS), min(stages, COLUMNS)
    figure = new_figure(4.1 * columns, 3.7 * rows + 1.2, "Switching surfaces over path and actual pressure", subject)
    top, bottom = 1.0 - 0.75 / figure.get_figheight(), 0.5 / figure.get_figheight()
    height = (top - bottom) / rows
    for stage in range(stages):
        row, column = divmod(stage, columns)
        place = (column / columns, top - (row + 1) * height, 0.94 / columns, 0.98 * height)
        axes = Axes3D(figure, rect=place, computed_zorder=False)
        figure.add_axes(axes)
        draw_stage(axes, table, stage, window_m_s)
    at_stage = Line2D([], [], color=INK, linewidth=1.8, label="at the pressure of the stage")
    legend_below(figure, [*sides(), at_stage], columns=3, bottom_in=0.12)
    return figure


def sides() -> list[Patch]:
    """What the colours of the two surfaces mean."""
    return [
        Patch(facecolor=VERMILLION, alpha=0.6, edgecolor=INK, label="above it: one stage up"),
        Patch(facecolor=BLUE, alpha=0.6, edgecolor=INK, label="below it: one stage down"),
    ]


def draw_stage(axes: Axes3D, table: ControllerTable, stage: int, window_m_s: tuple[float, float]) -> None:
    """Both surfaces of one commanded stage."""
    path = np.linspace(*table.valid.s_m, PATH_POINTS)
    lines, own = lines_of(table, path), float(table.pressures[stage])
    pressure = np.linspace(float(table.pressures[0]), float(table.pressures[table.highest_raised]), PRESSURE_POINTS)
    sides = ((lines.lower_m_s[stage], BLUE, 0.75), (lines.upper_m_s[stage], VERMILLION, 0.45))
    for side, (line, colour, alpha) in enumerate(sides):
        known = np.isfinite(line)
        if not known.any():
            continue
        speed = line[known] + float(table.slopes[stage, side]) * (pressure - own)[:, None]
        axes.add_collection3d(sheet(path[known], pressure, np.clip(speed, *window_m_s), colour, alpha), autolim=False)
        inside = known & (line >= window_m_s[0]) & (line <= window_m_s[1])
        axes.plot(path, np.full(len(path), own), np.where(inside, line, np.nan), color=INK, linewidth=1.8)
    axes.set(xlim=(path[0], path[-1]), ylim=(pressure[0], pressure[-1]), zlim=window_m_s)
    axes.set_title(f"stage {stage} commanded · {table.stages[stage].pressure_kpa:g} kPa", fontsize=9, y=0.98)
    axes.set_xlabel("path, m", fontsize=8, labelpad=-4)
    axes.set_ylabel("pressure, kPa", fontsize=8, labelpad=-2)
    axes.set_zlabel("speed, m/s", fontsize=8, labelpad=-4)
    axes.tick_params(labelsize=7, pad=-1)
    axes.view_init(elev=20.0, azim=-58.0)
    axes.set_box_aspect((1.2, 1.0, 0.85), zoom=0.92)


def sheet(path_m: Floats, pressure_kpa: Floats, speed_m_s: Floats, colour: str, alpha: float) -> Poly3DCollection:
    """Quadrilaterals of the surface `speed_m_s` (pressures, path)."""
    corners = np.stack(np.broadcast_arrays(path_m, pressure_kpa[:, None], speed_m_s), axis=-1)
    quads = np.stack([corners[:-1, :-1], corners[:-1, 1:], corners[1:, 1:], corners[1:, :-1]], axis=2)
    return Poly3DCollection(
        quads.reshape(-1, 4, 3), facecolors=colour, edgecolors="white", linewidths=0.25, alpha=alpha, shade=False
    )


POINTS_PER_STAGE = 3
"""Quadrilaterals between two neighbouring stages."""


def surface_figure(
    title: str, subject: str, lines: SwitchingLines, pressure_kpa: Floats, window_m_s: tuple[float, float]
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
    legend_below(figure, sides(), columns=2, bottom_in=0.12)
    return figure


def sheet_of_lines(
    path_m: Floats, pressure_kpa: Floats, speed_m_s: Floats, colour: str, alpha: float
) -> Poly3DCollection:
    """Quadrilaterals through the stage lines `speed_m_s` (stages, path)."""
    steps = np.linspace(0.0, len(pressure_kpa) - 1.0, POINTS_PER_STAGE * (len(pressure_kpa) - 1) + 1)
    stage = np.arange(len(pressure_kpa))
    p = np.interp(steps, stage, pressure_kpa)
    v = np.array([np.interp(steps, stage, column) for column in speed_m_s.T]).T
    return sheet(path_m, p, v, colour, alpha)


def ribs(path_m: Floats, pressure_kpa: Floats, speed_m_s: Floats, colour: str) -> Line3DCollection:
    """The stage lines themselves, as they are exported."""
    pairs = zip(pressure_kpa, speed_m_s, strict=True)
    lines = [np.column_stack([path_m, np.full_like(path_m, pressure), speed]) for pressure, speed in pairs]
    return Line3DCollection(lines, colors=colour, linewidths=1.8)
