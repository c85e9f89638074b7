"""Picture: predicted rms over the degree of the polynomial lines."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.frame.picture.house_style import BLUE, INK, ORANGE, dress, legend_below, logarithmic_y, new_figure, place

if TYPE_CHECKING:
    from scripts.studies.degree.study import CaseRow, Degrees

MOST_COLUMNS = 5

NO_BOUND: Final = (
    "The solver's lines are no lower bound: they are not polished and go one stage a command; tables are polished and\n"
    "may pass over stages. The polish ends early: a few per cent between two degrees tell as much of it as of them."
)
"""Why a fit may be better than what it was fitted to, and a low degree better than a high one."""


def figures(found: Degrees) -> Mapping[str, Figure]:
    """One panel a case: rms in m/s over degree, predicted as for an exported table; logarithmic, one scale for all."""
    columns = min(len(found.cases), MOST_COLUMNS)
    rows = math.ceil(len(found.cases) / columns)
    figure = new_figure(
        max(8.0, 2.7 * columns + 0.7), 2.7 * rows + 1.95, "Exit-speed error by degree of the lines", NO_BOUND
    )
    place(figure, left=0.75, right=0.2, bottom=0.95, top=1.1, w=0.1, h=0.3)
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes, case in zip(panels.flat, found.cases, strict=False):
        draw_case(axes, case)
    every = [row for case in found.cases for row in case.rows]
    before = [row.fitted_predicted_rms_m_s for row in every if row.fitted_predicted_rms_m_s is not None]
    logarithmic_y(panels[0, 0], [*before, *(row.predicted_rms_m_s for row in every)])
    for axes in panels.flat[len(found.cases) :]:
        axes.set_axis_off()
    for row in panels:
        row[0].set_ylabel("predicted rms, m/s", fontsize=9)
    handles = [
        Line2D([], [], color=ORANGE, marker="s", linestyle="--", label="fitted by weighted least squares"),
        Line2D([], [], color=BLUE, marker="o", label="polished on the evaluated policy"),
        Line2D([], [], color=INK, linestyle=":", label="solver's lines, neither polished nor smoothed"),
    ]
    legend_below(figure, handles, columns=len(handles))
    return {"": figure}


def draw_case(axes: Axes, case: CaseRow) -> None:
    """Fitted, polished, and the level of the unsmoothed lines."""
    *rows, lines = case.rows
    fitted = {r.degree: r.fitted_predicted_rms_m_s for r in rows if r.fitted_predicted_rms_m_s is not None}
    axes.axhline(lines.predicted_rms_m_s, color=INK, linestyle=":", linewidth=1.4)
    axes.plot(list(fitted), list(fitted.values()), "--s", color=ORANGE, markersize=5)
    axes.plot([r.degree for r in rows], [r.predicted_rms_m_s for r in rows], "-o", color=BLUE, markersize=5)
    dress(axes, case.case, "degree")
    axes.set_xticks([r.degree for r in rows])
