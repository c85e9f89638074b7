"""A hump as its designers draw it: the track plan, and below it the profile of one route with speed heads."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from plant_models.hump import Retarder, Route, Switch
from plant_models.library.hump_entry import HumpEntry
from synth.frame.picture.house_style import (
    BLUE,
    GREY,
    INK,
    LINE_COLOURS,
    LINE_STYLES,
    PALE_GREY,
    dress,
    legend_below,
    new_figure,
    place,
)
from synth.hump.control.pictures.plan_layout import plan_layout
from synth.hump.control.pictures.track_plan import draw_plan, plan_legend
from synth.hump.design_runners import RunnerRoll

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
