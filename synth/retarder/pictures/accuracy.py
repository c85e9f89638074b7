"""All cases side by side: the simulated rms of every controller, and what was predicted of the table; which entry
speeds the position can serve at all; and accuracy against time in the position, a mark for each price of a second.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from synth.frame.picture.house_style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    INK,
    LINE_MARKERS,
    LINE_STYLES,
    ORANGE,
    PALE_GREY,
    PURPLE,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_y,
    new_figure,
    place,
)
from synth.frame.picture.picture import category_colour
from synth.retarder.case_result import CaseResult, ParetoFront
from synth.retarder.comparison.measured import Measured
from synth.retarder.tuned_case import by_class


@dataclass(frozen=True)
class Look:
    """Colour and marker of a controller."""

    colour: str
    marker: str


LOOKS = (
    Look(BLUE, "o"),
    Look(SKY, "s"),
    Look(VERMILLION, "D"),
    Look(BLACK, "_"),
    Look(PURPLE, "v"),
    Look(GREY, "<"),
    Look(ORANGE, "^"),
    Look(GREEN, "P"),
    Look(BLUE, "X"),
)
"""By the order of `CaseResult.comparison`; further controllers take them again from the start."""

TABLE = 0
"""Place of the table, whose predicted rms is drawn too, hollow."""

MOST_COMMON = 4
"""Controllers of a case without estimator: their dots stand at the same places in every figure."""

SLOT = 0.78
"""Share of a case's width that its dots take."""


def rms_by_controller(cases: Sequence[CaseResult], limit_m_s: float) -> Figure:
    """Logarithmic rms in m/s with 95 % interval, one slot a case; `limit_m_s` is the acceptance limit."""
    figure = new_figure(max(7.0, 0.84 * len(cases) + 1.0), 6.2, "Exit-speed error by controller")
    place(figure, left=0.75, right=0.15, bottom=1.55, top=0.65)
    axes = figure.subplots()
    dress(axes, y="rms of exit speed − target, m/s")
    axes.grid(False, axis="x")
    for place_no, entries in enumerate(zip(*(case.controllers for case in cases), strict=False)):
        draw_controller(axes, place_no, entries)
    axes.axhline(limit_m_s, color=INK, linewidth=1.2, linestyle="--", zorder=1)
    logarithmic_y(axes, values_m_s(cases, limit_m_s))
    axes.set_xlim(-0.5, len(cases) - 0.5)
    axes.text(-0.47, limit_m_s * 1.02, "acceptance limit", fontsize=8, va="bottom")
    mark_cases(axes, cases, limit_m_s)
    # Four columns of entries, the longest of which is a sentence, need 8.6 inches.
    columns = 4 if figure.get_size_inches()[0] >= 8.6 else 3
    legend_below(figure, legend_entries(cases[0].controllers), columns=columns)
    return figure


def offset(place_no: int, controllers: int) -> float:
    """Where in its slot a controller's dot stands."""
    return SLOT * ((place_no + 0.5) / controllers - 0.5)


def draw_controller(axes: Axes, place_no: int, entries: Sequence[Measured]) -> None:
    """The dots of one controller over all cases."""
    look = LOOKS[place_no % len(LOOKS)]
    rms = np.array([entry.statistics.rms_m_s for entry in entries])
    interval = np.array([entry.statistics.rms_ci95_m_s for entry in entries]).T
    x = np.arange(len(entries)) + offset(place_no, max(MOST_COMMON, place_no + 1))
    axes.errorbar(
        x, rms, (rms - interval[0], interval[1] - rms), fmt=look.marker, color=look.colour, markersize=6,
        elinewidth=1.0, markeredgewidth=2.0 if look.marker == "_" else 0.5, zorder=3,
    )  # fmt: skip
    if place_no == TABLE:
        predicted = np.array([entry.predicted_rms_m_s for entry in entries])
        axes.vlines(x, predicted, rms, color=look.colour, linewidth=0.8, linestyle=":", zorder=2)
        axes.plot(x, predicted, look.marker, color=look.colour, markersize=6, markerfacecolor="white", zorder=2.5)


