"""One case in one picture: a run over path by the stage in force, and beside it how all simulated cuts leave."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import ConnectionPatch, Patch
from matplotlib.typing import LineStyleType
from numpy.typing import NDArray

from synth.frame.picture.house_style import (
    GREY,
    INK,
    PALE_GREY,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    mark_entrance,
    new_figure,
    place,
)
from synth.retarder.case_result import CaseResult
from synth.retarder.pictures.exit_density import bin_edges_m_s, predicted_density
from synth.retarder.pictures.stage_colours import colour_of, finite, outcome
from synth.simulation.exit_statistics import OVERSPEED_M_S
from synth.simulation.passes import TRACE_FACTORS, PassTrace

NOMINAL: Final = TRACE_FACTORS.index(1.0)
"""Which of the traced passes is drawn: that of mean friction."""

NEAR_M_S: Final = 1.2 * OVERSPEED_M_S
"""Half of the speeds that the right panel shows, around the target."""

TARGET_STYLE: Final[LineStyleType] = (0, (4, 3))
LOWER_STYLE: Final[LineStyleType] = (0, (3, 2))
"""Of the line below which a stage goes one down."""

LEAST_NAMED_M: Final = 2.0
"""A shorter part of the run has no room for the number of its stage."""

LAST_M: Final = 2.0
"""So near to the end of the run its outcome is written."""


def case_picture(case: CaseResult) -> Figure:
    """Left: speed in m/s over path in m. Right: the density of exit speeds, the speed axis enlarged at the target."""
    figure = new_figure(6.2, 3.5, f"{case.label} to {case.target_speed_m_s:g} m/s")
    place(figure, left=0.55, right=0.12, bottom=1.02, top=0.42, w=0.3)
    run, exits = figure.subplots(1, 2, width_ratios=(2.6, 1.0))
    draw_run(run, case)
    draw_exits(exits, case)
    enlarge(figure, run, exits, case)
    legend_below(figure, legend_entries(case), columns=4)
    return figure


def draw_run(axes: Axes, case: CaseResult) -> None:
    """Zones, the run in the colour of the stage in force, and the lines of that stage."""
    for start_m, end_m in case.plant.position.zones_m:
        axes.axvspan(start_m, end_m, color=PALE_GREY, linewidth=0, zorder=0)
    mark_entrance(axes, case.plant.start_m)
    axes.axhline(case.target_speed_m_s, color=INK, linewidth=0.8, linestyle=TARGET_STYLE, zorder=1)
    dress(axes, "", "path of the first axle, m", "speed, m/s")
    axes.grid(False)
    runs = case.traces[NOMINAL : NOMINAL + 1]
    lowest = min([case.target_speed_m_s - 1.0, *(float(run.speed_m_s.min()) - 0.1 for run in runs)])
    axes.set(
        xlim=(case.plant.start_m, case.plant.exit_m + 0.4), ylim=(max(0.0, lowest), case.plant.entry.high_m_s + 0.4)
    )
    for run in runs:
        for start, end in parts(run):
            stage, ends_m = int(run.stage[start]), (float(run.path_m[start]), float(run.path_m[end]))
            axes.plot(
                run.path_m[start : end + 1], run.speed_m_s[start : end + 1], color=colour_of(stage), linewidth=2.2,
                solid_capstyle="round", zorder=5,
            )  # fmt: skip
            draw_lines(axes, case, stage, ends_m)
            name_part(axes, run, start, end)
        mark_end(axes, run)


def parts(trace: PassTrace) -> list[tuple[int, int]]:
    """First and last event of each part of a pass in which one stage is in force."""
    ends = [*(np.flatnonzero(np.diff(trace.stage)) + 1).tolist(), len(trace.stage) - 1]
    return [(start, end) for start, end in zip([0, *ends[:-1]], ends, strict=True) if end > start]


def draw_lines(axes: Axes, case: CaseResult, stage: int, ends_m: tuple[float, float]) -> None:
    """The switching lines of a stage where it is in force."""
    lines = case.study.table_lines
    inside = (lines.nodes_m >= ends_m[0]) & (lines.nodes_m <= ends_m[1])
    path, upper, lower = lines.nodes_m[inside], lines.upper_m_s[stage][inside], lines.lower_m_s[stage][inside]
    axes.plot(path, finite(upper), color=colour_of(stage), linewidth=0.9, zorder=4)
    axes.plot(path, finite(lower), color=colour_of(stage), linewidth=0.9, linestyle=LOWER_STYLE, zorder=4)


def name_part(axes: Axes, trace: PassTrace, start: int, end: int) -> None:
    """The number of the stage above its part of the run: colour alone does not tell it to everybody."""
    if trace.path_m[end] - trace.path_m[start] < LEAST_NAMED_M or trace.path_m[end] > trace.path_m[-1] - LAST_M:
        return
    middle = 0.5 * float(trace.path_m[start] + trace.path_m[end])
    speed = float(np.interp(middle, trace.path_m, trace.speed_m_s))
    axes.annotate(
        str(int(trace.stage[start])), (middle, speed), (0.0, 9.0), textcoords="offset points", ha="center", fontsize=8,
        color=INK, zorder=6,
    )  # fmt: skip


def mark_end(axes: Axes, trace: PassTrace) -> None:
    """A dot where the cut is released, or where it stopped."""
    at = float(trace.path_m[-1]), trace.exit_speed_m_s
    axes.plot(*at, "o", color=INK, markersize=6, zorder=7, clip_on=False)
    axes.annotate(
        outcome(trace), at, (2.0, 24.0), textcoords="offset points", ha="right", fontsize=8, color=INK, zorder=7
    )


def draw_exits(axes: Axes, case: CaseResult) -> None:
    """Histogram of the simulated exit speeds, and the predicted density, along an upright speed axis."""
    target, share = case.target_speed_m_s, case.exit_weight / case.exit_weight.sum()
    speed, predicted = predicted_density(case.predicted)
    edges = bin_edges_m_s(target, float(max(case.exit_speeds_m_s.max(initial=0.0), speed[-1])))
    moving = case.exit_speeds_m_s > 0.0
    simulated = np.histogram(case.exit_speeds_m_s[moving], edges, weights=share[moving])[0] / np.diff(edges)
    shown = within(edges, target)
    axes.stairs(simulated[shown[:-1]][:-1], edges[shown], orientation="horizontal", fill=True, color=SKY, linewidth=0)
    near = within(speed, target)
    axes.plot(predicted[near], speed[near], color=VERMILLION, linewidth=1.2)
    axes.axhline(target, color=INK, linewidth=0.8, linestyle=TARGET_STYLE)
    dress(axes, f"rms {case.statistics.rms_m_s:.3f} m/s", "density, s/m")
    axes.grid(False)
    axes.set(ylim=(target - NEAR_M_S, target + NEAR_M_S), xlim=(0.0, None))


def within(speeds_m_s: NDArray[np.float64], target_m_s: float) -> NDArray[np.bool_]:
    """Which speeds the right panel shows."""
    return np.abs(speeds_m_s - target_m_s) <= NEAR_M_S + 1e-9


def enlarge(figure: Figure, run: Axes, exits: Axes, case: CaseResult) -> None:
    """Two lines from the end of the run to the ends of the enlarged axis."""
    for sign in (-1.0, 1.0):
        speed = case.target_speed_m_s + sign * NEAR_M_S
        figure.add_artist(
            ConnectionPatch(
                (run.get_xlim()[1], speed), (0.0, speed), "data", "data", axesA=run, axesB=exits, color=GREY,
                linewidth=0.6, zorder=0,
            )
        )  # fmt: skip


def legend_entries(case: CaseResult) -> list[Artist]:
    """The stages that the run meets, and what else is drawn."""
    stages = sorted({int(stage) for trace in case.traces[NOMINAL : NOMINAL + 1] for stage in trace.stage})
    kpa = case.plant.position.stage_pressures_kpa
    return [
        *(
            Line2D([], [], color=colour_of(stage), linewidth=2.2, label=f"stage {stage}: {kpa[stage]:g} kPa")
            for stage in stages
        ),
        Line2D([], [], color=INK, linewidth=0.9, label="brakes more above"),
        Line2D([], [], color=INK, linewidth=0.9, linestyle=LOWER_STYLE, label="releases below"),
        Patch(facecolor=PALE_GREY, label="retarders"),
        Line2D([], [], color=INK, linewidth=0.8, linestyle=TARGET_STYLE, label="target"),
        Patch(facecolor=SKY, label="simulated"),
        Line2D([], [], color=VERMILLION, linewidth=1.2, label="predicted"),
    ]
