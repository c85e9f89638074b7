"""Pictures of the robustness study; one panel for each table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from scripts.studies.robustness.findings import CaseRow, EndsRow, OutcomeRow, Robustness, without_mass
from synth.present.plots.house_style import (
    BLUE,
    GREY,
    INK,
    LINE_COLOURS,
    LINE_MARKERS,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_x,
    logarithmic_y,
    new_figure,
    place,
)

SHOWN = 16
"""Parameters in a tornado."""


def tornado(cases: Sequence[CaseRow], limit_m_s: float) -> Figure:
    """Rms at −50 % and +50 % of the strongest parameters, the strongest on top, on a logarithmic axis."""
    figure = new_figure(17.5, 6.6, "One parameter wrong by half, the table unchanged", "rms of the exit speed error")
    place(figure, left=2.75, right=0.3, bottom=1.0, top=0.85, w=1.0)
    for axes, case in zip(figure.subplots(1, len(cases), squeeze=False)[0], cases, strict=True):
        shown, nominal = list(case.halves[:SHOWN]), case.nominal.rms_m_s
        dress(axes, f"{case.case}; nominal {nominal:.3f} m/s", "rms, m/s")
        for i, row in enumerate(shown):
            for outcome, place_y, colour in ((row.less, i - 0.19, BLUE), (row.more, i + 0.19, VERMILLION)):
                bar(axes, place_y, outcome, nominal, colour)
        axes.set_yticks(range(len(shown)), [name_of(row) for row in shown], fontsize=8)
        axes.set_ylim(len(shown) - 0.4, -0.6)
        marks(axes, nominal, limit_m_s)
        ends = [x for row in shown for y in (row.less, row.more) for x in y.rms_ci95_m_s]
        logarithmic_x(axes, [*ends, limit_m_s])
    legend_below(
        figure,
        [Patch(color=BLUE, label="−50 %"), Patch(color=VERMILLION, label="+50 %"), *mark_handles(limit_m_s),
         Line2D([], [], color=INK, lw=1.0, label="95 % interval")],
        5,
    )  # fmt: skip
    figure.text(0.01, 0.045, "*: not an assumed value", fontsize=8.5, color=INK)
    return figure


def name_of(row: EndsRow) -> str:
    """Label of a row; values with a source behind them are starred, clipped and zero values say what they became."""
    name = row.name + ("" if row.assumed else " *")
    clipped = any(outcome.note.startswith("clipped") for outcome in (row.less, row.more))
    return f"{name}: {row.values[0]:g}, {row.values[1]:g}" if clipped or row.nominal == 0.0 else name


def bar(axes: Axes, y: float, outcome: OutcomeRow, nominal_m_s: float, colour: str) -> None:
    """From the nominal rms to that of `outcome`, with its interval."""
    rms, interval = outcome.rms_m_s, outcome.rms_ci95_m_s
    axes.barh(y, rms - nominal_m_s, left=nominal_m_s, height=0.36, color=colour, zorder=2)
    axes.plot(interval, [y, y], color=INK, lw=1.0, zorder=3)


def marks(axes: Axes, nominal_m_s: float, limit_m_s: float) -> None:
    """Upright lines at the nominal rms and at the limit."""
    axes.axvline(nominal_m_s, color=INK, lw=0.9, zorder=3)
    axes.axvline(limit_m_s, color=GREY, lw=1.0, ls="--", zorder=1)


def mark_handles(limit_m_s: float) -> list[Line2D]:
    """Legend entries of `marks`."""
    return [
        Line2D([], [], color=INK, lw=0.9, label="nominal (upright line)"),
        Line2D([], [], color=GREY, lw=1.0, ls="--", label=f"acceptance limit {limit_m_s:g} m/s"),
    ]


def sweeps(cases: Sequence[CaseRow], limit_m_s: float) -> Figure:
    """Rms over the error of a parameter; hollow: tables tuned for the true value."""
    figure = new_figure(14.0, 5.4, "How fast accuracy goes when one parameter is wrong", "table unchanged")
    place(figure, left=0.75, right=0.2, bottom=1.25, top=0.85, w=0.22)
    handles: list[Line2D] = []
    for axes, case in zip(figure.subplots(1, len(cases), squeeze=False)[0], cases, strict=True):
        dress(axes, case.case, "true value against the assumed one, %", "rms, m/s")
        for i, swept in enumerate(case.sweeps):
            style: dict[str, Any] = {"color": LINE_COLOURS[i], "marker": LINE_MARKERS[i], "ms": 3.5}
            axes.plot([100.0 * x for x in swept.relative], swept.rms_m_s, lw=1.3, **style)
            hollow = {**style, "ms": 7, "ls": "", "mfc": "none"}
            axes.plot([100.0 * x for x, _ in swept.retuned], [rms for _, rms in swept.retuned], **hollow)
            if axes is figure.axes[0]:
                handles.append(Line2D([], [], lw=1.3, label=swept.name, **style))
        axes.axhline(limit_m_s, color=GREY, lw=1.0, ls="--", zorder=1)
        known = [rms for swept in case.sweeps for _, rms in swept.retuned]
        logarithmic_y(axes, [*known, *(rms for swept in case.sweeps for rms in swept.rms_m_s)])
    hollow_handle = Line2D([], [], color=INK, marker="o", ms=7, ls="", mfc="none", label="tuned for the true value")
    legend_below(figure, [*handles, hollow_handle, mark_handles(limit_m_s)[1]], 3)
    return figure


def all_together(cases: Sequence[CaseRow], limit_m_s: float) -> Figure:
    """Distribution of the rms over the points of the Latin hypercubes."""
    figure = new_figure(10.2, 5.2, "All assumed parameters wrong at once, the table unchanged")
    place(figure, left=0.8, right=3.2, bottom=0.65, top=0.75)
    axes = figure.subplots()
    dress(
        axes,
        f"Latin hypercube, uniform, {cases[0].together[0].passes} passes a point",
        "rms of the exit speed error, m/s",
        "share of the points below",
    )
    every: list[float] = []
    for i, case in enumerate(cases):
        for drawn, style in zip(case.together, ("-", "--"), strict=False):
            rms = np.sort(drawn.rms_m_s)
            every += rms.tolist()
            name = f"{case.case}, ±{100 * drawn.span:.0f} %, n = {len(rms)}"
            axes.step(rms, np.arange(1, len(rms) + 1) / len(rms), where="post", color=LINE_COLOURS[i], ls=style,
                      lw=1.4, label=name)  # fmt: skip
    axes.axvline(limit_m_s, color=GREY, lw=1.0, ls=":", label=f"limit {limit_m_s:g} m/s")
    logarithmic_x(axes, [float(np.quantile(every, 0.02)), max(every)])
    axes.set_ylim(0.0, 1.0)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
    return figure


def named_conditions(cases: Sequence[CaseRow], limit_m_s: float) -> Figure:
    """Rms under every named condition with its interval; hollow: a table tuned for that plant."""
    names = [without_mass(outcome.name) for outcome in cases[0].conditions]
    figure = new_figure(10.0, 0.29 * len(names) + 2.0, "Named conditions, the table unchanged", "95 % intervals")
    place(figure, left=3.3, right=0.25, bottom=1.1, top=0.75)
    axes = figure.subplots()
    dress(axes, "", "rms of the exit speed error, m/s")
    every, handles = [limit_m_s], []
    for i, case in enumerate(cases):
        style: dict[str, Any] = {"color": LINE_COLOURS[i], "marker": LINE_MARKERS[i]}
        handles.append(Line2D([], [], ls="", label=case.case, **style))
        for row, outcome in enumerate(case.conditions):
            y, best = row + 0.22 * (i - 0.5 * (len(cases) - 1)), outcome.retuned_rms_m_s
            axes.plot(outcome.rms_ci95_m_s, [y, y], lw=1.0, color=LINE_COLOURS[i])
            axes.plot([outcome.rms_m_s], [y], ms=4.5, **style)
            every += [*outcome.rms_ci95_m_s, best or outcome.rms_m_s]
            if best is not None:
                axes.plot([best], [y], ms=6, mfc="none", **style)
    axes.axvline(limit_m_s, color=GREY, lw=1.0, ls="--", zorder=1)
    axes.set_yticks(range(len(names)), names, fontsize=8)
    axes.set_ylim(len(names) - 0.4, -0.6)
    logarithmic_x(axes, every)
    tuned = Line2D([], [], color=INK, marker="o", ms=6, ls="", mfc="none", label="tuned for this plant")
    legend_below(figure, [*handles, tuned, mark_handles(limit_m_s)[1]], 3)
    return figure


def figures(found: Robustness) -> Mapping[str, Figure]:
    """`tornado`, `sweeps`, `together`, `conditions`."""
    return {
        "tornado": tornado(found.cases, found.limit_m_s),
        "sweeps": sweeps(found.cases, found.limit_m_s),
        "together": all_together(found.cases, found.limit_m_s),
        "conditions": named_conditions(found.cases, found.limit_m_s),
    }
