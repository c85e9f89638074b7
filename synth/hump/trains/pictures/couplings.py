"""How cuts end: the speeds with which they couple, and the gaps of those that do not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.typing import LineStyleType

from plant_models.frozen_arrays import Floats, Ints
from synth.frame.picture.house_style import (
    BLUE,
    INK,
    ORANGE,
    PURPLE,
    VERMILLION,
    dress,
    legend_below,
    new_figure,
    place,
)
from synth.frame.printed_numbers import counted
from synth.hump.configuration.coupling_limits import CouplingLimits
from synth.hump.trains.outcomes import GAP_BINS_M, SPEED_BINS_M_S, USUAL_COUPLINGS, TrainOutcomes

CLASS_LINES: tuple[tuple[str, LineStyleType], ...] = ((ORANGE, "-"), (VERMILLION, "--"), (PURPLE, "-."))
"""Of where each class of over-speeds begins."""

LAST_BIN = "the last bin also holds what is beyond"


def couplings(found: TrainOutcomes, limits: CouplingLimits = USUAL_COUPLINGS) -> Figure:
    """Histograms of both; the classes of over-speed with the share of cuts in each."""
    judged = int(found.judged.sum())
    speeds, gaps = found.speed_bins.sum(axis=0), found.gap_bins.sum(axis=0)
    figure = new_figure(
        11.0,
        5.0,
        "Coupling speeds and gaps",
        f"Of {counted(judged, 'cut')} that reached a track undisturbed, {speeds.sum()} coupled, {gaps.sum()} left a "
        f"gap, {judged - speeds.sum() - gaps.sum()} did neither; "
        f"{found.gap_m.sum() / max(judged, 1):.1f} m of gap a cut",
    )
    place(figure, left=0.7, right=0.25, bottom=1.3, top=0.9, w=0.24)
    of_speeds, of_gaps = figure.subplots(1, 2)
    dress(of_speeds, "Cuts that coupled", "coupling speed, m/s", "cuts")
    draw_bins(of_speeds, speeds, SPEED_BINS_M_S)
    handles = draw_classes(of_speeds, found, limits.classes_m_s)
    dress(of_gaps, "Cuts that left a gap", "gap to the standing cars, m", "cuts")
    draw_bins(of_gaps, gaps, GAP_BINS_M)
    legend_below(figure, handles, columns=1)
    return figure


def draw_bins(axes: Axes, counts: Ints, edges: Floats) -> None:
    """Bars up to the last bin that has any; empty bins behind it are left out."""
    if not counts.any():
        axes.text(0.5, 0.5, "none", transform=axes.transAxes, ha="center", va="center", fontsize=11, color=INK)
        return
    last = int(np.flatnonzero(counts)[-1])
    axes.bar(edges[:-1], counts, np.diff(edges), align="edge", color=BLUE, edgecolor="white", linewidth=0.3, zorder=3)
    axes.set_xlim(0.0, edges[last + 1] * 1.04)
    if last == len(counts) - 1:
        axes.annotate(LAST_BIN, (0.98, 0.97), xycoords="axes fraction", ha="right", va="top", fontsize=7, color=INK)


def draw_classes(axes: Axes, found: TrainOutcomes, classes_m_s: Sequence[float]) -> list[Artist]:
    """A line at each bound; returned: what they mean."""
    judged, over = max(int(found.judged.sum()), 1), found.overspeed.sum(axis=0)
    axes.set_xlim(right=max(axes.get_xlim()[1], 1.1 * classes_m_s[-1]))
    handles: list[Artist] = []
    uppers = [f", to {high:.3g} m/s" for high in classes_m_s[1:]] + [" m/s"]
    for low, upper, count, (colour, style) in zip(classes_m_s, uppers, over, CLASS_LINES, strict=True):
        axes.axvline(low, color=colour, linestyle=style, linewidth=1.4, zorder=4)
        label = f"right of it: above {low:.3g}{upper}: {counted(int(count), 'cut')}, {100.0 * count / judged:.2f} %"
        handles.append(Line2D([], [], color=colour, linestyle=style, linewidth=1.4, label=label))
    return handles
