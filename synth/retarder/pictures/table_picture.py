"""Pictures of an exported table, drawn from its file alone: lines by stage, surfaces; with a plant, passes too."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models import Plant
from synth.frame.picture.house_style import (
    BLUE,
    GREY,
    INK,
    LINE_COLOURS,
    LINE_STYLES,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    mark_zones,
    new_figure,
    place,
)
from synth.retarder.pictures.stage_panels import (
    DOWN,
    HOLD,
    UP,
    finite,
    label_panels,
    outcome,
    parts_in_stage,
    stage_panels,
)
from synth.retarder.pictures.stage_surfaces import PATH_POINTS, stage_surfaces, surface_figure
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.passes import TRACE_FACTORS, ExitSample, PassTrace
from synth.solver.tabulate import lines_of
from tuning_tables import ControllerTable
from tuning_tables.passages.passage_table import PassageTable

LINE_POINTS = 201
PASSES = 5000
"""Exits that are drawn."""


@dataclass(frozen=True)
class Passes:
    """Simulated passes of a table: a sample of exits, and a few passes with the friction factors `TRACE_FACTORS`."""

    sample: ExitSample
    traces: tuple[PassTrace, ...]


def drawn_passes(table: ControllerTable, plant: Plant, seed: int) -> Passes:
    """`PASSES` stratified passes of `plant` under `table`, and the first of them at `TRACE_FACTORS`."""
    from synth.simulation.closed_loop import TableController, simulate, trace  # a picture of lines needs no kernel
    from synth.simulation.stratified_passes import stratified_passes

    passes, law = stratified_passes(seed, 0, PASSES), TableController(table)
    traces = tuple(trace(plant, law, passes, i, cut_factor=factor) for i, factor in enumerate(TRACE_FACTORS))
    return Passes(simulate(plant, law, passes), traces)


def table_lines(table: ControllerTable, passes: Passes | None) -> Figure:
    """One panel a stage in use: where the table raises, holds and lowers, over path in m and speed in m/s."""
    stages = stages_in_use(table)
    figure, grid = stage_panels("Switching lines of the exported table", subject(table), stages)
    for stage in range(stages):
        draw_stage(grid.flat[stage], table, stage, passes)
    label_panels(grid, stages)
    handles = [
        Patch(facecolor=UP, edgecolor=GREY, label="one stage up (brake more)"),
        Patch(facecolor=HOLD, edgecolor=GREY, label="hold"),
        Patch(facecolor=DOWN, edgecolor=GREY, label="one stage down (release)"),
        Line2D([], [], color=VERMILLION, linewidth=2.0, label="upper line"),
        Line2D([], [], color=BLUE, linewidth=2.0, linestyle="--", label="lower line"),
        Patch(facecolor=INK, label="retarder zones"),
    ]
    if table.has_gauge:
        handles.insert(
            5, Line2D([], [], color=INK, linewidth=1.0, linestyle=":", label="lines at lowest, highest pressure")
        )
    if passes:
        handles.insert(5, Line2D([], [], color=INK, linewidth=0.8, label="simulated passes while in the stage"))
    box = grid.flat[stages].get_position()
    where = (box.x0, box.y0, box.width, box.height)
    figure.legend(handles=handles, loc="center", bbox_to_anchor=where, fontsize=9, frameon=False)
    return figure


def draw_stage(axes: Axes, table: ControllerTable, stage: int, passes: Passes | None) -> None:
    """The panel of one stage."""
    low, high = window_m_s(table, passes)
    path = np.linspace(*table.valid.s_m, LINE_POINTS)
    lines = lines_of(table, path)
    lower, upper = lines.lower_m_s[stage], lines.upper_m_s[stage]
    axes.set_facecolor(HOLD)
    axes.fill_between(path, low, np.clip(lower, low, high), color=DOWN, linewidth=0)
    axes.fill_between(path, np.clip(upper, low, high), high, color=UP, linewidth=0)
    axes.plot(path, finite(lower), "--", color=BLUE, linewidth=2.0, zorder=5)
    axes.plot(path, finite(upper), "-", color=VERMILLION, linewidth=2.0, zorder=5)
    for kpa in table.pressures[[0, table.highest_raised]] if table.has_gauge else ():
        below, above = table.slopes[stage] * (kpa - table.pressures[stage])
        axes.plot(path, finite(lower) + below, ":", color=BLUE, linewidth=1.0, zorder=5)
        axes.plot(path, finite(upper) + above, ":", color=VERMILLION, linewidth=1.0, zorder=5)
    if passes:
        axes.plot(*parts_in_stage(passes.traces, stage), color=INK, linewidth=0.8, zorder=6)
    mark_zones(axes, table.retarder.zones_m, table.valid.s_m[0])
    dress(axes, f"stage {stage} · {table.stages[stage].pressure_kpa:g} kPa")
    axes.grid(False)
    axes.set(xlim=table.valid.s_m, ylim=(low, high))


def table_surfaces(table: ControllerTable, passes: Passes | None) -> Figure:
    """V_lo and V_hi over path and pressure; see `surfaces.surface_figure`."""
    if table.has_gauge:
        return stage_surfaces(table, subject(table), window_m_s(table, passes))
    pressure = np.array([stage.pressure_kpa for stage in table.stages[: stages_in_use(table)]])
    lines = lines_of(table, np.linspace(*table.valid.s_m, PATH_POINTS))
    title = "Switching surfaces of the exported table"
    return surface_figure(title, subject(table), lines, pressure, window_m_s(table, passes))


def table_passes(table: ControllerTable, passes: Passes) -> Figure:
    """A few passes over path and time on the left, the histogram of the simulated exit speeds on the right."""
    figure = new_figure(12.0, 6.0, "Simulated passes of the exported table", subject(table))
    place(figure, left=0.65, right=0.2, bottom=0.95, top=0.95, w=0.24, h=0.5)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.25, 1.0))
    speed, pressure, exits = (figure.add_subplot(grid[part]) for part in ((0, 0), (1, 0), (slice(None), 1)))
    handles: list[Line2D] = []
    for trace, factor, colour, style in zip(passes.traces, TRACE_FACTORS, LINE_COLOURS, LINE_STYLES, strict=False):
        speed.plot(trace.path_m, trace.speed_m_s, color=colour, linestyle=style, linewidth=1.5)
        pressure.step(trace.time_s, trace.overpressure_kpa, where="post", color=colour, linestyle=style, linewidth=1.3)
        label = f"friction factor {factor:.2f}: {outcome(trace)}"
        handles.append(Line2D([], [], color=colour, linestyle=style, linewidth=1.6, label=label))
    speed.axhline(table.target_speed_m_s, color=INK, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1)
    dress(speed, "true speed, m/s", "path of the first axle, m")
    dress(pressure, "pressure above the touch of the pads, kPa", "time since the regulator took over, s")
    speed.set(xlim=table.valid.s_m, ylim=(0.0, None))
    pressure.set(xlim=(0.0, None), ylim=(0.0, None))
    draw_exits(exits, table, passes.sample)
    legend_below(figure, handles, columns=len(handles))
    return figure


def draw_exits(axes: Axes, table: ControllerTable, sample: ExitSample) -> None:
    """Histogram of the exit speeds, with the target and what the file predicts."""
    found = exit_statistics(sample, table.target_speed_m_s)
    moving = sample.exit_speed_m_s[~sample.stalled]
    if moving.size:
        share = 100.0 * sample.weight[~sample.stalled] / sample.weight.sum()
        axes.hist(moving, bins=np.histogram_bin_edges(moving, 60).tolist(), weights=share, color=SKY)
    axes.axvline(table.target_speed_m_s, color=INK, linewidth=1.0)
    title = (
        f"{found.passes} passes: {found.rms_text}\n"
        f"the file predicts {table.predicted.rms_m_s:.4f} m/s · {found.stalled:.2%} stopped"
    )
    dress(axes, title, "exit speed, m/s", "cuts, %")


def subject(table: ControllerTable | PassageTable) -> str:
    """What the table is for, in one line."""
    cut, axles = table.cut, len(table.cut.axle_offsets_m)
    return f"{table.id} · {table.retarder.name} · category {cut.category}, {cut.mass_t:g} t, {axles} axles"


def stages_in_use(table: ControllerTable) -> int:
    """Number of stages that the table ever asks for."""
    return table.highest_raised + 1


def window_m_s(table: ControllerTable, passes: Passes | None) -> tuple[float, float]:
    """Speeds worth drawing: around the target, and up to what the passes reach or else the range of validity."""
    traces: Sequence[PassTrace] = passes.traces if passes else ()
    highest = max((float(trace.speed_m_s.max()) for trace in traces), default=table.valid.v_m_s[1] - 0.4)
    return max(0.0, table.target_speed_m_s - 1.0), highest + 0.4
