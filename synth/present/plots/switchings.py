"""What the region of indifferent control saves in valve switchings, and what it costs in accuracy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from synth.book.case_names import case_name
from synth.book.case_result import CaseResult
from synth.present.plots.house_style import BLUE, GREY, ORANGE, dress, legend_below, logarithmic_x, new_figure, place


def switchings(cases: Sequence[CaseResult]) -> Figure:
    """One row a case, with and without the region: predicted switchings a pass on the left, rms in m/s on the right."""
    figure = new_figure(10.0, 0.27 * len(cases) + 1.9, "Use of the indifferent region: switchings saved, error paid")
    place(figure, left=1.9, right=0.25, bottom=0.95, top=0.7, w=0.08)
    left, right = figure.subplots(1, 2, sharey=True)
    found = [case.study.indifference for case in cases]
    draw_pairs(left, np.array([(i.switchings_without, i.switchings_with) for i in found]))
    draw_pairs(right, np.array([(i.rms_without_m_s, i.rms_with_m_s) for i in found]))
    dress(left, x="switchings a pass")
    dress(right, x="rms of exit speed − target, m/s")
    left.set_xlim(left=0.0)
    logarithmic_x(right, [rms for i in found for rms in (i.rms_without_m_s, i.rms_with_m_s)])
    left.set_yticks(range(len(cases)), [case_name(case) for case in cases])
    left.set_ylim(len(cases) - 0.4, -0.6)
    right.tick_params(labelleft=False)
    handles = [
        Line2D([], [], color=ORANGE, marker="o", linestyle="", markerfacecolor="white", label="every gain is taken"),
        Line2D([], [], color=BLUE, marker="o", linestyle="", label=f"hold within the tolerance ({tolerances(cases)})"),
    ]
    legend_below(figure, handles, columns=2)
    return figure


def draw_pairs(axes: Axes, pairs: NDArray[np.float64]) -> None:
    """Hollow: without; full: with; a line between the two. `pairs` (cases, 2)."""
    rows = np.arange(len(pairs))
    axes.hlines(rows, pairs.min(axis=1), pairs.max(axis=1), color=GREY, linewidth=1.5, zorder=1)
    axes.plot(pairs[:, 0], rows, "o", color=ORANGE, markerfacecolor="white", markersize=6.5, markeredgewidth=1.5)
    axes.plot(pairs[:, 1], rows, "o", color=BLUE, markersize=5)


def tolerances(cases: Sequence[CaseResult]) -> str:
    """The tolerance of the cost in words; several where the cases differ."""
    values = sorted({case.study.indifference.tolerance_m2_s2 for case in cases})
    return ", ".join(f"{value:g}" for value in values) + " m²/s²"
