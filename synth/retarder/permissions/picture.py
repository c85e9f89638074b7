"""What each permission of the hardware would give: rms over that of the configured table, case by case."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import (
    INK,
    LINE_COLOURS,
    LINE_MARKERS,
    dress,
    legend_below,
    new_figure,
    place,
)
from synth.retarder.permissions.permission import CasePermissions, asked_of

ROW = 0.62
"""Share of a row's height that its marks take."""


def ratio_rows(title: str, cases: Sequence[CasePermissions]) -> Figure:
    """The figure."""
    shown = asked_of(cases)
    figure = new_figure(9.0, 0.5 * len(cases) + 2.4, "What permissions of the hardware would give", title)
    place(figure, left=2.2, right=0.25, bottom=1.1, top=0.8)
    axes = figure.subplots()
    for i, permission in enumerate(shown):
        shift = ROW * (0.5 - (i + 0.5) / len(shown))
        for row, case in enumerate(cases):
            found = case.of(permission)
            if found is None:
                continue
            low, high = found.ratio_ci95
            axes.errorbar(
                [found.ratio], [len(cases) - 1 - row + shift], xerr=[[found.ratio - low], [high - found.ratio]],
                color=LINE_COLOURS[i], marker=LINE_MARKERS[i], markersize=5, capsize=2, linewidth=1.0, linestyle="",
            )  # fmt: skip
    axes.axvline(1.0, color=INK, linewidth=0.8)
    dress(axes, x="rms / rms of the table as configured")
    names = [f"{case.label} to {case.target_speed_m_s:g} m/s" for case in cases]
    axes.set_yticks(range(len(cases)), names[::-1], fontsize=9)
    axes.set_ylim(-0.6, len(cases) - 0.4)
    handles = [
        Line2D([], [], color=LINE_COLOURS[i], marker=LINE_MARKERS[i], linestyle="", label=each.value)
        for i, each in enumerate(shown)
    ]
    legend_below(figure, handles, columns=2)
    return figure
