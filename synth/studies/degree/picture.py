"""Exit error against the degree of the polynomial lines."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from synth.book.case_result import DegreeStudy
from synth.present.plots.house_style import BLUE, INK, ORANGE, dress, legend_below, logarithmic_y, new_figure, place

MOST_COLUMNS = 5


def degree_study(studies: Sequence[DegreeStudy]) -> Figure:
    """One panel a study: rms in m/s over degree, predicted as for an exported table; logarithmic, one scale for all."""
    columns = min(len(studies), MOST_COLUMNS)
    rows = math.ceil(len(studies) / columns)
    figure = new_figure(max(8.0, 2.7 * columns + 0.7), 2.7 * rows + 1.6, "Exit-speed error by degree of the lines")
    place(figure, left=0.75, right=0.2, bottom=0.95, top=0.75, w=0.1, h=0.3)
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes, study in zip(panels.flat, studies, strict=False):
        draw_study(axes, study)
    values = [[study.lines_rms_m_s, *study.fitted_rms_m_s, *study.polished_rms_m_s] for study in studies]
    logarithmic_y(panels[0, 0], [value for row in values for value in row])
    for axes in panels.flat[len(studies) :]:
        axes.set_axis_off()
    for row in panels:
        row[0].set_ylabel("predicted rms, m/s", fontsize=9)
    handles = [
        Line2D([], [], color=ORANGE, marker="s", linestyle="--", label="fitted by weighted least squares"),
        Line2D([], [], color=BLUE, marker="o", label="polished on the evaluated policy"),
        Line2D([], [], color=INK, linestyle=":", label="solver's lines, not smoothed"),
    ]
    legend_below(figure, handles, columns=len(handles))
    return figure


def draw_study(axes: Axes, study: DegreeStudy) -> None:
    """Fitted, polished, and the level of the unsmoothed lines."""
    axes.axhline(study.lines_rms_m_s, color=INK, linestyle=":", linewidth=1.4)
    axes.plot(study.degrees, study.fitted_rms_m_s, "--s", color=ORANGE, markersize=5)
    axes.plot(study.degrees, study.polished_rms_m_s, "-o", color=BLUE, markersize=5)
    dress(axes, study.label, "degree")
    axes.set_xticks(study.degrees)
