"""The pictures of an aim: what exit speeds give on the track, and what tables command."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.frozen_arrays import Floats
from synth.aim.aim_book import AimBook, MadeAim
from synth.aim.aim_curves import RUNNERS, AimCurves, Runners
from synth.aim.scene import AimScene
from synth.frame.picture.house_style import (
    GREY,
    INK,
    LINE_STYLES,
    PALE_GREY,
    dress,
    graded,
    legend_below,
    markers,
    named_lines,
    new_figure,
    place,
)
from synth.frame.picture.picture import category_colour
from synth.frame.printed_numbers import counted
from tuning_tables.aim import AimTable


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


def gaps(book: AimBook) -> Figure:
    """Rows by knowledge, columns by category, one scale for all."""
    rows, columns = len(book.config.aim.knowledge), len(book.config.members)
    required = book.config.aim.p_overspeed
    figure = new_figure(
        max(6.0, 2.35 * columns + 0.9),
        2.6 * rows + 1.5,
        f"Mean gap where {100.0 * required:g} of 100 cuts may couple too fast",
        f"Cuts that speeds were not chosen on, {book.tables[0].speeds.order.report_cuts} for each number of cars",
    )
    place(figure, left=0.7, right=0.2, bottom=0.9, top=0.85, w=0.1, h=0.3)
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for made in book.tables:
        row, column = book.config.aim.knowledge.index(made.knowledge), book.config.members.index(made.category)
        axes = panels[row, column]
        draw_gaps(axes, made)
        dress(axes, f"{made.category.name}, {made.known}")
    for axes in panels[-1]:
        axes.set_xlabel("free distance, m", fontsize=9)
    for axes in panels[:, 0]:
        axes.set_ylabel("mean gap of a cut, m", fontsize=9)
    panels[0, 0].set_ylim(bottom=0.0)
    panels[0, 0].set_xlim(left=0.0)
    legend_below(figure, named_lines([counted(cars, "car") for cars in book.config.cars]), columns=6)
    return figure


def draw_gaps(axes: Axes, made: MadeAim) -> None:
    """The lines of one table."""
    found = made.speeds.of_all.gap_m
    looks = zip(found, graded(len(found)), markers(len(found)), strict=True)
    for gap, colour, marker in looks:
        axes.plot(made.speeds.order.free_distances_m, gap, color=colour, marker=marker, markersize=3.5, linewidth=1.3)


LOOKS = LINE_STYLES[1], LINE_STYLES[0], LINE_STYLES[3]
"""Strokes of a bad, a middling and a good runner; the colour is that of the category."""


def track(scene: AimScene, rolled: Sequence[Runners]) -> Figure:
    """Height over distance from the crest, energy heads above it, in the colour of each category."""
    figure = new_figure(
        10.5,
        5.2,
        "The track, and how far cuts would roll unbraked",
        "Energy head of single cars from the bunch position on: 5, 50 and 95 of 100 cars are slower at each place",
    )
    place(figure, left=0.7, right=0.2, bottom=1.25, top=0.85)
    axes = figure.subplots()
    dress(axes, x="distance from the crest, m", y="height above the end of the track, m")
    x = np.linspace(0.0, scene.track.end_m, 1000)
    end = float(scene.track.fall_m(np.array([scene.track.end_m]))[0])
    height = end - scene.track.fall_m(x)
    axes.fill_between(x, height, min(0.0, float(height.min())), color=PALE_GREY, linewidth=0.0)
    axes.plot(x, height, color=INK, linewidth=1.4)
    for each in rolled:
        colour = category_colour(each.category.number)
        ground = end - scene.track.fall_m(each.head_m)
        for style, head in zip(LOOKS, each.energy_head_m, strict=True):
            rolls = head > 0.0
            axes.plot(each.head_m[rolls], (ground + head)[rolls], color=colour, linewidth=1.4, linestyle=style)
    mark(axes, scene)
    names = ("bad", "middling", "good")
    handles: list[Artist] = [
        Line2D(
            [],
            [],
            color=category_colour(each.category.number),
            linestyle=style,
            label=f"{each.category.name}, {name} ({100.0 * q:g} of 100)",
        )
        for each in rolled
        for style, name, q in zip(LOOKS, names, RUNNERS, strict=True)
    ]
    handles += [
        Line2D([], [], color=GREY, linewidth=5, label="measured stretch"),
        Patch(color=INK, label="park position"),
    ]
    handles.append(Line2D([], [], color=GREY, linestyle="none", marker="|", markersize=9, label="switch or curve"))
    legend_below(figure, handles, columns=3)
    axes.set_xlim(0.0, scene.track.end_m)
    return figure


def mark(axes: Axes, scene: AimScene) -> None:
    """Stretch, position and bends along the bottom."""
    stretch, bottom = scene.stretch, axes.get_xaxis_transform()
    spans = [(stretch.from_m, stretch.to_m - stretch.from_m)]
    axes.broken_barh(spans, (0.0, 0.018), transform=bottom, facecolor=GREY, zorder=4)
    position = [(scene.entrance_m, scene.exit_m - scene.entrance_m)]
    axes.broken_barh(position, (0.0, 0.03), transform=bottom, facecolor=INK, zorder=5)
    middles = [0.5 * (bend.from_m + bend.to_m) for bend in scene.track.bends]
    axes.plot(middles, [0.045] * len(middles), "|", color=GREY, markersize=9, transform=bottom, zorder=4)
