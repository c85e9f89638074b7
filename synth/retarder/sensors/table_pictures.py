"""Pictures of a table for point sensors: which stage it wants over place and speed, a column at every passage and a
panel a stage; and a few passes: true speed and readings over path, pressure and stage over time.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.frozen_arrays import Floats
from synth.frame.picture.house_style import (
    BLUE,
    ENTRANCE_STYLE,
    GREY,
    INK,
    LINE_COLOURS,
    LINE_MARKERS,
    LINE_STYLES,
    VERMILLION,
    dress,
    legend_below,
    mark_zones,
    new_figure,
    place,
)
from synth.retarder.pictures.stage_panels import outcome
from synth.retarder.sensors.sensor_case import SensorCase
from synth.retarder.served_class import highest_stage
from synth.simulation.passage_controller import DECIDED, UNFINISHED, PassageTrace
from synth.simulation.passes import TRACE_FACTORS, PassTrace
from tuning_tables.passages.passage_table import PassageTable

HOLD = "#f2f2f2"
LIGHTEST, DARKEST = 0.28, 0.85
"""Part of the colour in a column of a stage one away from that in force, and the farthest away."""

WIDEST_COLUMN_M, BETWEEN_COLUMNS = 1.6, 0.94
"""A column reaches half the way to its neighbours, less a little; nowhere farther than half of the widest."""

MOST_NUMBERED = 14
"""With more passages the columns are too narrow for the numbers of stages."""

BELOW_TARGET_M_S, ABOVE_FASTEST_M_S = 1.0, 0.4


def switching_speeds(subject: str, tables: Sequence[PassageTable], traces: Sequence[Sequence[PassTrace]]) -> Figure:
    """A row for each table of one class, a panel for each stage in force that it uses.

    `traces`: passes of each table, drawn while they were in the stage; none is fine.
    """
    stages = max(highest_stage(table) for table in tables) + 1
    figure = new_figure(2.9 * stages + 0.9, 2.5 * len(tables) + 1.75, "Stage wanted at each passage", subject)
    place(figure, left=0.78, right=0.15, bottom=1.05, top=0.95, w=0.08, h=0.22)
    grid = figure.subplots(len(tables), stages, sharex=True, squeeze=False)
    for row, table in enumerate(tables):
        for stage in range(stages):
            draw_stage(grid[row, stage], table, stage, traces[row] if row < len(traces) else ())
            grid[row, stage].tick_params(labelleft=stage == 0, labelbottom=row == len(tables) - 1)
        grid[row, 0].set_ylabel(f"speed read, m/s\n(target {table.target_speed_m_s:g} m/s)", fontsize=9)
    for panel in grid[-1]:
        panel.set_xlabel("path of the first axle, m", fontsize=9)
    legend_below(figure, legend_entries(stages, any(traces)), columns=min(5, stages + 3))
    return figure


def draw_stage(axes: Axes, table: PassageTable, stage: int, traces: Sequence[PassTrace]) -> None:
    """Columns of the stages wanted while `stage` is in force."""
    low, high = speed_window_m_s(table, traces)
    columns = columns_m(table)
    numbered = len(columns) <= MOST_NUMBERED
    for passage, (left, right) in enumerate(columns):
        edges = wanted_edges_m_s(table, passage, stage, (low, high))
        for wanted, (bottom, top) in enumerate(pairwise(edges)):
            if top > bottom:
                axes.bar(
                    left, top - bottom, right - left, bottom, align="edge", zorder=2,
                    color=colour_of(wanted, stage, len(table.pressure_kpa) - 1), edgecolor=GREY,
                    linewidth=0.3 if numbered else 0.0,
                )  # fmt: skip
                if numbered and top - bottom > 0.05 * (high - low):
                    middle = 0.5 * (left + right), 0.5 * (bottom + top)
                    axes.text(*middle, f"{wanted}", ha="center", va="center", fontsize=7, zorder=3)
    for trace in traces:
        inside = trace.stage == stage
        inside[1:] |= inside[:-1].copy()  # a stage holds up to the next event
        axes.plot(
            trace.path_m, np.where(inside, trace.speed_m_s, np.nan), color=INK, linewidth=0.9, zorder=4, alpha=0.8
        )
    axes.axhline(table.target_speed_m_s, color=INK, linewidth=0.8, linestyle=(0, (4, 3)), zorder=2.5)
    mark_zones(axes, table.retarder.zones_m, -table.approach.length_m)
    mark_sensors(axes, table)
    dress(axes, f"in force: stage {stage}, {table.pressure_kpa[stage]:g} kPa")
    axes.set(xlim=(columns[0][0] - 0.2, table.retarder.exit_m), ylim=(low, high))


def wanted_edges_m_s(table: PassageTable, passage: int, stage: int, window_m_s: tuple[float, float]) -> Floats:
    """Speeds within the window between which each of the stages 0 … K is wanted, (K + 2,), as the rule has it."""
    row = table.switching_m_s[passage, stage].astype(float)
    if passage < table.before_entrance:
        row[max(stage, table.entrance_stage) :] = np.inf
    return np.clip(np.concatenate(([-np.inf], row, [np.inf])), *window_m_s)


def speed_window_m_s(table: PassageTable, traces: Sequence[PassTrace]) -> tuple[float, float]:
    """Speeds worth drawing: around the target, and up to the greatest switching speed and that of the passes."""
    finite = table.switching_m_s[np.isfinite(table.switching_m_s) & (table.switching_m_s <= table.valid_v_m_s[1])]
    highest = max(float(finite.max(initial=0.0)), table.target_speed_m_s + BELOW_TARGET_M_S)
    highest = max([highest, *(float(trace.speed_m_s.max()) for trace in traces)])
    return max(0.0, table.target_speed_m_s - BELOW_TARGET_M_S), highest + ABOVE_FASTEST_M_S


def columns_m(table: PassageTable) -> list[tuple[float, float]]:
    """Left and right end of the column of each passage; neighbours do not meet."""
    path = table.path_m.astype(float)
    apart = np.minimum(np.diff(path, prepend=-np.inf, append=np.inf), WIDEST_COLUMN_M)
    half = 0.5 * BETWEEN_COLUMNS * apart
    return list(zip((path - half[:-1]).tolist(), (path + half[1:]).tolist(), strict=True))


def colour_of(wanted: int, stage: int, top: int) -> str:
    """Pale grey for the stage in force, blue for lower ones, red for higher ones, the darker the farther away."""
    if wanted == stage:
        return HOLD
    away, farthest = abs(wanted - stage), max(top, 2)
    part = LIGHTEST + (DARKEST - LIGHTEST) * (away - 1) / (farthest - 1)
    full = np.array(to_rgb(BLUE if wanted < stage else VERMILLION))
    red, green, blue = (float(c) for c in 1.0 - part * (1.0 - full))
    return to_hex((red, green, blue))


def mark_sensors(axes: Axes, table: PassageTable) -> None:
    """The sensors before the exit as triangles below the upper edge of a panel over path."""
    shown = [place_m for place_m in table.sensors.path_m if place_m <= table.retarder.exit_m]
    axes.plot(
        shown, np.full(len(shown), 0.97), "v", color=INK, markersize=5.5, markeredgecolor="white", markeredgewidth=0.6,
        zorder=6, transform=axes.get_xaxis_transform(),
    )  # fmt: skip


def legend_entries(stages: int, passes: bool) -> list[Patch | Line2D]:
    """What colours and marks mean."""
    entries: list[Patch | Line2D] = [
        Patch(facecolor=colour_of(1, 0, stages - 1), edgecolor=GREY, label="a higher stage (brake more)"),
        Patch(facecolor=HOLD, edgecolor=GREY, label="the stage in force"),
        Patch(facecolor=colour_of(0, 1, stages - 1), edgecolor=GREY, label="a lower stage (release)"),
        Line2D([], [], color=INK, marker="v", linestyle="", markersize=5, label="sensor"),
        Patch(facecolor=INK, label="retarder zones"),
        Line2D([], [], color=INK, linewidth=0.8, linestyle=ENTRANCE_STYLE, label="entrance"),
        Line2D([], [], color=INK, linewidth=0.8, linestyle=(0, (4, 3)), label="target"),
    ]
    if passes:
        entries.append(Line2D([], [], color=INK, linewidth=0.9, label="simulated passes in the stage"))
    return entries


def passes_with_readings(case: SensorCase) -> Figure:
    """Speed in m/s over path in m on the left; pressure above the touch in kPa and stage over time on the right."""
    return passes_figure(f"{case.cut_name}, {case.target_name}", case.table, case.traces)


def passes_figure(subject: str, table: PassageTable, traces: tuple[PassageTrace, ...]) -> Figure:
    """The passes `traces` of `table`, whose friction factors are `TRACE_FACTORS`; the legend tells how each ended."""
    figure = new_figure(11.0, 5.4, "Sample passes and readings", subject)
    place(figure, left=0.65, right=0.2, bottom=1.15, top=0.85, w=0.17, h=0.24)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.15, 1.0))
    speed, pressure, stage = (figure.add_subplot(grid[part]) for part in ((slice(None), 0), (0, 1), (1, 1)))
    handles: list[Line2D] = []
    for trace, factor, colour, style, mark in zip(
        traces, TRACE_FACTORS, LINE_COLOURS, LINE_STYLES, LINE_MARKERS, strict=False
    ):
        speed.plot(trace.path_m, trace.speed_m_s, color=colour, linestyle=style, linewidth=1.6)
        draw_readings(speed, table, trace, colour, mark)
        pressure.step(trace.time_s, trace.overpressure_kpa, where="post", color=colour, linestyle=style, linewidth=1.3)
        stage.step(trace.time_s, trace.stage, where="post", color=colour, linestyle=style, linewidth=1.3)
        label = f"friction factor {factor:.2f}: {outcome(trace)}"
        handles.append(Line2D([], [], color=colour, linestyle=style, linewidth=1.6, marker=mark, label=label))
    finish_speed(speed, table, traces)
    finish_time(pressure, stage, table, traces)
    handles += [
        Line2D([], [], color=INK, marker="o", linestyle="", markersize=5, label="speed read, decided on"),
        Line2D([], [], color=INK, marker="o", linestyle="", markersize=5, fillstyle="none",
               label="read while a change of stage was unfinished"),
        Line2D([], [], color=INK, marker="v", linestyle="", markersize=5, label="sensor"),
    ]  # fmt: skip
    legend_below(figure, handles, columns=3)
    return figure


def draw_readings(axes: Axes, table: PassageTable, trace: PassageTrace, colour: str, mark: str) -> None:
    """The speeds that the regulator read, at the places of their passages; hollow: it could not decide on them."""
    read = trace.readings
    for outcome_of_pair, fill in ((DECIDED, "full"), (UNFINISHED, "none")):
        shown = read.outcome == outcome_of_pair
        axes.plot(
            table.heard_path_m[read.believed[shown]], read.reading_m_s[shown], linestyle="", marker=mark, color=colour,
            fillstyle=fill, markersize=5, zorder=5,
        )  # fmt: skip


def finish_speed(axes: Axes, table: PassageTable, traces: tuple[PassageTrace, ...]) -> None:
    """Target, zones, sensors and labels of the speed panel."""
    axes.axhline(table.target_speed_m_s, color=INK, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1)
    start_m = -table.approach.length_m
    axes.annotate(
        f"target {table.target_speed_m_s:g} m/s", (start_m, table.target_speed_m_s), (4.0, -4.0),
        textcoords="offset points", va="top", fontsize=8.5,
    )  # fmt: skip
    mark_zones(axes, table.retarder.zones_m, start_m)
    mark_sensors(axes, table)
    dress(axes, "true speed (lines) and speed read (marks), m/s", "path of the first axle, m")
    highest = max((float(trace.speed_m_s.max()) for trace in traces), default=table.valid_v_m_s[1])
    lowest = min((float(trace.speed_m_s.min()) for trace in traces), default=0.0)
    low = max(0.0, min(lowest, table.target_speed_m_s) - 0.5)
    axes.set(xlim=(start_m - 0.3, table.retarder.exit_m), ylim=(low, highest + 0.1 * (highest - low)))


def finish_time(pressure: Axes, stage: Axes, table: PassageTable, traces: tuple[PassageTrace, ...]) -> None:
    """Labels and limits of the panels over time."""
    dress(pressure, "pressure above the touch of the pads, kPa")
    dress(stage, "commanded stage", "time since the first sensor, s")
    last_s = max((float(trace.time_s[-1]) for trace in traces), default=1.0)
    pressure.tick_params(labelbottom=False)
    pressure.set(xlim=(0.0, last_s), ylim=(0.0, None))
    highest = max(max((int(trace.stage.max()) for trace in traces), default=1), 1)
    stage.set(xlim=(0.0, last_s), yticks=range(highest + 1), ylim=(-0.15, highest + 0.15))
