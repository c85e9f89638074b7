"""What a reserve costs and what it gives: the worst plant over the price, and every case before and after."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.axes import Axes

from scripts.studies.estimator.reserve_findings import HIGHEST_PRICE, HIGHEST_RATIO
from synth.frame.picture.house_style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LINE_COLOURS,
    LINE_MARKERS,
    PALE_GREY,
    VERMILLION,
    dress,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from scripts.studies.estimator.reserve_findings import Reserves

LEAST_HEIGHT_IN = 4.5
"""Below, the label of the vertical axis would not fit beside it."""


def picture(found: Reserves) -> Figure:
    """Left: price and worst ratio for each uncertainty of the mean; right: the worst ratio of every case."""
    cases = len(found.cases)
    figure = new_figure(12.5, max(LEAST_HEIGHT_IN, 2.2 + 0.21 * cases), "A reserve for less friction than thought")
    place(figure, left=0.8, right=0.3, bottom=0.7, top=0.75, w=0.42)
    left, right = figure.subplots(1, 2)
    curve(left, found)
    before_and_after(right, found)
    return figure


def curve(axes: Axes, found: Reserves) -> None:
    """A mark a case and uncertainty; large ones and the line: the largest of all cases in both."""
    dress(
        axes, "green: what a reserve may cost, and how much worse a plant may be",
        "rms on its own plant / that without reserve", "largest rms with / without estimator, any plant",
    )  # fmt: skip
    rows = [row for case in found.cases for row in case.rows]
    low = min(0.95 * min(row.price for row in rows), 0.95), 0.97 * min(row.worst_ratio for row in rows)
    axes.fill_between((low[0], HIGHEST_PRICE), low[1], HIGHEST_RATIO, color=GREEN, alpha=0.12, linewidth=0)
    largest = []
    for i, first in enumerate(found.cases[0].rows):
        of_all = [case.rows[i] for case in found.cases]
        prices, worst = [row.price for row in of_all], [row.worst_ratio for row in of_all]
        colour, marker = LINE_COLOURS[i % 7], LINE_MARKERS[i % 7]
        axes.plot(prices, worst, marker, color=colour, markersize=4, alpha=0.55, fillstyle="none")
        largest.append((max(prices), max(worst), colour, marker, f"mean_cv = {first.mean_cv:g}"))
    axes.plot([m[0] for m in largest], [m[1] for m in largest], color=BLACK, linewidth=1.2, zorder=3)
    for x, y, colour, marker, label in largest:
        axes.plot(x, y, marker, color=colour, markersize=9, markeredgecolor=BLACK, linestyle="", label=label, zorder=4)
    axes.set_xlim(left=low[0])
    axes.set_ylim(bottom=low[1])
    axes.legend(fontsize=8, title="small: a case; large: the largest of all", title_fontsize=8, loc="best")


def before_and_after(axes: Axes, found: Reserves) -> None:
    """A line a case, from the worst ratio without reserve to that with the assumed one; those most helped on top."""
    rows = [(case.case, case.rows[0].worst_ratio, row) for case, row in found.assumed_rows()]
    rows.sort(key=lambda row: row[1])
    dress(axes, f"hollow: without reserve; full: mean_cv = {found.shown:g}, with its 95 % interval",
          "largest rms with / without estimator, any plant", "")  # fmt: skip
    axes.grid(axis="y", visible=False)
    for y, (_, before, row) in enumerate(rows):
        axes.plot((before, row.worst_ratio), (y, y), color=PALE_GREY, linewidth=3, solid_capstyle="round")
        axes.plot(before, y, "o", color=VERMILLION, markersize=5, fillstyle="none")
        axes.plot(row.worst_ci95, (y, y), color=BLUE, linewidth=1.4)
        axes.plot(row.worst_ratio, y, "o", color=BLUE, markersize=5)
    axes.axvline(1.0, color=GREY, linewidth=0.8)
    axes.axvline(HIGHEST_RATIO, color=GREEN, linewidth=1.0, linestyle="--")
    axes.set_yticks(range(len(rows)), [name for name, _, _ in rows], fontsize=8)


def figures(found: Reserves) -> Mapping[str, Figure]:
    """The curve, with every case beside it."""
    return {"": picture(found)}
