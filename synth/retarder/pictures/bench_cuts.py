"""Exit errors of the cuts of a bench: a mark for the controller, and one for the table on the same cut."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from synth.frame.picture.house_style import BLUE, INK, dress, legend_below, new_figure, place


def bench_cuts(errors_m_s: Sequence[float], by_table_m_s: Sequence[float]) -> Figure:
    """Errors of n cuts, in the order in which they came."""
    figure = new_figure(8.0, 3.4, "Exit errors on the bench")
    place(figure, left=0.85, right=0.2, bottom=0.95, top=0.5)
    axes = figure.subplots()
    counts = range(1, len(errors_m_s) + 1)
    axes.axhline(0.0, color=INK, linewidth=0.6)
    axes.plot(counts, errors_m_s, color=BLUE, marker="o", markersize=4, linestyle="", label="the controller")
    axes.plot(counts, by_table_m_s, color=INK, marker="x", markersize=7, linestyle="", label="the table, simulated")
    dress(axes, "", "cut", "exit speed − target, m/s")
    legend_below(figure, axes.get_legend_handles_labels()[0], columns=2)
    return figure
