"""What the tables command: exit speed over free distance, by cars in a cut and by measured resistance."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from synth.aim.aim_book import AimBook, MadeAim
from synth.frame.picture.house_style import dress, legend_below, new_figure, place
from synth.frame.picture.series import graded, markers, named_lines
from synth.frame.printed_numbers import counted

MOST_RESISTANCES = 7
"""Lines of a panel."""


def commands_by_cars(book: AimBook) -> Figure:
    """Tables by category: a panel each, a line for each number of cars."""
    made = [each for each in book.tables if each.knowledge == "category"]
    figure, panels = figure_of(made, "Exit speed by category and cars", "Speeds that the tables by category command")
    names = [counted(cars, "car") for cars in book.config.cars]
    for axes, each in zip(panels, made, strict=True):
        for row, colour, marker in zip(each.speeds.speed_m_s, graded(len(names)), markers(len(names)), strict=True):
            distances = each.speeds.order.free_distances_m
            axes.plot(distances, row, color=colour, marker=marker, markersize=3.5, linewidth=1.3)
        dress(axes, f"category {each.category.name}", "free distance, m")
    finish(figure, panels, names)
    return figure


def commands_by_resistance(book: AimBook) -> Figure:
    """Tables by measured resistance for the shortest cuts: a panel each, a line for some of the resistances."""
    made = [each for each in book.tables if each.knowledge == "measured"]
    cars = counted(book.config.cars[0], "car")
    figure, panels = figure_of(
        made, f"Exit speed by measured resistance, {cars}", "From the least resistance to the largest"
    )
    names = ["least"] + [""] * (MOST_RESISTANCES - 2) + ["largest"]
    for axes, each in zip(panels, made, strict=True):
        readings = each.speeds.readings
        assert readings is not None
        some = np.unique(np.linspace(0, len(readings) - 1, MOST_RESISTANCES).round().astype(int))
        for place_no, colour, marker in zip(some, graded(len(some)), markers(len(some)), strict=True):
            speeds, distances = each.speeds.speed_m_s[0, :, place_no], each.speeds.order.free_distances_m
            axes.plot(distances, speeds, color=colour, marker=marker, markersize=3.5, linewidth=1.3)
        ends = f"{readings[0]:.1f} to {readings[-1]:.1f} N/kN"
        dress(axes, f"{each.category.name}, {ends}", "free distance, m")
    finish(figure, panels, names)
    return figure


def figure_of(made: list[MadeAim], title: str, subject: str) -> tuple[Figure, list[Axes]]:
    """An empty figure with a panel a table, one scale for all."""
    figure = new_figure(max(6.0, 2.35 * len(made) + 0.9), 4.2, title, subject)
    place(figure, left=0.7, right=0.2, bottom=1.0, top=0.85, w=0.1)
    panels = figure.subplots(1, len(made), sharex=True, sharey=True, squeeze=False)
    return figure, list(panels[0])


def finish(figure: Figure, panels: list[Axes], names: list[str]) -> None:
    """Labels, limits and legend."""
    panels[0].set_ylabel("exit speed, m/s", fontsize=9)
    panels[0].set_xlim(left=0.0)
    legend_below(figure, named_lines(names), columns=7)
