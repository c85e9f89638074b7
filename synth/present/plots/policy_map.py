"""Best command over path and speed, one panel a stage, with the switching lines and some passes on it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba_array
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from synth.book.case_names import cut_name, target_name
from synth.book.case_result import CaseResult, PolicyMap
from synth.present.plots.house_style import (
    BLUE,
    ENTRANCE_STYLE,
    GREY,
    INK,
    VERMILLION,
    dress,
    mark_zones,
    new_figure,
    place,
    speed_window_m_s,
)
from synth.simulation.passes import PassTrace

DOWN, HOLD, UP, HATCH = "#cfe4f3", "#fafafa", "#fae0cf", "#b5b5b5"
STRIPE_PERIOD, STRIPE_WIDTH = 9, 2
"""Of the hatching, in pixels along the path."""

PASSES_SHOWN = 3


def policy_map(case: CaseResult) -> Figure:
    """Path in m across, speed in m/s upwards; colours: command, hatched: several commands cost the same."""
    stages = case.study.solver_lines.stages
    figure, grid = stage_panels("Best command by stage", f"{cut_name(case)}, {target_name(case)}", stages)
    for stage in range(stages):
        draw_stage(grid.flat[stage], case, stage)
    label_panels(grid, stages)
    box = grid.flat[stages].get_position()
    figure.legend(
        handles=legend_entries(case), loc="center", bbox_to_anchor=(box.x0, box.y0, box.width, box.height), fontsize=9,
        frameon=False,
    )  # fmt: skip
    return figure


def stage_panels(title: str, subject: str, stages: int) -> tuple[Figure, Any]:
    """A figure with a panel for each stage and at least one free place, path across and speed upwards; and its grid."""
    columns = math.ceil((stages + 1) / 2)
    figure = new_figure(3.7 * columns + 0.4, 6.6, title, subject)
    place(figure, left=0.6, right=0.2, bottom=0.5, top=0.85, w=0.08, h=0.22)
    grid = figure.subplots(2, columns, sharex=True, sharey=True)
    for free in grid.flat[stages:]:
        free.set_axis_off()
    return figure, grid


def label_panels(grid: Any, stages: int) -> None:
    """Names and units on the outer panels of `stage_panels`, after they are drawn."""
    for stage in range(stages):
        below_is_free = stage + grid.shape[1] >= stages
        grid.flat[stage].tick_params(labelbottom=below_is_free)
        if below_is_free:
            grid.flat[stage].set_xlabel("path of the first axle, m", fontsize=9)
    for row in grid:
        row[0].set_ylabel("speed, m/s", fontsize=9)


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
    axes.plot(*parts_in_stage(case.study.traces[:PASSES_SHOWN], stage), color=INK, linewidth=0.8, zorder=6)
    mark_zones(axes, case.plant.position.zones_m, case.plant.start_m)
    dress(axes, f"stage {stage} · {case.plant.position.stage_pressures_kpa[stage]:g} kPa")
    axes.grid(False)
    axes.set(xlim=ends_m, ylim=(low, high))


def finite(line: NDArray[np.float64]) -> NDArray[np.float64]:
    """The line with gaps where the stage has no such command."""
    return np.where(np.isfinite(line), line, np.nan)


def command_image(
    policy: PolicyMap,
    stage: int,
    ends_m: tuple[float, float],
    speeds_m_s: tuple[float, float],
    pixels: tuple[int, int],
) -> NDArray[np.uint8]:
    """The map of one stage as colours (speed, path, 4) on an even mesh of `pixels`, path by speed; slowest first."""
    width, height = pixels
    path = ends_m[0] + (np.arange(width) + 0.5) / width * (ends_m[1] - ends_m[0])
    speed = speeds_m_s[0] + (np.arange(height) + 0.5) / height * (speeds_m_s[1] - speeds_m_s[0])
    node = np.clip(np.searchsorted(policy.path_m, path, side="right") - 1, 0, policy.path_m.size - 1)
    here = np.ix_(node, nearest(policy.speed_m_s, speed))
    shown = policy.command[stage][here].T + 1
    stripe = (np.arange(width) - np.arange(height)[:, None]) % STRIPE_PERIOD < STRIPE_WIDTH
    shown[stripe & policy.indifferent[stage][here].T] = 3
    colours = np.round(255.0 * to_rgba_array([DOWN, HOLD, UP, HATCH])).astype(np.uint8)
    image: NDArray[np.uint8] = colours[shown]
    return image


def nearest(nodes: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Index of the node nearest to each value; `nodes` increase."""
    return np.searchsorted(0.5 * (nodes[1:] + nodes[:-1]), values)


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
