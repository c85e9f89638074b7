"""Predicted exit-speed density over the simulated histogram: two independent computations of one thing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from synth.plots.case_names import contest, cut_name
from synth.plots.house_style import GREY, INK, SKY, VERMILLION, dress, legend_below, logarithmic_y, new_figure, place
from synth.simulation.exit_statistics import OVERSPEED_M_S
from synth.tuning.case_result import CaseResult

ONE_PASS = 0.4
"""Bottom of the logarithmic panel: this share of the density that one simulated pass in a cell stands for."""


def exit_density(cases: Sequence[CaseResult]) -> Figure:
    """One column a case: density in 1/(m/s) over exit speed in m/s, near the target, and its tails logarithmically."""
    columns = len(cases)
    figure = new_figure(3.9 * columns + 0.7, 6.4, "Exit speed, predicted and simulated", cut_name(cases[0]))
    place(figure, left=0.65, right=0.2, bottom=0.95, top=1.25, w=0.17, h=0.22)
    panels = figure.subplots(2, columns, squeeze=False)
    for column, case in enumerate(cases):
        draw_case(panels[0, column], panels[1, column], case)
    panels[0, 0].set_ylabel("density, 1/(m/s)", fontsize=9)
    panels[1, 0].set_ylabel("the same, logarithmic", fontsize=9)
    handles = [
        Patch(facecolor=SKY, label="simulated passes"),
        Line2D(
            [],
            [],
            color=VERMILLION,
            marker="o",
            markersize=3,
            linewidth=1.4,
            label=prediction_origin(cases),
        ),
        Line2D([], [], color=INK, linewidth=1.2, label="target"),
        Line2D([], [], color=GREY, linewidth=1.2, linestyle="--", label=f"target ± {OVERSPEED_M_S:g} m/s"),
    ]
    legend_below(figure, handles, columns=min(len(handles), 2 * columns))  # a single panel is narrow
    return figure


def prediction_origin(cases: Sequence[CaseResult]) -> str:
    """What the predicted densities come from, in a legend or a caption."""
    estimated = [case.table.estimator is not None for case in cases]
    if all(estimated):
        return "predicted from other simulated passes"
    exact = "predicted by the forward equation"
    return f"{exact}; with an estimator from other simulated passes" if any(estimated) else exact


def draw_case(near: Axes, tails: Axes, case: CaseResult) -> None:
    """Both panels of one case."""
    target, moving = case.target_speed_m_s, case.exit_speeds_m_s[case.exit_speeds_m_s > 0.0]
    speed, edges = case.predicted.speed_m_s[1:], cell_edges_m_s(case.predicted.speed_m_s)
    predicted = case.predicted.probability[1:] / np.diff(edges)
    weight = case.exit_weight[case.exit_speeds_m_s > 0.0] / case.exit_weight.sum()
    simulated = np.histogram(moving, edges, weights=weight)[0] / np.diff(edges)
    dress(near, panel_title(case))
    dress(tails, x="exit speed, m/s")
    floor = ONE_PASS / (case.exit_speeds_m_s.size * float(np.diff(edges)[speed > 0.5 * target].max()))
    seen = np.flatnonzero(np.maximum(predicted, simulated) > floor)
    if not seen.size:
        near.text(0.5, 0.5, "no pass leaves the position", transform=near.transAxes, ha="center", fontsize=9)
        return
    shown = slice(int(seen[0]), int(seen[-1]) + 1)
    visible = np.where(predicted > floor, predicted, np.nan)
    for axes, line in ((near, predicted), (tails, visible)):
        axes.stairs(simulated[shown], edges[shown.start : shown.stop + 1], fill=True, color=SKY, linewidth=0)
        axes.plot(speed[shown], line[shown], "-o", color=VERMILLION, markersize=2.4, linewidth=1.3)
        axes.axvline(target, color=INK, linewidth=1.0)
        for mark in (target - OVERSPEED_M_S, target + OVERSPEED_M_S):
            axes.axvline(mark, color=GREY, linewidth=1.0, linestyle="--")
    highest = max(float(predicted.max()), float(simulated.max()))
    close = float(np.clip(1.5 * contest(case).table.statistics.p99_m_s, 0.1, 1.2 * OVERSPEED_M_S))
    near.set(xlim=(target - close, target + close), ylim=(0.0, 1.08 * highest))
    far = 1.2 * OVERSPEED_M_S
    tails.set_xlim(min(target - far, float(edges[shown.start])), max(target + far, float(edges[shown.stop])))
    logarithmic_y(tails, (1.25 * floor, 2.0 * highest))


def panel_title(case: CaseResult) -> str:
    """Target, both rms with the interval of the simulated one, stalls if there are any."""
    table = contest(case).table
    low, high = table.statistics.rms_ci95_m_s
    lines = [
        f"target {case.target_speed_m_s:g} m/s",
        f"predicted rms {table.predicted_rms_m_s:.3f} m/s",
        f"simulated rms {table.statistics.rms_m_s:.3f} [{low:.3f}, {high:.3f}] m/s",
    ]
    if table.statistics.stalled:
        lines[0] += f" · {table.statistics.stalled:.2%} of the passes stopped"
    return "\n".join(lines)


def cell_edges_m_s(speed_m_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Edges of the energy cells above the lowest one, as speeds; `speed_m_s` (E,) is even in v²/2."""
    energy = 0.5 * speed_m_s**2
    half = 0.5 * (energy[1] - energy[0])
    edges: NDArray[np.float64] = np.sqrt(2.0 * (np.append(energy[1:] - half, energy[-1] + half)))
    return edges
