"""The time–path diagram of a train: its cuts as bands from tail to head, and when they occupy the elements, which stand
as a strip above the panel.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plant_models.hump import Retarder, Switch
from synth.frame.picture.house_style import (
    BLUE,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    dress,
    graded,
    legend_below,
    new_figure,
    place,
)
from synth.frame.printed_numbers import counted
from synth.hump.rolling.hump_routes import HumpRoutes, Mark
from synth.hump.trains.train_trace import AlarmKind, TracedCut, TrainTrace

CLOSE_M = 3.0
"""Elements of other routes whose sections begin and end so close to one another are named together."""

SHORTEST_NAMED_M = 3.0
BAR_IN = 0.08


@dataclass(frozen=True)
class Level:
    """Elements of one kind at the same place of different routes: their section, and their numbers."""

    kind: type
    from_m: float
    to_m: float
    numbers: tuple[int, ...]

    @property
    def name(self) -> str:
        """'7', '4, 5', or '421 … 452'."""
        shown = [str(number) for number in self.numbers]
        return f"{shown[0]} … {shown[-1]}" if len(shown) > 2 else ", ".join(shown)


COLOURS = {Switch: ORANGE, Retarder: BLUE}
"""Of sections; others are `SKY`."""


def colour_of(kind: type) -> str:
    """The colour of an element's section."""
    return COLOURS.get(kind, SKY)


def levels(routes: HumpRoutes) -> Iterator[Level]:
    """All elements, those at the same place together, in order of their places."""
    kinds = {number: type(routes.graph.vertex(number)) for number in routes.numbers}
    at = {}
    for row in range(len(routes.routes)):
        for column in range(routes.elements):
            if routes.vertex[row, column] >= 0:
                number = routes.numbers[routes.vertex[row, column]]
                place = routes.place_m[row, column]
                at[number] = float(place[Mark.FIRST_IN]), float(place[Mark.FIRST_OUT])
    waiting = sorted(at, key=lambda number: (at[number], number))
    while waiting:
        first = waiting[0]
        same = [n for n in waiting if kinds[n] is kinds[first] and near(at[n], at[first])]
        waiting = [n for n in waiting if n not in same]
        yield Level(kinds[first], *at[first], tuple(sorted(same)))


def near(one: tuple[float, float], other: tuple[float, float]) -> bool:
    """Whether two sections begin and end at about the same places."""
    return all(abs(a - b) <= CLOSE_M for a, b in zip(one, other, strict=True))


def draw_strip(figure: Figure, axes: Axes, routes: HumpRoutes, upto_m: float) -> None:
    """Sections as bars along the top of the panel, the numbers of their elements above; thin lines at retarders."""
    across = axes.get_xaxis_transform()
    bar = BAR_IN / (axes.get_position().height * figure.get_size_inches()[1])
    shown = [level for level in levels(routes) if level.from_m < upto_m]
    for level in shown:
        span = [(level.from_m, level.to_m - level.from_m)]
        axes.broken_barh(span, (1.0, bar), transform=across, facecolor=colour_of(level.kind), clip_on=False, zorder=4)
        if level.to_m - level.from_m >= SHORTEST_NAMED_M:
            middle = 0.5 * (level.from_m + level.to_m)
            axes.annotate(
                level.name, (middle, 1.0 + bar), (0, 3), xycoords=across, textcoords="offset points", rotation=90,
                ha="center", va="bottom", fontsize=7, color=INK if level.kind is not Retarder else BLUE,
                annotation_clip=False,
            )  # fmt: skip
        if level.kind is Retarder:
            for place_m in (level.from_m, level.to_m):
                axes.axvline(place_m, color=GREY, linewidth=0.5, linestyle=(0, (1, 3)), zorder=1)


BAND_COLOURS = (INK, PURPLE, GREY, SKY)
"""Of cuts to different bunches; orange and blue are the sections, and green is a weight category elsewhere."""

