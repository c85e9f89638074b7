"""Which entry speeds the position can serve at all: rms of the unavoidable error, over entry speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from synth.frame.picture.category_colour import category_colour
from synth.frame.picture.house_style import (
    GREY,
    INK,
    LINE_MARKERS,
    LINE_STYLES,
    PALE_GREY,
    dress,
    legend_below,
    logarithmic_y,
    new_figure,
    place,
)
from synth.retarder.case_names import by_class
from synth.retarder.case_result import CaseResult

LEAST_SHOWN = 0.01
"""Of the limit; what is less is off the axis."""


def feasibility(cases: Sequence[CaseResult]) -> Figure:
    """One panel a target: unavoidable rms in m/s (logarithmic) over entry speed; bars below: the served range."""
    targets = sorted({case.target_speed_m_s for case in cases})
    labels = [group[0].label for group in by_class(cases)]
    figure = new_figure(3.6 * len(targets) + 1.5, 5.6, "What the position can do, whatever its controller")
    place(figure, left=1.35, right=0.2, bottom=1.15, top=0.75, w=0.08, h=0.17)
    grid = figure.add_gridspec(2, len(targets), height_ratios=(1.0, 0.09 * len(labels) + 0.05))
    limits = [case.feasibility.limit_m_s for case in cases]
    values = [rms for case in cases for rms in case.feasibility.entry_rms_m_s if rms > LEAST_SHOWN * min(limits)]
    entry = [float(speed) for case in cases for speed in case.feasibility.entry_m_s]
    margin = 0.03 * (max(entry) - min(entry)) + 1e-3
    for column, target in enumerate(targets):
        above, below = figure.add_subplot(grid[0, column]), figure.add_subplot(grid[1, column])
        above.sharex(below)
        here = [case for case in cases if case.target_speed_m_s == target]
        asked_m_s = (min(c.plant.entry.low_m_s for c in here), max(c.plant.entry.high_m_s for c in here))
        draw_rms(above, here, labels)
        logarithmic_y(above, [*limits, *values])
        draw_served(below, here, labels)
        below.set_xlim(min(entry) - margin, max(entry) + margin)
        for axes in (above, below):
            axes.axvspan(*asked_m_s, color=PALE_GREY, zorder=0)
            axes.tick_params(labelleft=column == 0)
        if column == 0:
            above.set_ylabel("unavoidable rms, m/s", fontsize=9)
    handles = [
        Line2D([], [], color=class_colour(group[0]), marker=marker, linestyle=style, markersize=4.5, label=label)
        for label, group, marker, style in zip(labels, by_class(cases), LINE_MARKERS, LINE_STYLES, strict=False)
    ]
    limit = Line2D([], [], color=INK, linestyle="--", linewidth=1.2, label="acceptance limit")
    asked = Patch(facecolor=PALE_GREY, label="configured entry speeds")
    legend_below(figure, [*handles, limit, asked], columns=4)
    return figure


def class_colour(case: CaseResult) -> str:
    """That of the weight category of the class; classes of one category differ in stroke and marker."""
    number = case.table.cut.number
    return GREY if number is None else category_colour(number)


def draw_rms(axes: Axes, cases: Sequence[CaseResult], labels: Sequence[str]) -> None:
    """The upper panel of one target."""
    for case in cases:
        place_no = labels.index(case.label) % len(LINE_STYLES)
        found = case.feasibility
        axes.plot(
            found.entry_m_s, found.entry_rms_m_s, color=class_colour(case), linestyle=LINE_STYLES[place_no],
            marker=LINE_MARKERS[place_no], markevery=max(1, found.entry_m_s.size // 8), markersize=4, linewidth=1.4,
        )  # fmt: skip
        axes.axhline(found.limit_m_s, color=INK, linestyle="--", linewidth=1.2, zorder=1)
    dress(axes, f"target {cases[0].target_speed_m_s:g} m/s")
    axes.tick_params(labelbottom=False)


def draw_served(axes: Axes, cases: Sequence[CaseResult], labels: Sequence[str]) -> None:
    """Bars from the lowest to the highest entry speed that is served, one row a class."""
    for case in cases:
        row, served = labels.index(case.label), case.feasibility.served_m_s
        if served is None:
            middle = float(np.mean(case.feasibility.entry_m_s))
            axes.text(middle, row, "none", ha="center", va="center", fontsize=7.5)
        else:
            axes.barh(row, served[1] - served[0], left=served[0], height=0.55, color=class_colour(case))
    dress(axes, "can be served: rms within the limit", "entry speed, m/s")
    axes.set_ylim(len(labels) - 0.4, -0.6)
    axes.set_yticks(range(len(labels)), labels)
    axes.grid(False, axis="y")
