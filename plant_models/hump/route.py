"""A route: the way from a crest to a classification track, with the place and position of every element on it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from plant_models.hump.edge import Edge
from plant_models.hump.elements import Retarder, Signal, Switch, TrackSection
from plant_models.rolling.roll_track import Bend, RollTrack
from plant_models.track_profile import TrackProfile

Vertex = Switch | Signal | Retarder | TrackSection
"""An element of the hump, a vertex of its graph."""


@dataclass(frozen=True)
class RouteElement:
    """An element of a route, metres from the crest: its place `at_m`, and its insulated section from `from_m` to `to_m`
    (both `at_m` for a signal). `position`: 0 left, 1 right, None for what is no switch."""

    vertex: Vertex
    at_m: float
    from_m: float
    to_m: float
    position: int | None

    @property
    def number(self) -> int:
        """Number of the element."""
        return self.vertex.number

    @property
    def edge(self) -> Edge:
        """The edge by which the route leaves the element."""
        return self.vertex.edges[self.position or 0]


@dataclass(frozen=True)
class Route:
    """The way from the signal `lead`, at 0 m, to the end of `track`, at `length_m`; its elements in order."""

    lead: int
    track: int
    elements: tuple[RouteElement, ...]
    length_m: float

    @cached_property
    def positions(self) -> Mapping[int, int]:
        """Position of each switch by its number, in order: 0 left, 1 right."""
        return {e.number: e.position for e in self.elements if e.position is not None}

    @property
    def code(self) -> str:
        """Binary code of the track: a digit a switch, the highest for the first switch ([hump-computer-1970s])."""
        return "".join(str(position) for position in self.positions.values())

    def element(self, number: int) -> RouteElement:
        """The element `number`; `KeyError` if it is not on the route."""
        for element in self.elements:
            if element.number == number:
                return element
        raise KeyError(number)

    @property
    def free_to_m(self) -> float:
        """Where the standing cars begin, or the track ends."""
        last = self.elements[-1].vertex
        assert isinstance(last, TrackSection)
        return self.length_m - last.standing_m

    @property
    def yard_from_m(self) -> float:
        """Where the yard begins: behind the last retarder, else with the last section."""
        ends = [each.at_m + each.vertex.exit_m for each in self.elements if isinstance(each.vertex, Retarder)]
        return ends[-1] if ends else self.elements[-1].at_m

    def fouling_m(self, switch: int) -> float:
        """Fouling point, from the crest, of the branch that the route takes at `switch`."""
        element = self.element(switch)
        assert isinstance(element.vertex, Switch)
        return element.at_m + element.vertex.branches[element.position or 0].fouling_m

    @property
    def radars_m(self) -> tuple[tuple[float, float], ...]:
        """What each radar sees."""
        return tuple((e.at_m + r.from_m, e.at_m + r.to_m) for e in self.elements for r in e.edge.radars)

    @cached_property
    def roll_track(self) -> RollTrack:
        """The track of the route, on which a cut rolls: falls, and the turning of wheels on switches and curves.

        The turn of a switch is spread from its points to its exit joint.
        """
        starts, grades = [0.0], [self.elements[0].edge.grades[0][1]]
        for element in self.elements:
            for start, grade in element.edge.grades:
                if grade != grades[-1]:
                    starts.append(element.at_m + start)
                    grades.append(grade)
        return RollTrack(TrackProfile(tuple(starts), tuple(grades)), self.length_m, tuple(self._bends()))

    def _bends(self) -> Iterator[Bend]:
        for element in self.elements:
            vertex, at = element.vertex, element.at_m
            if isinstance(vertex, Switch):
                branch = vertex.branches[element.position or 0]
                yield Bend(at, at + vertex.exit_joint_m, 1, branch.turn_deg)
            for curve in element.edge.curves:
                yield Bend(at + curve.from_m, at + curve.to_m, 0, abs(curve.turn_deg))


def route_through(vertices: Sequence[Vertex]) -> Route:
    """The route through `vertices`, from the signal at the crest to the last section of a track, joined by edges."""
    elements, at = [], 0.0
    for vertex, behind in zip(vertices, (*vertices[1:], None), strict=True):
        to = behind.number if behind is not None else None
        branch = next(place for place, edge in enumerate(vertex.edges) if edge.to == to)
        ahead_m, behind_m = vertex.section_m
        position = branch if isinstance(vertex, Switch) else None
        elements.append(RouteElement(vertex, at, at - ahead_m, at + behind_m, position))
        at += vertex.edges[branch].length_m
    last = vertices[-1]
    assert isinstance(last, TrackSection)
    assert last.track is not None
    return Route(vertices[0].number, last.track, tuple(elements), at)
