"""Best command over path and speed, one panel a stage, with the switching lines and some passes on it."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from synth.frame.picture.house_style import (
    BLUE,
    ENTRANCE_STYLE,
    GREY,
    INK,
    VERMILLION,
    dress,
    mark_zones,
)
from synth.retarder.case_result import CaseResult
from synth.retarder.command_panels import DOWN, HATCH, HOLD, UP, command_image, label_panels, stage_panels
from synth.retarder.pictures.speed_window import speed_window_m_s
from synth.simulation.passes import PassTrace

PASSES_SHOWN = 3


def policy_map(case: CaseResult) -> Figure:
    """Path in m across, speed in m/s upwards; colours: command, hatched: several commands cost the same."""
    stages = case.study.solver_lines.stages
    figure, grid = stage_panels("Best command by stage", f"{case.cut_name}, {case.target_name}", stages)
    for stage in range(stages):
        draw_stage(grid.flat[stage], case, stage)
    label_panels(grid, stages)
    box = grid.flat[stages].get_position()
    figure.legend(
        handles=legend_entries(case), loc="center", bbox_to_anchor=(box.x0, box.y0, box.width, box.height), fontsize=9,
        frameon=False,
    )  # fmt: skip
    return figure


def draw_stage(axes: Axes, case: CaseResult, stage: int) -> None:
    """One panel: map, solver's lines (dots), exported lines (bold), passes while they were in this stage."""
    low, high = speed_window_m_s(case)
    ends_m = case.plant.start_m, case.plant.exit_m
    pixels = round(axes.bbox.width), round(axes.bbox.height)
    image = command_image(case.study.policy_map, stage, ends_m, (low, high), pixels)
    axes.imshow(image, extent=(*ends_m, low, high), origin="lower", aspect="auto", interpolation="none")
    raw, exported = case.study.solver_lines, case.study.table_lines
    sides = ((raw.lower_m_s, exported.lower_m_s, BLUE, "--"), (raw.upper_m_s, exported.upper_m_s, VERMILLION, "-"))
    for dots, line, colour, style in sides:
        axes.plot(raw.nodes_m, finite(dots[stage]), ".", color=colour, markersize=2.2, zorder=3)
        axes.plot(exported.nodes_m, finite(line[stage]), style, color=colour, linewidth=2.2, zorder=5)
    axes.plot(*parts_in_stage(case.traces[:PASSES_SHOWN], stage), color=INK, linewidth=0.8, zorder=6)
    mark_zones(axes, case.plant.position.zones_m, case.plant.start_m)
    dress(axes, f"stage {stage} · {case.plant.position.stage_pressures_kpa[stage]:g} kPa")
    axes.grid(False)
    axes.set(xlim=ends_m, ylim=(low, high))


def finite(line: NDArray[np.float64]) -> NDArray[np.float64]:
    """The line with gaps where the stage has no such command."""
    return np.where(np.isfinite(line), line, np.nan)


def parts_in_stage(traces: tuple[PassTrace, ...], stage: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Path and speed of all passes while `stage` was commanded, gaps (NaN) between the parts."""
    paths, speeds = [np.empty(0)], [np.empty(0)]
    for trace in traces:
        inside = trace.stage == stage
        shown = inside.copy()
        shown[1:] |= inside[:-1]  # a stage holds up to the next event
        paths += [trace.path_m, np.array([np.nan])]
        speeds += [np.where(shown, trace.speed_m_s, np.nan), np.array([np.nan])]
    return np.concatenate(paths), np.concatenate(speeds)


def legend_entries(case: CaseResult) -> list[Artist]:
    """What the colours, hatches and lines of a panel mean."""
    entrance = [Line2D([], [], color=INK, linewidth=0.8, linestyle=ENTRANCE_STYLE, label="entrance")]
    return [
        Patch(facecolor=UP, edgecolor=GREY, label="best: one stage up (brake more)"),
        Patch(facecolor=HOLD, edgecolor=GREY, label="best: hold"),
        Patch(facecolor=DOWN, edgecolor=GREY, label="best: one stage down (release)"),
        Patch(facecolor="white", edgecolor=HATCH, hatch="////", label="indifferent: commands cost the same"),
        Line2D([], [], color=VERMILLION, linewidth=2.2, label="exported line: stage up above it"),
        Line2D([], [], color=BLUE, linewidth=2.2, linestyle="--", label="exported line: stage down below it"),
        Line2D([], [], color=GREY, marker=".", linestyle="", markersize=5, label="solver's lines, unsmoothed"),
        Line2D([], [], color=INK, linewidth=0.8, label="simulated passes while in the stage"),
        Patch(facecolor=INK, label="retarder zones"),
        *(entrance if case.plant.start_m < 0.0 else ()),
    ]
