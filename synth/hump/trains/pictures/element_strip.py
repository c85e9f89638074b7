"""The elements of all routes above a panel over path: where switches and retarders are, and their numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from plant_models.hump import Retarder, Switch
from synth.frame.picture.house_style import BLUE, GREY, INK, ORANGE, SKY
from synth.hump.trains.hump_routes import HumpRoutes, Mark

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
