"""A hump as its designers draw it: the track plan with switches, retarders, insulated sections, tracks and standing
cars, and below it the profile of one route with speed heads.
"""

from __future__ import annotations

from collections.abc import Container, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from plant_models.hump import HumpGraph, Retarder, Route, Switch, TrackSection
from plant_models.library.hump_entry import HumpEntry
from synth.frame.picture.house_style import (
    BLACK,
    BLUE,
    GREY,
    INK,
    LINE_COLOURS,
    LINE_STYLES,
    ORANGE,
    PALE_GREY,
    SKY,
    VERMILLION,
    dress,
    legend_below,
    new_figure,
    place,
)
from synth.hump.design_runners import RunnerRoll
from synth.hump.plan_layout import PlanLayout, plan_layout

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


WIDTH_IN, ROW_IN, PROFILE_IN = 13.0, 0.19, 3.4
TALLEST_PLAN_IN = 20.0
SHORTEST_TOLD_M = 12.0
"""Elements of the profile that are shorter go without their figure."""


def hump_picture(hump: HumpEntry, route: Route, rolls: Sequence[RunnerRoll]) -> Figure:
    """Plan and profile on one axis of metres from the crest; `rolls`: runners without brakes over `route`."""
    layout = plan_layout(hump.graph)
    plan_in = min(max(1.8, ROW_IN * (len(layout.row) + 2)), TALLEST_PLAN_IN)
    height = plan_in + PROFILE_IN + 2.25
    leads = "s" if len(hump.graph.leads) > 1 else ""
    subject = (
        f"tracks: {len(hump.graph.tracks)}; switches: {len(hump.graph.switches)}; retarder positions: "
        f"{len(hump.graph.retarders)}; signal{leads} {' and '.join(map(str, hump.graph.leads))} at the crest{leads}"
    )
    figure = new_figure(WIDTH_IN, height, hump.title, subject)
    plan, profile = figure.subplots(2, 1, sharex=True, height_ratios=[plan_in, PROFILE_IN])
    place(figure, 0.75, 0.45, 1.3, 0.8, h=0.6 / ((plan_in + PROFILE_IN) / 2.0))
    dress(plan, "Track plan; along in metres from the crest, across not to scale")
    draw_plan(plan, hump.graph, layout)
    plan.tick_params(labelbottom=True)
    track, code = hump.graph.track_called(route.track), route.code or "none"
    title = f"Route to track {track}, code {code}: height, and energy head of cars without brakes"
    dress(profile, title, "metres from the crest", "m above the crest")
    draw_profile(profile, route, rolls)
    profile.set_xlim(-0.03 * route.length_m, 1.01 * max(layout.end_m.values()))
    legend_below(figure, plan_legend(), columns=7, bottom_in=0.5)
    legend_below(figure, profile_legend(rolls), columns=2)
    return figure


def draw_profile(axes: Axes, route: Route, rolls: Sequence[RunnerRoll]) -> None:
    """The track's height, the grade of each element, and the energy heads; their distance is the speed head."""
    track = route.roll_track
    breaks = np.asarray(track.breaks_m)
    axes.plot(breaks, -track.fall_m(breaks), color=INK, linewidth=1.6, zorder=4)
    lowest = float(-track.fall_m(breaks).max())
    axes.vlines(breaks, lowest - 0.05 * abs(lowest), -track.fall_m(breaks), color=PALE_GREY, linewidth=0.6, zorder=1)
    for start, end, grade in zip(breaks, breaks[1:], track.profile.grades_permille, strict=False):
        if end - start >= SHORTEST_TOLD_M:
            middle = 0.5 * (start + end)
            axes.annotate(f"{grade:.3g} ‰\n{end - start:.4g} m", (middle, lowest), (0, -5), textcoords="offset points",
                          ha="center", va="top", fontsize=6.5, color=GREY)  # fmt: skip
    for roll, colour, style in zip(rolls, LINE_COLOURS, LINE_STYLES, strict=False):
        axes.plot(roll.at_m, roll.energy_head_m, color=colour, linestyle=style, linewidth=1.3, zorder=3)
    for element in route.elements:
        at, height = element.at_m, -float(track.fall_m(np.asarray(element.at_m)))
        if isinstance(element.vertex, Retarder):
            for zone in element.vertex.zones_m:
                ends = np.asarray(zone) + at
                axes.plot(ends, -track.fall_m(ends), color=BLUE, linewidth=4.5, solid_capstyle="butt", zorder=5)
        elif isinstance(element.vertex, Switch):
            axes.plot([at], [height], marker=".", color=INK, markersize=4, zorder=5)
            axes.annotate(
                str(element.number), (at, height), (0, -11), textcoords="offset points", fontsize=7, ha="center"
            )
    axes.set_ylim(lowest - 0.22 * max(abs(lowest), 0.5), None)


def profile_legend(rolls: Sequence[RunnerRoll]) -> list[Artist]:
    """What the lines of the profile mean, and how far each runner comes."""
    lines: list[Artist] = [Line2D([], [], color=INK, linewidth=1.6, label="height of the track")]
    for roll, colour, style in zip(rolls, LINE_COLOURS, LINE_STYLES, strict=False):
        runner = roll.runner
        wind = f", head wind of {runner.head_wind_m_s:g} m/s" if runner.head_wind_m_s else ""
        ends = (
            f"stops at {roll.stop_m:.0f} m" if np.isfinite(roll.stop_m) else f"{roll.speed_m_s[-1]:.1f} m/s at the end"
        )
        label = f"{runner.name} runner: {runner.mass_t:g} t, {runner.resistance_n_per_kn:g} N/kN{wind}; {ends}"
        lines.append(Line2D([], [], color=colour, linestyle=style, label=label))
    return lines
