"""The control charts of a watch: sums with their limit, and moving means of the exit errors."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from synth.present.plots.house_style import (
    GREY,
    INK,
    LINE_COLOURS,
    LINE_STYLES,
    PALE_GREY,
    dress,
    new_figure,
    place,
)
from synth.yard.measured_passes.drift.watch import Watch

NAMED = 4
"""Charts that are told apart; the others are grey."""


def control_charts(found: Watch) -> Figure:
    """All charts over the number of the pass; beginning and alarm of a drift are marked."""
    means = found.moving_means
    figure = new_figure(9.0, 4.0 + 1.4 * len(means), "Watch on drift", f"{len(found.passes)} passes")
    place(figure, left=0.8, right=2.5, bottom=0.6, top=0.85, h=0.62)
    panels = figure.subplots(1 + len(means), 1, squeeze=False, height_ratios=[2.5] + [1.0] * len(means))
    draw_sums(panels[0, 0], found)
    for number, mean in enumerate(means):
        axes, x = panels[number + 1, 0], found.number_of[mean.numbers] + 1
        dress(axes, f"exit speed less target, category {mean.category}", y="m/s")
        axes.fill_between(x, mean.low, mean.high, color=PALE_GREY, linewidth=0.0)
        axes.axhline(mean.centre, color=GREY, linewidth=0.7)
        axes.plot(x, mean.means, color=LINE_COLOURS[0], linewidth=1.2)
    for axes in panels[1:, 0]:
        axes.sharex(panels[-1, 0])
    panels[-1, 0].set_xlabel("pass", fontsize=9)
    for axes in panels[:, 0]:
        mark_drift(axes, found)
    return figure


def draw_sums(axes: Axes, found: Watch) -> None:
    """The sums until the cause has a name: afterwards they tell nothing new. The highest ones are in the legend."""
    charts = found.charts
    until = len(found.number_of) if found.drift is None else found.drift.diagnosis.until + 1
    x, sums = found.number_of[:until] + 1, charts.sums[:until]
    title = "sum of each chart, and the limit"
    dress(axes, title if found.drift is None else f"{title}, until the cause has a name", "pass", "S")
    order = np.argsort(-sums.max(axis=0), kind="stable")
    for rank, chart in reversed(list(enumerate(order.tolist()))):
        k, size = charts.kinds[chart]
        cause = found.evidence.causes[k]
        if rank < NAMED:
            axes.plot(x, sums[:, chart], color=LINE_COLOURS[rank], linestyle=LINE_STYLES[rank], linewidth=1.2,
                      label=f"{cause.name} {cause.told(size)}")  # fmt: skip
        else:
            axes.plot(x, sums[:, chart], color=GREY, linewidth=0.4, alpha=0.6)
    axes.axhline(charts.limit, color=INK, linestyle="--", linewidth=1.0)
    axes.set_ylim(0.0, 2.0 * charts.limit)
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::-1], labels[::-1], fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)


def mark_drift(axes: Axes, found: Watch) -> None:
    """Beginning dotted, alarm solid."""
    if found.drift is None:
        return
    diagnosis = found.drift.diagnosis
    axes.axvline(float(found.number_of[diagnosis.first.begin] + 1), color=INK, linestyle=":", linewidth=1.2)
    axes.axvline(float(found.number_of[diagnosis.alarm] + 1), color=INK, linewidth=1.0)