SECONDS_PER_INCH, SHORTEST_IN, TALLEST_IN = 24.0, 4.0, 40.0
STEP_M = 4.0
BEHIND_M = 20.0
"""Of the tracks behind the last element of any route, a switch or a position, that is shown."""

SHOWN = (AlarmKind.MISROUTED, AlarmKind.CONTACT, AlarmKind.FOUL, AlarmKind.UNSEPARATED)
"""Alarms that belong to an element."""

MARKERS = dict(zip(SHOWN, ("X", "o", "^", "s"), strict=True))


def time_path(trace: TrainTrace, title: str = "") -> Figure:
    """Path across from the crest, time down. Sections of all routes stand beside one another at their metres.

    `title`: what the train is, where that is more than its number.
    """
    routes = trace.routes
    upto_m = float(routes.ends_m.max()) + BEHIND_M
    ends_s = max(float(cut.trace.time_s[cut.trace.head_m <= upto_m].max()) for cut in trace.cuts)
    tall = min(max(ends_s / SECONDS_PER_INCH, SHORTEST_IN), TALLEST_IN)
    figure = new_figure(12.5, tall + 2.45, title or f"Time–path diagram of train {trace.number + 1}", subject_of(trace))
    place(figure, left=1.35, right=0.75, bottom=1.15, top=1.3)
    axes = figure.subplots()
    dress(axes, "", "metres from the crest", "seconds since the first cut was at the crest")
    axes.yaxis.tick_right()
    axes.yaxis.set_label_position("right")
    axes.spines["right"].set_visible(True)
    axes.locator_params("y", nbins=max(int(tall), 4))
    draw_occupied(axes, trace, ends_s)
    colours = colours_by_bunch(trace)
    for cut in trace.cuts:
        draw_band(axes, cut, colours[bunch(routes, cut.route)], (upto_m, ends_s))
        name_cut(axes, cut, colours[bunch(routes, cut.wanted)], routes)
    drawn = draw_alarms(axes, trace)
    draw_strip(figure, axes, routes, upto_m)
    axes.set_xlim(0.0, upto_m)
    axes.set_ylim(ends_s, float(trace.cuts[0].trace.time_s[0]))
    legend_below(figure, legend(colours, drawn), columns=5)
    return figure


def subject_of(trace: TrainTrace) -> str:
    """How long, how fast, and what went wrong."""
    found = [
        f"{sum(alarm.kind is kind for alarm in trace.alarms)} {kind.value}"
        for kind in AlarmKind
        if any(alarm.kind is kind for alarm in trace.alarms)
    ]
    cars = sum(cut.cars for cut in trace.cuts)
    mean = trace.mean_hump_speed_m_s
    pushed = f", mean hump speed {mean:.2f} m/s" if np.isfinite(mean) else ""
    return f"{counted(len(trace.cuts), 'cut')} of {counted(cars, 'car')}{pushed}; alarms: {', '.join(found) or 'none'}"


def bunch(routes: HumpRoutes, route: int) -> int:
    """Number of the last but one retarder of the route; of a route that has fewer than others, that of as many as they
    have but one; 0 where there is none."""
    held = routes.retarder[route][routes.retarder[route] >= 0]
    place = min(len(held), routes.positions - 1) - 1
    return routes.numbers[int(routes.vertex[route, held[place]])] if place >= 0 else 0


def colours_by_bunch(trace: TrainTrace) -> dict[int, str]:
    """A colour for each bunch of the hump, in order."""
    found = sorted({bunch(trace.routes, row) for row in range(len(trace.routes.routes))})
    palette = BAND_COLOURS if len(found) <= len(BAND_COLOURS) else graded(len(found))
    return dict(zip(found, palette, strict=False))


