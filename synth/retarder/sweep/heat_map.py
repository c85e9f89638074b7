"""The picture of a book: simulated rms of every table, cut classes up, targets across."""

from __future__ import annotations

import math
from itertools import pairwise

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PatchCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from synth.frame.picture.house_style import GREY, INK, dress, mark_plainly, new_figure, place
from synth.retarder.sweep.book_figures import BookFigures

COLOURS = "viridis"
MOST_LABELS = 24
HALF_CELL = 0.5


def heat_map(book: BookFigures) -> Figure:
    """One cell a table, wide to half the way to its neighbours; a dot where it misses a limit of [acceptance].

    The cells of targets that have no table are hatched.
    """
    cases, condition = book.cases, book.condition
    refused = {(each.label, each.target_m_s) for each in book.failures if each.target_m_s is not None}
    labels = list(dict.fromkeys(case["label"] for case in cases))
    height = min(12.0, max(2.0, 0.24 * len(labels)))
    subject = condition.name or condition.config.title
    figure = new_figure(8.0, height + 1.5, "Exit-speed error of every table", subject)
    place(figure, left=1.7, right=1.5, bottom=0.75, top=0.75)
    axes = figure.subplots()
    rms = [case["rms_m_s"].value for case in cases]
    low, high = min(rms), max(rms)
    norm = LogNorm(low * 0.999, max(high, 1.05 * low))
    found = {(case["label"], case["target_speed_m_s"]): case for case in cases}
    places = sorted({*found, *(place for place in refused if place[0] in labels)})
    cells, values, dots, empty = [], [], [], []
    for row, label in enumerate(labels):
        mine = [target for name, target in places if name == label]
        for target, (left, right) in zip(
            mine, pairwise(cell_edges(mine, [target for _, target in places])), strict=True
        ):
            cell = Rectangle((left, row - HALF_CELL), right - left, 1.0)
            case = found.get((label, target))
            if case is None:
                empty.append(cell)
                continue
            cells.append(cell)
            values.append(case["rms_m_s"].value)
            if case["missed_limits"]:
                dots.append((target, row))
    painted = PatchCollection(cells, cmap=COLOURS, norm=norm, edgecolor="white", linewidth=0.4)
    painted.set_array(values)
    missed = "; dot: a limit of [acceptance] is missed" if dots else ""
    hatched = "; hatched: no table" if empty else ""
    dress(axes, f"simulated rms{missed}{hatched}", "commanded exit speed, m/s")
    axes.add_collection(painted)
    axes.add_collection(PatchCollection(empty, facecolor="white", edgecolor=GREY, hatch="////", linewidth=0.4))
    if dots:
        axes.scatter(
            [x for x, _ in dots], [y for _, y in dots], s=9, c="white", edgecolors=INK, linewidths=0.6, zorder=3
        )
    frame(axes, labels, cells + empty)
    bar_of(figure, axes, painted, norm)
    return figure


def cell_edges(mine_m_s: list[float], all_m_s: list[float]) -> list[float]:
    """Half-way between the neighbours of one class; at both ends a little beyond the outermost target of any class."""
    inner = [0.5 * (low + high) for low, high in pairwise(mine_m_s)]
    steps = [high - low for low, high in pairwise(sorted(set(all_m_s)))]
    margin = 0.5 * min(steps, default=0.5)
    return [min(all_m_s) - margin, *inner, max(all_m_s) + margin]


def frame(axes: Axes, labels: list[str], cells: list[Rectangle]) -> None:
    """Limits of the panel, and as many class labels as are readable."""
    axes.set_xlim(min(cell.get_x() for cell in cells), max(cell.get_x() + cell.get_width() for cell in cells))
    axes.set_ylim(-HALF_CELL, len(labels) - HALF_CELL)
    every = math.ceil(len(labels) / MOST_LABELS)
    axes.set_yticks(range(0, len(labels), every), labels[::every])
    axes.grid(False)


def bar_of(figure: Figure, axes: Axes, painted: ScalarMappable, norm: LogNorm) -> None:
    """The scale of colours, logarithmic, beside the panel."""
    box = axes.get_position()
    width = figure.get_size_inches()[0]
    bar = figure.colorbar(painted, cax=figure.add_axes((box.x1 + 0.25 / width, box.y0, 0.18 / width, box.height)))
    assert norm.vmin is not None
    assert norm.vmax is not None
    mark_plainly(bar.ax.yaxis, norm.vmin, norm.vmax)
    bar.set_label("rms, m/s", fontsize=9)
    bar.ax.tick_params(labelsize=8, length=3)
    bar.outline.set_visible(False)
