"""Mean gap at the required chance over free distance, by cars in a cut; a panel for each category and knowledge."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from synth.aim.aim_book import AimBook, MadeAim
from synth.frame.picture.house_style import dress, legend_below, new_figure, place
from synth.frame.picture.series import graded, markers, named_lines
from synth.frame.printed_numbers import counted


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