def draw_occupied(axes: Axes, trace: TrainTrace, ends_s: float) -> None:
    """A box for each cut and element: its section across, from the first axle in to the last axle out."""
    kinds = {number: type(trace.routes.graph.vertex(number)) for number in trace.routes.numbers}
    for kind in dict.fromkeys(kinds.values()):
        boxes = [
            [(o.from_m, o.from_s), (o.to_m, o.from_s), (o.to_m, to_s), (o.from_m, to_s)]
            for o in trace.occupied
            if kinds[o.number] is kind
            for to_s in [min(o.to_s, ends_s)]
        ]
        axes.add_collection(
            PolyCollection(boxes, facecolor=colour_of(kind), edgecolor=colour_of(kind), alpha=0.22, linewidth=0.6,
                           zorder=2)
        )  # fmt: skip


def draw_band(axes: Axes, cut: TracedCut, colour: str, corner: tuple[float, float]) -> None:
    """The cut from its tail to its head, as far as the `corner` (m, s) of the panel."""
    way, (upto_m, upto_s) = cut.trace, corner
    ends_m = min(float(way.head_m[-1]), upto_m + cut.length_m)
    heads = np.append(np.arange(0.0, ends_m, STEP_M), ends_m)
    times = np.interp(heads, way.head_m, way.time_s)
    if ends_m == way.head_m[-1]:
        heads, times = np.append(heads, ends_m), np.append(times, max(upto_s, times[-1]))
    axes.fill_betweenx(times, heads - cut.length_m, heads, color=colour, alpha=0.5, linewidth=0.0, zorder=3)
    axes.plot(heads, times, color=colour, linewidth=1.0, zorder=3)


def name_cut(axes: Axes, cut: TracedCut, colour: str, routes: HumpRoutes) -> None:
    """Number and track of the cut at the crest."""
    wanted, went = (routes.graph.track_called(routes.routes[row].track) for row in (cut.wanted, cut.route))
    text = f"{cut.cut + 1} → {wanted}"
    if cut.route != cut.wanted:
        text += f", went to {went}"
    axes.annotate(
        text, (0.0, cut.crest_s), (-4, 0), textcoords="offset points", ha="right", va="center", fontsize=7,
        color=colour, annotation_clip=False,
    )  # fmt: skip


def draw_alarms(axes: Axes, trace: TrainTrace) -> list[AlarmKind]:
    """Marks where cuts met, and the kinds that were drawn."""
    drawn: list[AlarmKind] = []
    for alarm in trace.alarms:
        if alarm.kind not in MARKERS or not np.isfinite(alarm.time_s):
            continue
        at = float(trace.cuts[alarm.cut].trace.head_at(np.asarray(alarm.time_s)))
        hollow = alarm.kind is AlarmKind.UNSEPARATED
        axes.plot(
            [at], [alarm.time_s], marker=MARKERS[alarm.kind], markersize=6 if hollow else 8, color=VERMILLION,
            markerfacecolor="none" if hollow else VERMILLION, linestyle="none", zorder=6, clip_on=False,
        )  # fmt: skip
        if alarm.kind not in drawn:
            drawn.append(alarm.kind)
    return drawn


def legend(colours: dict[int, str], drawn: Sequence[AlarmKind]) -> list[Artist]:
    """What boxes, bands and marks mean."""
    handles: list[Artist] = [
        Patch(facecolor=ORANGE, alpha=0.35, label=f"{Switch.__name__.lower()} occupied"),
        Patch(facecolor=BLUE, alpha=0.35, label=f"{Retarder.__name__.lower()} occupied"),
    ]
    handles += [
        Patch(facecolor=colour, alpha=0.5, label="cut, tail to head" + (f", by retarder {number}" if number else ""))
        for number, colour in colours.items()
    ]
    handles += [
        Line2D([], [], color=VERMILLION, linestyle="none", marker=MARKERS[kind], markersize=7, label=kind.value,
               markerfacecolor="none" if kind is AlarmKind.UNSEPARATED else VERMILLION)
        for kind in SHOWN
        if kind in drawn
    ]  # fmt: skip
    return handles
