"""What the control asks of the graph at every tick, looked up once: lists of tracks, places, next elements."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from plant_models.hump.hump_graph import HumpGraph
from plant_models.hump.retarder import Retarder
from plant_models.hump.route import Route, RouteElement, Vertex
from plant_models.hump.signal import Signal
from plant_models.hump.switch import Switch
from plant_models.hump.track_section import TrackSection


@dataclass(frozen=True)
class RouteTable:
    """The routes of one hump, by element."""

    graph: HumpGraph

    @cached_property
    def needed(self) -> Mapping[int, Mapping[int, int]]:
        """For each switch the position (0 left, 1 right) for each track behind it."""
        return {
            switch.number: {
                **dict.fromkeys(self.graph.left_tracks(switch.number), 0),
                **dict.fromkeys(self.graph.right_tracks(switch.number), 1),
            }
            for switch in self.graph.switches
        }

    @cached_property
    def behind(self) -> Mapping[int, frozenset[int]]:
        """The tracks behind each element."""
        found: dict[int, set[int]] = {}
        for lead in self.graph.leads:
            for route in self.graph.routes(lead).values():
                for element in route.elements:
                    found.setdefault(element.number, set()).add(route.track)
        return {number: frozenset(tracks) for number, tracks in found.items()}

    @cached_property
    def places(self) -> Mapping[int, Mapping[int, RouteElement]]:
        """For each lead the places of the elements that are reached from it, by number."""
        return {
            lead: {e.number: e for route in self.graph.routes(lead).values() for e in route.elements}
            for lead in self.graph.leads
        }

    @cached_property
    def sections(self) -> frozenset[int]:
        """The elements that have an insulated section: all but signals."""
        return frozenset(v.number for v in self.graph.vertices if not isinstance(v, Signal))

    @cached_property
    def home(self) -> Mapping[int, int]:
        """The track of each section of a classification track, by its number."""
        return {s.number: s.track for s in self.graph.sections if s.track is not None}

    @cached_property
    def last(self) -> frozenset[int]:
        """The sections in which tracks end."""
        return frozenset(s.number for s in self.graph.sections if s.is_last)

    def vertex(self, number: int) -> Vertex:
        """The element."""
        return self.graph.by_number[number]

    def is_switch(self, number: int) -> bool:
        """Whether the element is a switch."""
        return isinstance(self.vertex(number), Switch)

    @cached_property
    def retarders(self) -> frozenset[int]:
        """Numbers of the retarders."""
        return frozenset(v.number for v in self.graph.vertices if isinstance(v, Retarder))

    @cached_property
    def plain(self) -> frozenset[int]:
        """Numbers of the sections of plain track."""
        return frozenset(v.number for v in self.graph.vertices if isinstance(v, TrackSection))

    def next_section(self, number: int, branch: int = 0) -> int | None:
        """The next element with a section behind `number`, by `branch` of a switch; None behind the last."""
        exits = self.graph.incidence[number]
        if not exits:
            return None
        following = exits[branch if len(exits) > 1 else 0]
        return following if following in self.sections else self.next_section(following)

    @cached_property
    def counted(self) -> frozenset[int]:
        """Numbers of the sections with axle counters at their joints."""
        return frozenset(v.number for v in self.graph.vertices if not isinstance(v, Signal) and v.axle_counters)

    @cached_property
    def uncounted_switch(self) -> int | None:
        """A switch without axle counters, the first by number; None where all have them."""
        return min(self.needed.keys() - self.counted, default=None)

    def next_counted(self, number: int, branch: int = 0) -> int | None:
        """The next section with axle counters behind `number`, where no switch lies between; None if there is none."""
        following = self.next_section(number, branch)
        while following is not None and following not in self.counted:
            following = None if self.is_switch(following) else self.next_section(following)
        return following

    def route(self, lead: int, track: int) -> Route:
        """The route from the lead with this place in the list of leads, 0 or 1."""
        return self.graph.route(self.graph.leads[lead], track)

    def tracks_by(self, switch: int, position: int) -> tuple[int, ...]:
        """The tracks to which routes take this branch, in order."""
        lists = (self.graph.left_tracks, self.graph.right_tracks)
        return lists[position](switch)
