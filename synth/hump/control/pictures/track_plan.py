"""The track plan of a hump: switches with numbers, retarders, insulated sections, tracks, standing cars."""

from __future__ import annotations

from collections.abc import Container

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from plant_models.hump import HumpGraph, Retarder, Switch, TrackSection
from synth.frame.picture.house_style import BLACK, BLUE, GREY, INK, ORANGE, SKY, VERMILLION
from synth.hump.control.pictures.plan_layout import PlanLayout

RAIL_WIDTH, ELEMENT_WIDTH = 0.8, 4.5
MOST_NUMBERED = 64
"""Of the elements of a kind, whose numbers are still legible."""


def draw_plan(axes: Axes, graph: HumpGraph, layout: PlanLayout, unnumbered: Container[int] = ()) -> None:
    """Draw the plan into `axes`, which are dressed already; x in metres from the crest. `unnumbered`: switches that go
    without their numbers."""
    for vertex in graph.vertices:
        x, y = layout.at[vertex.number]
        for edge in vertex.edges:
            if edge.to is not None:
                to_x, to_y = layout.at[edge.to]
                axes.plot([x, to_x], [y, to_y], color=INK, linewidth=RAIL_WIDTH, zorder=2)
    for section in graph.sections:
        x, y = layout.at[section.number]
        if section.is_last:
            draw_track(axes, section, layout, graph)
        else:
            axes.plot([x, x + section.length_m], [y, y], color=SKY, linewidth=2.5, zorder=3)
    for each in graph.retarders:
        draw_retarder(axes, each, layout)
    for each_switch in graph.switches:
        draw_switch(axes, each_switch, layout)
        if len(graph.switches) <= MOST_NUMBERED and each_switch.number not in unnumbered:
            number_switch(axes, each_switch.number, layout, graph)
    for signal in graph.signals:
        x, y = layout.at[signal.number]
        axes.plot([x], [y], marker="o", color=VERMILLION, markersize=5, zorder=5)
        axes.annotate(
            str(signal.number), (x, y), (-4, 0), textcoords="offset points", ha="right", va="center", fontsize=7
        )
    axes.set_ylim(max(layout.row.values()) + 1.0, -1.0)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.grid(False, axis="y")


def draw_track(axes: Axes, section: TrackSection, layout: PlanLayout, graph: HumpGraph) -> None:
    """A classification track with its number and name, and the cars that stand on it."""
    (x, y), assigned = layout.at[section.number], section.track
    assert assigned is not None
    end = x + section.length_m
    axes.plot([x, end], [y, y], color=INK, linewidth=RAIL_WIDTH, zorder=2)
    axes.plot([end, end], [y - 0.25, y + 0.25], color=INK, linewidth=RAIL_WIDTH, zorder=2)
    if section.standing_m > 0.0:
        axes.plot([end - section.standing_m, end], [y, y], color=GREY, linewidth=4.0, solid_capstyle="butt", zorder=3)
    axes.annotate(graph.track_called(assigned), (end, y), (4, 0), textcoords="offset points", va="center", fontsize=7)


def draw_retarder(axes: Axes, retarder: Retarder, layout: PlanLayout) -> None:
    """The braking zones of a retarder on its edge, with its number and name."""
    (x, y), (to_x, to_y) = layout.at[retarder.number], layout.at[retarder.next.to or retarder.number]
    slope = (to_y - y) / (to_x - x)
    for begin, end in retarder.zones_m:
        ends = [x + begin, x + end], [y + slope * begin, y + slope * end]
        axes.plot(*ends, color=BLUE, linewidth=ELEMENT_WIDTH, solid_capstyle="butt", zorder=4)
    for text, offset, hangs in ((str(retarder.number), 3, "bottom"), (retarder.name or "", -4, "top")):
        axes.annotate(text, (x, y), (0, offset), textcoords="offset points", fontsize=5.5, color=BLUE, va=hangs)


def draw_switch(axes: Axes, switch: Switch, layout: PlanLayout) -> None:
    """The points of a switch, its insulated section and the fouling points behind it."""
    x, y = layout.at[switch.number]
    axes.plot([x - switch.entry_joint_m, x], [y, y], color=ORANGE, linewidth=2.0, solid_capstyle="butt", zorder=3)
    for branch in switch.branches:
        assert branch.edge.to is not None
        to_x, to_y = layout.at[branch.edge.to]
        slope = (to_y - y) / (to_x - x)
        joint = switch.exit_joint_m
        axes.plot([x, x + joint], [y, y + slope * joint], color=ORANGE, linewidth=2.0, solid_capstyle="butt", zorder=3)
        if branch.fouling_m <= to_x - x:
            fouling = x + branch.fouling_m, y + slope * branch.fouling_m
            axes.plot(*[[place] for place in fouling], marker="|", color=GREY, markersize=4, zorder=3)
    axes.plot([x], [y], marker=".", color=BLACK, markersize=4, zorder=5)


def number_switch(axes: Axes, number: int, layout: PlanLayout, graph: HumpGraph) -> None:
    """The number of a switch, on that side of the points where no track comes from; its name on the other side."""
    x, y = layout.at[number]
    from_above = any(layout.at[ahead][1] < y for ahead in graph.network.predecessors(number))
    up, hangs, other = (-1, "top", "bottom") if from_above else (1, "bottom", "top")
    name = graph.names.get(number, "")
    for text, size, offset, side in ((str(number), 6.5, 2 * up, hangs), (name, 5.5, -4 * up, other)):
        axes.annotate(
            text, (x, y), (-2, offset), textcoords="offset points", ha="right", va=side, fontsize=size, zorder=6
        )


def plan_legend() -> list[Artist]:
    """What the marks of the plan mean."""
    return [
        Line2D([], [], color=VERMILLION, marker="o", markersize=5, linestyle="none", label="signal"),
        Line2D([], [], color=BLACK, marker=".", markersize=6, linestyle="none", label="points of a switch"),
        Line2D([], [], color=ORANGE, linewidth=2.0, label="insulated section of a switch"),
        Line2D([], [], color=SKY, linewidth=2.5, label="other section"),
        Line2D([], [], color=GREY, marker="|", markersize=6, linestyle="none", label="fouling point"),
        Line2D([], [], color=BLUE, linewidth=ELEMENT_WIDTH, label="retarder"),
        Line2D([], [], color=GREY, linewidth=4.0, label="standing cars"),
    ]
