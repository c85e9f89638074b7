"""Simulated rms exit error of every controller in every case, and what was predicted of the table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    INK,
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
from synth.retarder.case_names import by_class
from synth.retarder.case_result import CaseResult
from synth.retarder.comparison.measured import Measured


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
