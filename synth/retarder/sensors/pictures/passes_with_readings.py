"""A few passes of a table for point sensors: true speed and readings over path, pressure and stage over time."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import (
    INK,
    LINE_COLOURS,
    LINE_MARKERS,
    LINE_STYLES,
    dress,
    legend_below,
    mark_zones,
    new_figure,
    place,
)
from synth.retarder.pictures.stage_colours import outcome
from synth.retarder.sensors.pictures.switching_speeds import mark_sensors
from synth.retarder.sensors.sensor_case import SensorCase
from synth.simulation.passage_sample import DECIDED, UNFINISHED, PassageTrace
from synth.simulation.passes import TRACE_FACTORS
from tuning_tables.passages.passage_table import PassageTable


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
