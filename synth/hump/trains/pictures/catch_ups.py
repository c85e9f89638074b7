"""Where catch-ups happen: their counts by element on the track plan."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from plant_models.hump import HumpGraph, Retarder, Signal, Switch
from plant_models.library.hump_entry import HumpEntry
from synth.frame.picture.house_style import INK, dress, legend_below, mark_plainly, new_figure, place
from synth.frame.printed_numbers import counted
from synth.hump.control.pictures.hump_picture import ROW_IN, TALLEST_PLAN_IN, WIDTH_IN
from synth.hump.control.pictures.plan_layout import PlanLayout, plan_layout
from synth.hump.control.pictures.track_plan import draw_plan, plan_legend

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
