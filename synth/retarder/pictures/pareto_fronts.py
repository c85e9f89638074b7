"""Accuracy against time in the position: a panel for each case, a mark for each price of a second."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.figure import Figure

from synth.frame.picture.house_style import BLUE, INK, dress, legend_below, new_figure, place
from synth.retarder.pareto.pareto_front import ParetoFront

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
        rms = [1e3 * each.statistics.rms_m_s for each in front.points]
        ends = [each.statistics.rms_ci95_m_s for each in front.points]
        off = [[abs(1e3 * each[end] - value) for each, value in zip(ends, rms, strict=True)] for end in (0, 1)]
        axes.errorbar(
            times, rms, yerr=off, color=BLUE, marker="o", markersize=4, capsize=2, linewidth=1.0,
            label="simulated, 95 %, by the price of a second, m²/s³",
        )  # fmt: skip
        predicted = [1e3 * each.predicted_rms_m_s for each in front.points]
        axes.plot(times, predicted, color=INK, marker="x", linestyle="", label="predicted")
        for i in apart(times):
            price = f"{front.points[i].time_price_m2_s3:g}"
            axes.annotate(price, (times[i], rms[i]), xytext=(3, -11), textcoords="offset points", fontsize=7)
        axes.margins(x=0.12)
        dress(axes, front.name, "mean time, s", "rms, mm/s")
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
