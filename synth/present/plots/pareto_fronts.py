"""Accuracy against time in the position: a panel for each case, a mark for each price of a second."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.figure import Figure

from synth.book.pareto.pareto_front import ParetoFront
from synth.present.plots.house_style import BLUE, INK, dress, new_figure, place

COLUMNS = 3


def pareto_fronts(fronts: Sequence[ParetoFront]) -> Figure:
    """Simulated rms over the mean time, with 95 % intervals; crosses: the predicted rms. Prices stand at the marks."""
    columns = min(COLUMNS, len(fronts))
    rows = math.ceil(len(fronts) / columns)
    figure = new_figure(3.9 * columns + 0.4, 3.2 * rows + 0.5, "Accuracy against time in the position")
    place(figure, left=0.75, right=0.2, bottom=0.6, top=0.85, w=0.32, h=0.5)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, front in zip(panels, fronts, strict=False):
        times = [each.statistics.time_s for each in front.points]
        rms = [1e3 * each.statistics.rms_m_s for each in front.points]
        ends = [each.statistics.rms_ci95_m_s for each in front.points]
        off = [[abs(1e3 * each[end] - value) for each, value in zip(ends, rms, strict=True)] for end in (0, 1)]
        axes.errorbar(times, rms, yerr=off, color=BLUE, marker="o", markersize=4, capsize=2, linewidth=1.0)
        axes.plot(times, [1e3 * each.predicted_rms_m_s for each in front.points], color=INK, marker="x", linestyle="")
        for x, y, each in zip(times, rms, front.points, strict=True):
            axes.annotate(f"{each.time_price_m2_s3:g}", (x, y), xytext=(4, 5), textcoords="offset points", fontsize=7)
        dress(axes, front.name, "mean time, s", "rms, mm/s")
    for axes in panels[len(fronts) :]:
        axes.set_visible(False)
    return figure
