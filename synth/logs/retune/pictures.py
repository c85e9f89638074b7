"""Pictures of a retune: what is gained case by case, and lines before and after."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from synth.frame.picture.house_style import (
    BLUE,
    GREY,
    LINE_COLOURS,
    VERMILLION,
    dress,
    legend_below,
    new_figure,
    place,
)
from synth.logs.retune.retune import CaseGain, Retuned
from synth.solver.tabulate import lines_of

NODES = 201


def gains(found: Retuned) -> Figure:
    """Ratio by case."""
    n = len(found.gains)
    figure = new_figure(9.0, 1.9 + 0.24 * n, "New tables against old ones", f"{found.estimate.passes} measured passes")
    place(figure, left=1.9, right=0.4, bottom=0.6, top=0.85)
    axes = figure.subplots()
    dress(axes, "rms after / rms before, 95 % intervals", "ratio", "")
    for row, gain in enumerate(found.gains):
        low, high = gain.ratio_ci95
        better = gain in found.changed
        colour = BLUE if better else GREY
        axes.errorbar(
            [gain.ratio], [row], xerr=[[gain.ratio - low], [high - gain.ratio]], color=colour,
            marker="o" if better else "s", markersize=4.5, capsize=3,
        )  # fmt: skip
    axes.axvline(1.0, color=VERMILLION, linewidth=1.0)
    axes.set_yticks(range(n), [f"{gain.label} to {gain.target_m_s:g} m/s" for gain in found.gains])
    axes.set_ylim(n - 0.4, -0.6)
    return figure


def before_after(found: Retuned, gain: CaseGain) -> Figure:
    """Upper lines of both tables."""
    figure = new_figure(9.0, 4.8, "Switching lines before and after", f"{gain.label} to {gain.target_m_s:g} m/s")
    place(figure, left=0.8, right=0.3, bottom=0.95, top=0.9)
    axes = figure.subplots()
    dress(axes, "raise the stage above the line of the stage in force", "path of the first axle, m", "m/s")
    handles = []
    for table, style in ((found.old[gain.case], "--"), (found.new[gain.case], "-")):
        start, end = map(float, table.valid.s_m)
        lines = lines_of(table, np.linspace(start, end, NODES))
        for stage in range(len(table.stages) - 1):
            upper = lines.upper_m_s[stage]
            if not np.isfinite(upper).any():
                continue
            word = "before" if style == "--" else "after"
            handles += axes.plot(
                lines.nodes_m, upper, linestyle=style, color=LINE_COLOURS[stage % 7], label=f"stage {stage}, {word}"
            )
    legend_below(figure, handles, columns=4)
    return figure
