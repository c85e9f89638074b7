"""The picture of the study `limits`: a panel a case, a bar a change."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from synth.frame.picture.house_style import BLACK, SKY, dress, new_figure, place

if TYPE_CHECKING:
    from scripts.studies.limits.study import Limits, Row


def picture(rows: Sequence[Row]) -> Figure:
    """Bars: rms near the target with its interval; rings: rms of all passes; dotted: the plant as it is."""
    cases = list(dict.fromkeys(row.case for row in rows))
    lines, columns = math.ceil(len(cases) / 2), min(2, len(cases))
    figure = new_figure(11.0, 2.0 + 2.9 * lines, "What limits the accuracy")
    place(figure, left=2.6, right=0.3, bottom=0.7, top=0.75, w=0.15, h=0.35)
    panels = np.atleast_1d(figure.subplots(lines, columns, sharey=True)).ravel()
    for axes, case in zip(panels, cases, strict=False):
        draw(axes, case, [row for row in rows if row.case == case])
    for axes in panels[len(cases) :]:
        axes.set_visible(False)
    return figure


def draw(axes: Axes, case: str, rows: Sequence[Row]) -> None:
    """One case."""
    dress(axes, case, "rms within 0.3 m/s of the target (bar, 95 %), of all (ring), mm/s", "")
    axes.grid(axis="y", visible=False)
    places = np.arange(len(rows))[::-1]
    axes.barh(places, [1e3 * row.near.rms_m_s for row in rows], height=0.6, color=SKY)
    axes.plot([1e3 * row.rms_m_s for row in rows], places, "o", color=BLACK, markersize=4, fillstyle="none")
    for at, row in zip(places, rows, strict=True):
        axes.plot([1e3 * end for end in row.near.ci95_m_s], [at, at], color=BLACK, linewidth=1.5)
    axes.axvline(1e3 * rows[0].near.rms_m_s, color=BLACK, linewidth=0.8, linestyle=":")
    axes.set_yticks(places, [row.change for row in rows], fontsize=8)


def figures(found: Limits) -> Mapping[str, Figure]:
    """A panel a case."""
    return {"": picture(found.rows)}
