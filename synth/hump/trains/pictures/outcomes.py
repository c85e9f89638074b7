"""What trains came to: catch-ups by element on the track plan; the speeds with which cuts couple, and the gaps of those
that do not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.typing import LineStyleType

from plant_models.frozen_arrays import Floats, Ints
from plant_models.hump import HumpGraph, Retarder, Signal, Switch
from plant_models.library.hump_entry import HumpEntry
from synth.frame.picture.house_style import (
    BLUE,
    INK,
    ORANGE,
    PURPLE,
    VERMILLION,
    dress,
    legend_below,
    mark_plainly,
    new_figure,
    place,
)
from synth.frame.printed_numbers import counted
from synth.hump.configuration.sections import CouplingLimits
from synth.hump.hump_picture import ROW_IN, TALLEST_PLAN_IN, WIDTH_IN, draw_plan, plan_legend
from synth.hump.plan_layout import PlanLayout, plan_layout
from synth.hump.rolling.outcomes import GAP_BINS_M, SPEED_BINS_M_S, USUAL_COUPLINGS, TrainOutcomes

SMALLEST, LARGEST = 75.0, 175.0
"""Areas of the discs of the rarest and the most frequent element, square points."""

DARK = 0.6
"""Of the scale of colours, from where on figures are white."""


def catch_ups(hump: HumpEntry, counts: Mapping[int, int], cuts: int, what: str = "catch-ups") -> Figure:
    """`counts` of what happened to `cuts` cuts, by the number of the element; elements without any have no disc."""
    layout = plan_layout(hump.graph)
    some = {number: count for number, count in counts.items() if count > 0}
    total = sum(some.values())
    plan_in = min(max(1.8, ROW_IN * (len(layout.row) + 2)), TALLEST_PLAN_IN)
    share = f", {100.0 * total / cuts:.3g} in 100 cuts" if cuts else ""
    figure = new_figure(
        WIDTH_IN,
        plan_in + 2.2,
        f"Where {what} happen: {hump.title}",
        f"{what.capitalize()}: {total}{share}; {counted(cuts, 'cut')} humped. The figure in a disc is the count.",
    )
    place(figure, 0.75, 1.1, 1.0, 0.85)
    axes = figure.subplots()
    dress(axes, "Along in metres from the crest, across not to scale", "metres from the crest")
    draw_plan(axes, hump.graph, layout, unnumbered=some)
    if some:
        discs = draw_discs(axes, some, hump.graph, layout)
        bar = figure.colorbar(discs, ax=axes, pad=0.045, fraction=0.02)
        bar.set_label(f"{what} at the element", fontsize=8.5)
        bar.ax.tick_params(labelsize=8)
        mark_plainly(bar.ax.yaxis, 1.0, float(max(2, *some.values())))
    # tracks go on far behind their last element, where nothing happens
    ends_m = max(layout.at[vertex.number][0] for vertex in hump.graph.vertices)
    upto_m = min(ends_m + 0.15 * ends_m, max(layout.end_m.values()))
    for track, row in layout.row.items():
        axes.annotate(
            hump.graph.track_called(track), (upto_m, row), (4, 0), textcoords="offset points", va="center", fontsize=7
        )
    axes.set_xlim(-0.03 * upto_m, upto_m)
    legend_below(figure, plan_legend(), columns=7)
    return figure


def draw_discs(axes: Axes, counts: Mapping[int, int], graph: HumpGraph, layout: PlanLayout) -> PathCollection:
    """A disc for each element, its count inside; the number of a switch above, that of a retarder is on the plan."""
    most = max(counts.values())
    norm = LogNorm(1.0, max(most, 2))
    numbers = sorted(counts, key=lambda number: (counts[number], number))
    found = np.array([counts[number] for number in numbers], dtype=float)
    places = np.array([disc_m(graph, layout, number) for number in numbers])
    areas = SMALLEST + (LARGEST - SMALLEST) * np.sqrt(found / most)
    discs = axes.scatter(
        places[:, 0], places[:, 1], areas, found, cmap=colormaps["YlOrRd"], norm=norm, edgecolor=INK, linewidth=0.6,
        zorder=8,
    )  # fmt: skip
    for number, place_m, count, area in zip(numbers, places, found, areas, strict=True):
        ink = "white" if norm(count) > DARK else INK
        x, y = place_m
        axes.text(x, y, f"{count:.0f}", ha="center", va="center", fontsize=6.5, color=ink, zorder=9)
        if isinstance(graph.vertex(number), Retarder):
            continue
        above = (0.0, 0.5 * np.sqrt(area) + 1.0)
        axes.annotate(
            graph.called(number), (x, y), above, textcoords="offset points", ha="center", fontsize=6.5, zorder=9
        )
    return discs


def disc_m(graph: HumpGraph, layout: PlanLayout, number: int) -> tuple[float, float]:
    """Place of the disc: at the points of a switch, at the end of a retarder, in the middle of a section."""
    vertex, (x, y) = graph.vertex(number), layout.at[number]
    if isinstance(vertex, Switch | Signal) or vertex.next.to is None:
        return x, y
    behind = vertex.exit_m if isinstance(vertex, Retarder) else 0.5 * vertex.length_m
    to_x, to_y = layout.at[vertex.next.to]
    return x + behind, y + behind * (to_y - y) / (to_x - x)


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
