"""Predicted exit-speed density over the simulated histogram: two independent computations of one thing."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from synth.frame.picture.house_style import (
    GREY,
    INK,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    logarithmic_y,
    new_figure,
    place,
)
from synth.problem.aim import OVERSPEED_M_S
from synth.retarder.exit_bins import bin_edges_m_s, predicted_density, prediction_origin
from synth.retarder.tuned_case import TunedCase

LEAST = 1e-4
"""Bottom of the logarithmic panel, 1/(m/s): one cut in 100 000 in a wide bin."""


def exit_density(cases: Sequence[TunedCase]) -> Figure:
    """One column for each of these cases of one class: density in 1/(m/s) over exit speed in m/s, near the target, and
    its tails logarithmically."""
    columns = len(cases)
    figure = new_figure(3.9 * columns + 0.7, 6.4, "Exit speed, predicted and simulated", cases[0].cut_name)
    in_legend = min(4, 2 * columns)  # beside each other: a single panel is narrow
    place(figure, left=0.8, right=0.2, bottom=0.75 + 0.2 * math.ceil(4 / in_legend), top=1.25, w=0.2, h=0.22)
    panels = figure.subplots(2, columns, squeeze=False)
    for column, each in enumerate(cases):
        draw_case(panels[0, column], panels[1, column], each)
    panels[0, 0].set_ylabel("density, 1/(m/s)", fontsize=9)
    panels[1, 0].set_ylabel("the same, logarithmic", fontsize=9)
    handles = [
        Patch(facecolor=SKY, label="simulated passes"),
        Line2D([], [], color=VERMILLION, linewidth=1.4, label=prediction_origin(cases)),
        Line2D([], [], color=INK, linewidth=1.2, label="target"),
        Line2D([], [], color=GREY, linewidth=1.2, linestyle="--", label=f"target ± {OVERSPEED_M_S:g} m/s"),
    ]
    legend_below(figure, handles, columns=in_legend)
    return figure


def draw_case(near: Axes, tails: Axes, case: TunedCase) -> None:
    """Both panels of one case."""
    target, speeds, share = case.target_speed_m_s, case.exit_speeds_m_s, case.exit_weight / case.exit_weight.sum()
    speed, predicted = predicted_density(case.predicted)
    edges = bin_edges_m_s(target, float(max(speeds.max(initial=0.0), speed[-1])))
    moving = speeds > 0.0
    simulated = np.histogram(speeds[moving], edges, weights=share[moving])[0] / np.diff(edges)
    dress(near, panel_title(case))
    dress(tails, x="exit speed, m/s")
    told = predicted > LEAST
    shown = np.concatenate((speed[told], edges[1:][simulated > LEAST], edges[:-1][simulated > LEAST]))
    if not shown.size:
        near.text(0.5, 0.5, "no pass leaves the position", transform=near.transAxes, ha="center", fontsize=9)
        return
    for axes in (near, tails):
        axes.stairs(simulated, edges, fill=True, color=SKY, linewidth=0)
        axes.plot(speed, np.where(told, predicted, np.nan), color=VERMILLION, linewidth=1.3)
        axes.axvline(target, color=INK, linewidth=1.0)
        for mark in (target - OVERSPEED_M_S, target + OVERSPEED_M_S):
            axes.axvline(mark, color=GREY, linewidth=1.0, linestyle="--")
    highest, far = max(float(predicted.max()), float(simulated.max())), 1.2 * OVERSPEED_M_S
    near.set(xlim=(target - far, target + far), ylim=(0.0, 1.08 * highest))
    tails.set_xlim(min(target - far, float(shown.min())), max(target + far, float(shown.max())))
    logarithmic_y(tails, (1.25 * LEAST, 2.0 * highest))


def panel_title(case: TunedCase) -> str:
    """Target, both rms with the interval of the simulated one, stalls if there are any."""
    found = case.statistics
    lines = [
        f"target {case.target_speed_m_s:g} m/s",
        f"predicted rms {case.table.predicted.rms_m_s:.4f} m/s",
        f"simulated {found.rms_text}",
    ]
    if found.stalled:
        lines[0] += f" · {found.stalled:.2%} of the passes stopped"
    return "\n".join(lines)
