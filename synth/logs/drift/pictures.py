"""The charts of a watch: the sums that decide, with their limit; and the exits by category, which decide nothing."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from plant_models.frozen_arrays import Floats
from synth.frame.picture.house_style import (
    BLUE,
    GREY,
    INK,
    LINE_COLOURS,
    LINE_STYLES,
    VERMILLION,
    dress,
    new_figure,
    place,
)
from synth.logs.drift.charts import FEWEST, WINDOW, CategoryExits
from synth.logs.drift.watch import Watch

NAMED = 4
"""Charts that are told apart; of the others the highest is drawn."""

REACH = 5.0
"""Spreads of the errors that a panel of exits shows on both sides; farther ones stand at its edge."""

LEAST_REACH_M_S = 0.05

BEGINNING, ALARM = "beginning of the drift", "alarm"


def control_charts(found: Watch, title: str = "Charts of the watch") -> Figure:
    """All charts over the number of the pass; beginning and alarm of a drift are marked."""
    height, below = 3.0, 1.3 * len(found.exits)
    figure = new_figure(10.0, 1.5 + height + below, title, subject(found))
    place(figure, left=0.85, right=2.9, bottom=0.6, top=0.9, h=0.5)
    panels = figure.subplots(1 + len(found.exits), 1, squeeze=False, height_ratios=[height] + [1.3] * len(found.exits))
    draw_sums(panels[0, 0], found)
    reach = reach_m_s(found.exits)
    for axes, exits in zip(panels[1:, 0], found.exits, strict=True):
        draw_exits(axes, found, exits, reach)
    for axes in panels[:, 0]:
        axes.set_xlim(0, int(found.number_of[-1]) + 2)
        axes.tick_params(labelbottom=axes is panels[-1, 0])
        mark_drift(axes, found)
    panels[-1, 0].set_xlabel("pass", fontsize=9)
    for axes in panels[:2, 0]:
        handles = [each for each in axes.get_legend_handles_labels()[0] if axes is panels[0, 0] or not is_mark(each)]
        axes.legend(handles=handles, fontsize=8, loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False)
    return figure


def subject(found: Watch) -> str:
    """How many passes, and whether a sum reached the limit."""
    if found.drift is None:
        return f"{len(found.passes)} passes; no sum reaches the limit: no drift"
    alarm = int(found.number_of[found.drift.diagnosis.alarm]) + 1
    return f"{len(found.passes)} passes; a sum reaches the limit at pass {alarm}: something drifted"


def draw_sums(axes: Axes, found: Watch) -> None:
    """The sums until the cause has a name: afterwards they tell nothing new."""
    charts = found.charts
    until = len(found.number_of) if found.drift is None else found.drift.diagnosis.until + 1
    x, sums = found.number_of[:until] + 1, charts.sums[:until]
    title = "Sums that decide: an alarm is where one reaches the limit"
    dress(axes, title if found.drift is None else f"{title}; drawn until the cause has a name", "", "sum")
    order = np.argsort(-sums.max(axis=0), kind="stable").tolist()
    for rank, chart in enumerate(order[:NAMED]):
        k, size = charts.kinds[chart]
        cause = found.evidence.causes[k]
        axes.plot(x, sums[:, chart], color=LINE_COLOURS[rank], linestyle=LINE_STYLES[rank], linewidth=1.2, zorder=3,
                  label=f"{cause.name} {cause.told(size)}")  # fmt: skip
    if len(order) > NAMED:
        others = sums[:, order[NAMED:]]
        axes.plot(x, others.max(axis=1), color=GREY, linewidth=0.6, alpha=0.8,
                  label=f"highest of the other {others.shape[1]}")  # fmt: skip
    axes.axhline(charts.limit, color=INK, linestyle="--", linewidth=1.2, label=f"limit, {charts.limit:.1f}")
    axes.set_ylim(0.0, 1.15 * max(charts.limit, float(sums.max())))


def draw_exits(axes: Axes, found: Watch, exits: CategoryExits, reach: float) -> None:
    """Each pass and the running median, within ±`reach` m/s. No limit: nothing is decided here."""
    dress(axes, f"Exit speed less target, category {exits.category}", "", "m/s")
    x, error, full = found.number_of[exits.numbers] + 1, exits.errors_m_s, found.full_brake[exits.numbers]
    kinds = (
        (~full, ".", GREY, 3.0, "one pass"),
        (full, "^", VERMILLION, 5.0, "one pass, brake full to the end"),
    )  # fmt: skip
    for mine, marker, colour, size, label in kinds:
        for inside, face in ((True, colour), (False, "white")):
            some = mine & ((np.abs(error) <= reach) == inside)
            axes.plot(x[some], np.clip(error[some], -reach, reach), marker, color=colour, markersize=size,
                      markerfacecolor=face, linestyle="", clip_on=False, zorder=3 if marker == "^" else 2,
                      label=label if inside else None)  # fmt: skip
    axes.plot(x, exits.medians_m_s, color=BLUE, linewidth=1.4, zorder=4, label=f"median of the last {WINDOW}")
    axes.set_ylim(-reach, reach)
    beyond = int((np.abs(error) > reach).sum())
    if beyond:
        axes.text(1.01, 0.04, f"{beyond} beyond the panel", transform=axes.transAxes, fontsize=8, color=INK)


def reach_m_s(exits: tuple[CategoryExits, ...]) -> float:
    """One for all panels: it shows the bulk of the passes and all medians."""
    spreads = [REACH * spread_of(each.errors_m_s) for each in exits]
    medians = [1.2 * float(np.abs(each.medians_m_s[FEWEST - 1 :]).max(initial=0.0)) for each in exits]
    return max([LEAST_REACH_M_S, *spreads, *medians])


def spread_of(errors: Floats) -> float:
    """Standard deviation by the quartiles, which few large errors do not move."""
    low, high = np.quantile(errors, [0.25, 0.75])
    return float(high - low) / 1.3489795


def mark_drift(axes: Axes, found: Watch) -> None:
    """Beginning dotted, alarm solid."""
    if found.drift is None:
        return
    diagnosis = found.drift.diagnosis
    begin, alarm = (float(found.number_of[each] + 1) for each in (diagnosis.first.begin, diagnosis.alarm))
    axes.axvline(begin, color=INK, linestyle=":", linewidth=1.2, label=BEGINNING)
    axes.axvline(alarm, color=INK, linewidth=1.0, label=ALARM)


def is_mark(handle: Artist) -> bool:
    """Whether a legend has it from `mark_drift`: all panels have the same marks."""
    return handle.get_label() in (BEGINNING, ALARM)
