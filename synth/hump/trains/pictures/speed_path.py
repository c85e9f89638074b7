"""Speed over path of all cuts of a train, with the exit speeds that were commanded and kept."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from plant_models.library.weight_category import WeightCategory
from synth.frame.picture.category_colour import category_colour
from synth.frame.picture.house_style import INK, LINE_STYLES, VERMILLION, dress, legend_below, new_figure, place
from synth.hump.trains.pictures.element_strip import draw_strip
from synth.hump.trains.train_trace import TracedCut, TrainTrace

STEP_M = 2.0


def speed_path(trace: TrainTrace, categories: Sequence[WeightCategory]) -> Figure:
    """A line for each cut, its look by its place among the `categories`; marks at the end of each pass."""
    figure = new_figure(
        12.5,
        6.4,
        f"Speed over path of train {trace.number + 1}",
        "Speed of each cut over the place of its head, until it couples or stands",
    )
    place(figure, left=0.65, right=0.3, bottom=1.05, top=1.3)
    axes = figure.subplots()
    dress(axes, "", "metres from the crest", "m/s")
    for cut in trace.cuts:
        style, colour = LINE_STYLES[cut.category % len(LINE_STYLES)], category_colour(categories[cut.category].number)
        heads = np.append(np.arange(0.0, cut.trace.head_m[-1], STEP_M), cut.trace.head_m[-1])
        speeds = np.interp(heads, cut.trace.head_m, cut.trace.speed_m_s)
        axes.plot(heads, speeds, color=colour, linestyle=style, linewidth=0.9, zorder=3)
        for at_m, command, left in exits(trace, cut):
            axes.plot([at_m, at_m], [command, left], color=VERMILLION, linewidth=0.8, zorder=5)
            axes.plot([at_m], [command], marker="_", color=VERMILLION, markersize=6, zorder=5)
    upto_m = max(float(cut.trace.head_m[-1]) for cut in trace.cuts)
    draw_strip(figure, axes, trace.routes, upto_m)
    axes.axhline(trace.allowed_m_s, color=INK, linewidth=1.0, linestyle=(0, (4, 2)), zorder=2)
    axes.set_xlim(0.0, upto_m)
    axes.set_ylim(bottom=0.0)
    legend_below(figure, legend(trace, categories), columns=5)
    return figure


def exits(trace: TrainTrace, cut: TracedCut) -> list[tuple[float, float, float]]:
    """(head at the end, commanded speed, exit speed) of each pass that the cut ended."""
    return [
        (float(cut.trace.head_at(np.asarray(each.end_s))), each.command_m_s, each.exit_m_s)
        for each in cut.passages
        if np.isfinite(each.end_s)
    ]


def legend(trace: TrainTrace, categories: Sequence[WeightCategory]) -> list[Artist]:
    """The categories that are in the train, and the marks."""
    there = sorted({cut.category for cut in trace.cuts})
    handles: list[Artist] = [
        Line2D(
            [],
            [],
            color=category_colour(categories[c].number),
            linestyle=LINE_STYLES[c % len(LINE_STYLES)],
            label=f"category {categories[c].label}",
        )
        for c in there
    ]
    handles.append(
        Line2D([], [], color=VERMILLION, marker="_", markersize=7, linewidth=0.8, linestyle="none",
               label="commanded exit speed, and the line to the actual one")
    )  # fmt: skip
    limit = f"highest speed for coupling, {trace.allowed_m_s:.2f} m/s"
    handles.append(Line2D([], [], color=INK, linewidth=1.0, linestyle=(0, (4, 2)), label=limit))
    return handles
