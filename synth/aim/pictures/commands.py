"""What the tables command: exit speed over free distance, by cars in a cut and by measured resistance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from synth.frame.picture.house_style import dress, legend_below, new_figure, place
from synth.frame.picture.series import graded, markers, named_lines
from synth.frame.printed_numbers import counted
from tuning_tables.aim import AimTable

MOST_RESISTANCES = 7
"""Lines of a panel."""


def aim_figures(tables: Sequence[AimTable]) -> Mapping[str, Figure]:
    """The pictures of aim tables by name, all tables of one kind of knowledge together."""
    measured = [table for table in tables if table.is_measured]
    plain = [table for table in tables if not table.is_measured]
    found = {"aim-commands-by-cars": commands_by_cars(plain)} if plain else {}
    return {**found, "aim-commands-by-resistance": commands_by_resistance(measured)} if measured else found


def commands_by_cars(tables: Sequence[AimTable]) -> Figure:
    """Tables by category, one or more: a panel each, a line for each number of cars."""
    figure, panels = figure_of(tables, "Exit speed by category and cars", "Speeds that the tables by category command")
    most = max(tables, key=lambda table: len(table.axes.cars))
    names = [counted(cars, "car") for cars in most.axes.cars.tolist()]
    for axes, table in zip(panels, tables, strict=True):
        for row, colour, marker in zip(table.exit_speed_m_s, graded(len(names)), markers(len(names)), strict=False):
            axes.plot(table.axes.free_distance_m, row, color=colour, marker=marker, markersize=3.5, linewidth=1.3)
        dress(axes, f"category {table.category.name}", "free distance, m")
    finish(figure, panels, names)
    return figure


def commands_by_resistance(tables: Sequence[AimTable]) -> Figure:
    """Tables by measured resistance for the shortest cuts: a panel each, a line for some of the resistances."""
    cars = counted(min(int(table.axes.cars[0]) for table in tables), "car")
    figure, panels = figure_of(
        tables, f"Exit speed by measured resistance, {cars}", "From the least resistance to the largest"
    )
    names = ["least"] + [""] * (MOST_RESISTANCES - 2) + ["largest"]
    for axes, table in zip(panels, tables, strict=True):
        readings = table.axes.resistance_n_per_kn
        assert readings is not None
        some = np.unique(np.linspace(0, len(readings) - 1, MOST_RESISTANCES).round().astype(int))
        for place_no, colour, marker in zip(some, graded(len(some)), markers(len(some)), strict=True):
            speeds, distances = table.exit_speed_m_s[0, :, place_no], table.axes.free_distance_m
            axes.plot(distances, speeds, color=colour, marker=marker, markersize=3.5, linewidth=1.3)
        ends = f"{readings[0]:.1f} to {readings[-1]:.1f} N/kN"
        dress(axes, f"{table.category.name}, {ends}", "free distance, m")
    finish(figure, panels, names)
    return figure


def figure_of(tables: Sequence[AimTable], title: str, subject: str) -> tuple[Figure, list[Axes]]:
    """An empty figure with a panel a table, one scale for all."""
    figure = new_figure(max(6.0, 2.35 * len(tables) + 0.9), 4.2, title, subject)
    place(figure, left=0.7, right=0.2, bottom=1.0, top=0.85, w=0.1)
    panels = figure.subplots(1, len(tables), sharex=True, sharey=True, squeeze=False)
    return figure, list(panels[0])


def finish(figure: Figure, panels: list[Axes], names: list[str]) -> None:
    """Labels, limits and legend."""
    panels[0].set_ylabel("exit speed, m/s", fontsize=9)
    panels[0].set_xlim(left=0.0)
    legend_below(figure, named_lines(names), columns=7)
