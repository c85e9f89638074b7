"""Chance of over-speed and mean gap by exit speed, and one against the other, for one category."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from plant_models.frozen_arrays import Floats
from synth.aim.aim_curves import AimCurves
from synth.frame.picture.house_style import INK, dress, legend_below, new_figure, place
from synth.frame.picture.series import graded
from synth.frame.printed_numbers import counted


def chances(curves: AimCurves) -> Figure:
    """Three panels, a line for each free distance; dashed: the required chance."""
    figure = new_figure(
        11.0,
        4.6,
        f"What an exit speed gives: category {curves.category.name}, {counted(curves.cars, 'car')}",
        f"All cuts commanded the same speed; {curves.cuts} cuts that no table was made with",
    )
    place(figure, left=0.65, right=0.2, bottom=1.15, top=0.85, w=0.28)
    by_speed, gap_by_speed, by_gap = figure.subplots(1, 3)
    dress(by_speed, "Chance of over-speed", "exit speed, m/s", "share of cuts that couple too fast")
    dress(gap_by_speed, "Mean gap", "exit speed, m/s", "mean gap of a cut, m")
    dress(by_gap, "One against the other", "mean gap of a cut, m", "share of cuts that couple too fast")
    colours = graded(len(curves.free_distances_m))
    for place_no, colour in enumerate(colours):
        draw(by_speed, curves.speed_m_s, curves.overspeed[place_no], colour)
        draw(gap_by_speed, curves.speed_m_s, curves.gap_m[place_no], colour)
        draw(by_gap, curves.gap_m[place_no], curves.overspeed[place_no], colour)
    for axes in (by_speed, by_gap):
        axes.axhline(curves.required, color=INK, linewidth=1.0, linestyle="--")
        axes.set_ylim(0.0, 1.0)
    gap_by_speed.set_ylim(bottom=0.0)
    by_gap.set_xlim(left=0.0)
    handles = [
        Line2D([], [], color=colour, label=f"{distance:g} m")
        for distance, colour in zip(curves.free_distances_m, colours, strict=True)
    ]
    required = Line2D([], [], color=INK, linestyle="--", linewidth=1.0, label=f"required {curves.required:g}")
    legend_below(figure, [*handles, required], columns=9)
    figure.text(0.5, 0.42 / 4.6, "free distance to the standing cars", ha="center", fontsize=8.5, color=INK)
    return figure


def draw(axes: Axes, x: Floats, y: Floats, colour: str) -> None:
    """One curve."""
    axes.plot(x, y, color=colour, linewidth=1.5)
