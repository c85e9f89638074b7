"""Picture: rms of the peers over that of the table, a panel for each permission and price of a command."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import (
    INK,
    LINE_COLOURS,
    LINE_MARKERS,
    dress,
    legend_below,
    logarithmic_x,
    new_figure,
    place,
)

if TYPE_CHECKING:
    from scripts.studies.peers.findings import Contest, Peers

COLUMNS = 2
APART = 0.13
"""Of a row: how far the controllers of a case are drawn from each other."""


def figures(found: Peers) -> Mapping[str, Figure]:
    """`ratios`: below 1 a controller has less rms than the table with estimator."""
    kinds = found.kinds()
    rows = math.ceil(len(kinds) / COLUMNS)
    subject = f"rms / rms of the table with estimator, {found.passes} passes each, 95 %; below 1 the table is worse"
    figure = new_figure(10.0, 3.3 * rows + 1.0, "Tables and their peers", subject)
    place(figure, left=1.75, right=0.2, bottom=0.95, top=0.9, w=0.5, h=0.38)
    panels = figure.subplots(rows, COLUMNS, squeeze=False).ravel()
    for axes, (permission, price) in zip(panels, kinds, strict=False):
        dress(axes, f"commands {permission}, {price}", "rms / rms of the table")
        draw(axes, found.of(permission, price))
        logarithmic_x(axes, [each.ratio for contest in found.contests for each in contest.figures])
    for axes in panels[len(kinds) :]:
        axes.set_visible(False)
    names = [each.name for each in found.contests[0].figures[1:]]
    handles = [
        Line2D([], [], color=LINE_COLOURS[i], marker=LINE_MARKERS[i], linestyle="", label=name)
        for i, name in enumerate(names)
    ]
    legend_below(figure, handles, columns=len(names))
    return {"ratios": figure}


def draw(axes: Axes, contests: Sequence[Contest]) -> None:
    """A row for each case, the first on top."""
    for row, contest in enumerate(contests):
        for i, each in enumerate(contest.figures[1:]):
            off = [[abs(end - each.ratio)] for end in each.ratio_ci95]
            axes.errorbar(
                [each.ratio], [row + APART * (i - 1.5)], xerr=off, color=LINE_COLOURS[i], marker=LINE_MARKERS[i],
                markersize=4.5, capsize=2, linewidth=1.0,
            )  # fmt: skip
    axes.axvline(1.0, color=INK, linewidth=1.0, linestyle="--")
    axes.set_yticks(range(len(contests)), [contest.case for contest in contests])
    axes.set_ylim(len(contests) - 0.5, -0.5)
