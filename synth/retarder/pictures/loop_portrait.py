"""Phase portrait of a table's loop: speed over path, nominal passes from several entry speeds, the table's lines."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.frozen_arrays import Floats
from synth.frame.picture.house_style import (
    GREY,
    INK,
    dress,
    legend_below,
    new_figure,
    place,
)
from synth.retarder.line_control_loop import LINE_NODES, LineControlLoop
from synth.retarder.pictures.stage_colours import colour_of, finite
from synth.retarder.pictures.table_picture import stages_in_use, subject
from synth.simulation.nominal_response import NominalResponse
from synth.solver.tabulate import lines_of

SHADE = "#f3f1e7"

NEAR_M_S = 0.35
"""Half the height of the enlarged part."""


def loop_portrait(loop: LineControlLoop) -> Figure:
    """The whole pass on the left, its end around the commanded speed enlarged on the right."""
    title = "Phase portrait of the nominal loop, by python-control"
    figure = new_figure(13.0, 6.4, title, subject(loop.table))
    place(figure, left=0.65, right=0.2, bottom=1.2, top=0.85, w=0.13)
    whole, near = figure.subplots(1, 2)
    target, ends_m = loop.table.target_speed_m_s, (loop.plant.start_m, loop.plant.exit_m)
    for axes in (whole, near):
        draw(axes, loop)
    speeds = np.concatenate([response.speed_m_s for response in loop.portrait])
    lowest, highest = min(float(speeds.min()), target - 0.8), float(speeds.max())
    dress(whole, f"{len(loop.portrait)} passes of mean friction", "path of the first axle, m", "speed, m/s")
    whole.set(xlim=ends_m, ylim=(max(0.0, lowest - 0.2), highest + 0.3))
    dress(near, "the same, around the commanded speed", "path of the first axle, m", "speed, m/s")
    near.set(xlim=ends_m, ylim=(target - NEAR_M_S, target + NEAR_M_S))
    legend_below(figure, entries(loop), columns=5)
    return figure


def draw(axes: Axes, loop: LineControlLoop) -> None:
    """Lines, passes coloured by the commanded stage, zones, and where two stages can hunt."""
    path = np.linspace(*loop.table.valid.s_m, LINE_NODES)
    lines = lines_of(loop.table, path)
    for stage in range(stages_in_use(loop.table)):
        colour = colour_of(stage)
        axes.plot(path, finite(lines.upper_m_s[stage]), "-", color=colour, linewidth=0.9, zorder=3)
        axes.plot(path, finite(lines.lower_m_s[stage]), "--", color=colour, linewidth=0.9, zorder=3)
    for response in loop.portrait:
        for stage in range(len(loop.table.stages)):
            axes.plot(*while_in(response, stage), color=colour_of(stage), linewidth=2.0, alpha=0.75, zorder=4)
    for hunting in loop.hunting:
        axes.axvspan(hunting.from_m, hunting.to_m, color=SHADE, linewidth=0, zorder=0)
    axes.axhline(loop.table.target_speed_m_s, color=INK, linewidth=1.0, linestyle=(0, (4, 3)), zorder=2)
    bars = [(start, end - start) for start, end in loop.table.retarder.zones_m]
    axes.broken_barh(bars, (0.0, 0.02), transform=axes.get_xaxis_transform(), facecolor=INK, zorder=5)


def while_in(response: NominalResponse, stage: int) -> tuple[Floats, Floats]:
    """Path and speed of a response, NaN where `stage` is not commanded."""
    inside = response.stage == stage
    inside[:-1] |= inside[1:]  # up to the point where the next stage is commanded
    return response.path_m, np.where(inside, response.speed_m_s, np.nan)


def entries(loop: LineControlLoop) -> list[Line2D | Patch]:
    """What colours and strokes mean."""
    shown: list[Line2D | Patch] = [
        Line2D([], [], color=colour_of(stage.k), linewidth=2.0, label=f"stage {stage.k}: {stage.pressure_kpa:g} kPa")
        for stage in loop.table.stages[: stages_in_use(loop.table)]
    ]
    shown += [
        Line2D([], [], color=INK, linewidth=0.9, label="line of a stage: one up above it"),
        Line2D([], [], color=INK, linewidth=0.9, linestyle="--", label="line of a stage: one down below it"),
        Line2D([], [], color=INK, linewidth=1.0, linestyle=(0, (4, 3)), label="commanded exit speed"),
        Patch(facecolor=INK, label="retarder zones"),
    ]
    pairs = sorted({(each.cycle.lower_stage, each.cycle.lower_stage + 1) for each in loop.hunting})
    if pairs:
        told = " and ".join(f"{low} – {high}" for low, high in pairs)
        shown.append(Patch(facecolor=SHADE, edgecolor=GREY, label=f"stages {told} can hunt here"))
    return shown
