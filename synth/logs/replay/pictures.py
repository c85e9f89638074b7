"""Pictures of a replay: what was measured over what was predicted, and own table beside the other."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from synth.frame.picture.house_style import BLUE, GREY, INK, VERMILLION, dress, legend_below, new_figure, place
from synth.logs.replay.replay import Replay

BINS = 10
TAILS = (0.002, 0.998)


def measured_over_predicted(found: Replay) -> Figure:
    """Density and ranks."""
    target = found.passes.log.target_m_s
    there = ~np.isnan(found.rank)
    measured = (found.measured.speed_m_s - target)[there]
    predicted = (found.fresh_m_s - target[:, None])[there].ravel()
    test = found.uniformity
    figure = new_figure(10.0, 4.6, "Measured exits over predicted ones", f"{test.n} passes, tables of the log")
    place(figure, left=0.8, right=0.3, bottom=0.95, top=0.9, w=0.25)
    density, ranks = figure.subplots(1, 2)
    dress(density, "Exit speed less target", "m/s", "density, s/m")
    low, high = np.quantile(np.concatenate([measured, predicted]), TAILS)
    edges = np.linspace(low, high, 41)
    density.hist(predicted, edges, density=True, histtype="step", color=BLUE, linewidth=1.5, label="predicted")
    density.hist(measured, edges, density=True, color=VERMILLION, alpha=0.35, label="measured")
    density.axvline(0.0, color=GREY, linewidth=1.0)
    dress(ranks, f"Rank among the predicted: p = {test.p_value:.2g}", "rank", "passes")
    ranks.hist(found.rank[there], np.linspace(0.0, 1.0, BINS + 1), color=VERMILLION, alpha=0.35)
    level = test.n / BINS
    reach = 1.96 * np.sqrt(level * (1.0 - 1.0 / BINS))
    ranks.axhline(level, color=BLUE, linewidth=1.5)
    for edge in (level - reach, level + reach):
        ranks.axhline(max(edge, 0.0), color=INK, linestyle=":", linewidth=1.2)
    legend_below(figure, density.get_legend_handles_labels()[0], columns=2)
    return figure


def own_and_other(found: Replay) -> Figure:
    """Bands over the passes."""
    target = found.passes.log.target_m_s[found.compared]
    order = np.argsort(found.own.mean_m_s[found.compared] - target)
    n = len(order)
    figure = new_figure(10.0, 4.8, "Predicted exits of the same cuts under both tables", f"{n} passes")
    place(figure, left=0.8, right=0.3, bottom=0.95, top=0.75)
    axes = figure.subplots()
    dress(axes, "mean and 80 % band", "passes, sorted by the mean under the tables of the log", "exit less target, m/s")
    for exits, colour, label in ((found.own, BLUE, "tables of the log"), (found.other, VERMILLION, "other tables")):
        mean = (exits.mean_m_s[found.compared] - target)[order]
        band = (exits.band_m_s[found.compared] - target[:, None])[order]
        axes.fill_between(np.arange(n), band[:, 0], band[:, 1], color=colour, alpha=0.25, linewidth=0.0, step="mid")
        axes.plot(np.arange(n), mean, ".", color=colour, markersize=3.0, label=label)
    axes.axhline(0.0, color=GREY, linewidth=1.0)
    legend_below(figure, axes.get_legend_handles_labels()[0], columns=2)
    return figure
