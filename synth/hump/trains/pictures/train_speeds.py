"""Speeds of a train: over the path of all its cuts, with the exit speeds that were commanded and kept; and its program
of hump speeds, over its cuts and over time.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.library.weight_category import WeightCategory
from synth.frame.picture.house_style import (
    BLUE,
    INK,
    LINE_STYLES,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    new_figure,
    place,
)
from synth.frame.picture.picture import category_colour
from synth.hump.trains.pictures.time_path import draw_strip
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


@frozen_arrays
class PushedTrain:
    """Hump speeds of the train `number`, from 0, (cuts,): each cut has `speed_m_s` at `crest_s`, when its middle is at
    the crest; between two such moments the train is pushed at an even rate."""

    number: int
    crest_s: Floats
    speed_m_s: Floats
    length_m: Floats

    @property
    def mean_m_s(self) -> float:
        """From the first cut to the last; of one cut, its own."""
        if len(self.length_m) < 2:
            return float(self.speed_m_s[0])
        pushed = self.length_m.sum() - 0.5 * (self.length_m[0] + self.length_m[-1])
        return float(pushed / (self.crest_s[-1] - self.crest_s[0]))


def hump_speed_program(program: PushedTrain) -> Figure:
    """Above by cut, with the lengths of the cuts; below over time; dashed: the mean."""
    count = len(program.speed_m_s)
    figure = new_figure(
        10.5,
        6.2,
        f"Hump speed program of train {program.number + 1}",
        f"Mean from the first to the last cut: {program.mean_m_s:.2f} m/s, {3.6 * program.mean_m_s:.1f} km/h; "
        f"{program.crest_s[-1] - program.crest_s[0]:.0f} s",
    )
    place(figure, left=0.65, right=0.75, bottom=1.0, top=0.85, h=0.42)
    by_cut, by_time = figure.subplots(2, 1)
    dress(by_cut, "By cut", "cut", "hump speed, m/s")
    dress(by_time, "Over time", "seconds since the first cut was at the crest", "hump speed, m/s")
    cuts = np.arange(1, count + 1)
    lengths = by_cut.twinx()
    lengths.bar(cuts, program.length_m, width=0.7, color=SKY, alpha=0.45, zorder=1)
    dress(lengths, "", "", "length of the cut, m")
    lengths.grid(False)
    lengths.spines["right"].set_visible(True)
    lengths.set_ylim(0.0, 2.5 * float(program.length_m.max()))
    by_cut.set_zorder(lengths.get_zorder() + 1)
    by_cut.patch.set_visible(False)
    by_cut.step(cuts, program.speed_m_s, where="mid", color=BLUE, linewidth=1.4, zorder=3)
    by_cut.plot(cuts, program.speed_m_s, ".", color=BLUE, markersize=5, zorder=4)
    by_time.plot(program.crest_s, program.speed_m_s, color=BLUE, linewidth=1.4, marker=".", markersize=5, zorder=3)
    top = 1.15 * float(program.speed_m_s.max())
    for axes in (by_cut, by_time):
        axes.axhline(program.mean_m_s, color=INK, linewidth=1.0, linestyle="--", zorder=2)
        axes.set_ylim(0.0, top)
    by_cut.set_xlim(0.4, count + 0.6)
    by_cut.locator_params("x", nbins=20, integer=True)
    by_time.set_xlim(left=min(0.0, float(program.crest_s[0])))
    handles = [
        Line2D([], [], color=BLUE, marker=".", label="hump speed when the middle of the cut is at the crest"),
        Line2D([], [], color=INK, linestyle="--", linewidth=1.0, label=f"mean, {program.mean_m_s:.2f} m/s"),
        Patch(color=SKY, alpha=0.45, label="length of the cut"),
    ]
    legend_below(figure, handles, columns=3)
    return figure
