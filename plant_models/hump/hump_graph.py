"""The hump as a directed graph: switches, signals, retarders and sections, joined from left to right by edges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from plant_models.hump.elements import LEFT, RIGHT, Retarder, Signal, Switch, TrackSection
from plant_models.hump.ranges import HumpError, element_name, in_brackets
from plant_models.hump.route import Route, Vertex, route_through
from plant_models.hump.structure import require_hump, tracks_behind

if TYPE_CHECKING:
    import networkx as nx

_Kind = TypeVar("_Kind", Switch, Signal, Retarder, TrackSection)


@dataclass(frozen=True)
class HumpGraph:
    """The elements of a hump by number, and its `leads`: the signal at each crest, where routes begin.

    Incidence lists, lists of tracks and routes follow from the edges, as in the control model ([kozachenko-control]).
    Raises `HumpError`, which names the element, unless the numbers are unique, every edge leads to an element, no way
    closes to a circle, every switch has two exits, every element is reached, each track from a crest by one route at
    most, and no insulated sections overlap.
    """

    vertices: tuple[Vertex, ...]
    leads: tuple[int, ...]

    def __post_init__(self) -> None:
        require_hump(self.vertices, self.leads)
        # in one order, so that two humps of the same elements are equal
        object.__setattr__(self, "vertices", tuple(sorted(self.vertices, key=lambda vertex: vertex.number)))

    @cached_property
    def by_number(self) -> Mapping[int, Vertex]:
        """Each element under its number."""
        return {vertex.number: vertex for vertex in self.vertices}

    def vertex(self, number: int) -> Vertex:
        """The element `number`; `KeyError` if there is none."""
        return self.by_number[number]

    @property
    def switches(self) -> tuple[Switch, ...]:
        """All switches, by number."""
        return self._of(Switch)

    @property
    def signals(self) -> tuple[Signal, ...]:
        """All signals, by number."""
        return self._of(Signal)

    @property
    def retarders(self) -> tuple[Retarder, ...]:
        """All retarders, by number."""
        return self._of(Retarder)

    @property
    def sections(self) -> tuple[TrackSection, ...]:
        """All sections of plain track, by number."""
        return self._of(TrackSection)

    def _of(self, kind: type[_Kind]) -> tuple[_Kind, ...]:
        return tuple(v for v in self.vertices if isinstance(v, kind))

    @cached_property
    def incidence(self) -> Mapping[int, tuple[int, ...]]:
        """Next elements of each element: (v_left, v_right) of a switch, (v_next,) of others, () where a track ends."""
        return {v.number: tuple(edge.to for edge in v.edges if edge.to is not None) for v in self.vertices}

    @cached_property
    def tracks(self) -> tuple[int, ...]:
        """Numbers of the classification tracks, in order."""
        return tuple(sorted({s.track for s in self.sections if s.track is not None}))

    @cached_property
    def names(self) -> Mapping[int, str]:
        """What the yard calls elements, by number; only of those that have a name."""
        named = ((vertex.number, getattr(vertex, "name", None)) for vertex in self.vertices)
        return {number: name for number, name in named if name is not None}

    @cached_property
    def track_names(self) -> Mapping[int, str]:
        """What it calls tracks, by number; only of those that have a name."""
        return {s.track: s.name for s in self.sections if s.is_last and s.track is not None and s.name is not None}

    def called(self, number: int) -> str:
        """An element in words: '7', or with its name '7 (East 4)'."""
        return f"{number}{in_brackets(self.names.get(number))}"

    def element_called(self, number: int) -> str:
        """The same with its kind: 'switch 7 (East 4)'."""
        return f"{element_name(number)}{in_brackets(self.names.get(number))}"

    def track_called(self, track: int) -> str:
        """A track in words: '12', or with its name '12 (C12)'."""
        return f"{track}{in_brackets(self.track_names.get(track))}"

    def left_tracks(self, switch: int) -> tuple[int, ...]:
        """w_left: the tracks to which routes take the left branch of `switch`, in order."""
        return self._track_lists[self.incidence[switch][LEFT]]

    def right_tracks(self, switch: int) -> tuple[int, ...]:
        """w_right: the tracks to which routes take the right branch of `switch`, in order."""
        return self._track_lists[self.incidence[switch][RIGHT]]

    def routes(self, lead: int) -> Mapping[int, Route]:
        """The route to each track that is reached from the crest of the signal `lead`, by track number in order."""
        if lead not in self.leads:
            raise HumpError(f"signal {lead} is at no crest; routes begin at {', '.join(map(str, self.leads))}", lead)
        return self._routes[lead]

    def route(self, lead: int, track: int) -> Route:
        """The route from the crest of the signal `lead` to `track`; `HumpError` if there is none."""
        routes = self.routes(lead)
        if track not in routes:
            raise HumpError(f"track {track} is not reached from signal {lead}", lead)
        return routes[track]

    @cached_property
    def network(self) -> nx.DiGraph[int]:
        """The graph of the numbers, for algorithms of networkx; do not change it."""
        import networkx as nx

        return nx.freeze(nx.DiGraph({number: list(exits) for number, exits in self.incidence.items()}))

    @cached_property
    def _track_lists(self) -> Mapping[int, tuple[int, ...]]:
        return tracks_behind(self.vertices)

    @cached_property
    def _routes(self) -> Mapping[int, Mapping[int, Route]]:
        import networkx as nx

        found: dict[int, Mapping[int, Route]] = {}
        for lead in self.leads:
            ways = nx.single_source_shortest_path(self.network, lead)
            routes = [
                route_through([self.by_number[number] for number in ways[section.number]])
                for section in self.sections
                if section.is_last and section.number in ways
            ]
            found[lead] = {r.track: r for r in sorted(routes, key=lambda r: r.track)}
        return found