def mark_cases(axes: Axes, cases: Sequence[CaseResult], limit_m_s: float) -> None:
    """Targets and classes under the axis; cases that cannot keep the limit grey, with the reason."""
    axes.set_xticks(range(len(cases)), [f"{case.target_speed_m_s:g} m/s" for case in cases])
    axes.tick_params(axis="x", length=0)
    start = 0
    for group in by_class(cases):
        middle, end = start + 0.5 * (len(group) - 1), start + len(group) - 0.5
        name = f"{group[0].label}\nstages 0–{group[0].plant.top_stage}"
        axes.annotate(
            name, (middle, 0.0), (0.0, -20.0), xycoords=("data", "axes fraction"), textcoords="offset points",
            ha="center", va="top", fontsize=9,
        )  # fmt: skip
        if end < len(cases) - 0.5:
            axes.axvline(end, color=GREY, linewidth=0.8)
        start += len(group)
    for index, case in enumerate(cases):
        if case.unavoidable.forbids(limit_m_s):
            axes.axvspan(index - 0.5, index + 0.5, color=PALE_GREY, zorder=0)
            axes.text(
                index - 0.46, 0.02, case.unavoidable.obstacle, transform=axes.get_xaxis_transform(), rotation=90,
                va="bottom", fontsize=8, color=INK,
            )  # fmt: skip


def values_m_s(cases: Sequence[CaseResult], limit_m_s: float) -> list[float]:
    """Everything that the figure must have room for."""
    entries = [entry for case in cases for entry in case.controllers]
    predicted = [case.table.predicted.rms_m_s for case in cases]
    return [limit_m_s, *(entry.statistics.rms_m_s for entry in entries), *predicted]


def legend_entries(comparison: Sequence[Measured]) -> list[Line2D]:
    """One entry a controller, and what a hollow marker is."""
    entries = []
    for place_no, entry in enumerate(comparison):
        look = LOOKS[place_no % len(LOOKS)]
        edge = 2.0 if look.marker == "_" else 0.5
        dot = Line2D([], [], color=look.colour, marker=look.marker, linestyle="", markersize=7, markeredgewidth=edge)
        dot.set_label(entry.name)
        entries.append(dot)
    look = LOOKS[TABLE]
    hollow = Line2D([], [], color=look.colour, marker=look.marker, linestyle=":", markersize=6, markerfacecolor="white")
    hollow.set_label("hollow: predicted of the table")
    return [*entries, hollow]


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


COLUMNS = 3

LEAST_APART = 0.12
"""Of the times of a panel: marks nearer to each other have one price."""


def pareto_fronts(fronts: Sequence[ParetoFront]) -> Figure:
    """Simulated rms over the mean time, with 95 % intervals; crosses: the predicted rms. Prices stand at the marks."""
    columns = min(COLUMNS, len(fronts))
    rows = math.ceil(len(fronts) / columns)
    figure = new_figure(3.9 * columns + 0.4, 3.2 * rows + 0.8, "Accuracy against time in the position")
    place(figure, left=0.75, right=0.2, bottom=0.9, top=0.85, w=0.32, h=0.5)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, front in zip(panels, fronts, strict=False):
        times = [each.statistics.time_s for each in front.points]
        rms = [each.statistics.rms_m_s for each in front.points]
        ends = [each.statistics.rms_ci95_m_s for each in front.points]
        off = [[abs(each[end] - value) for each, value in zip(ends, rms, strict=True)] for end in (0, 1)]
        axes.errorbar(
            times, rms, yerr=off, color=BLUE, marker="o", markersize=4, capsize=2, linewidth=1.0,
            label="simulated, 95 %, by the price of a second, m²/s³",
        )  # fmt: skip
        predicted = [each.predicted_rms_m_s for each in front.points]
        axes.plot(times, predicted, color=INK, marker="x", linestyle="", label="predicted")
        for i in apart(times):
            price = f"{front.points[i].time_price_m2_s3:g}"
            axes.annotate(price, (times[i], rms[i]), xytext=(3, -11), textcoords="offset points", fontsize=7)
        axes.margins(x=0.12)
        dress(axes, front.name, "mean time, s", "rms, m/s")
    for axes in panels[len(fronts) :]:
        axes.set_visible(False)
    legend_below(figure, panels[0].get_legend_handles_labels()[0], columns=2)
    return figure


def apart(times: Sequence[float]) -> list[int]:
    """The marks that have room for their price beside it: the last, which is dearest, and others far enough from it."""
    room, kept = LEAST_APART * (max(times) - min(times)), [len(times) - 1]
    for i in range(len(times) - 2, -1, -1):
        if abs(times[i] - times[kept[-1]]) >= room:
            kept.append(i)
    return kept
