"""Where cuts go: what the control asks of the graph at every tick, looked up once; the route store of the published
model, with the track of each cut and the next cut over each switch; and cuts that cannot go where the list says.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from plant_models.errors import require
from plant_models.hump.elements import Retarder, Signal, Switch, TrackSection
from plant_models.hump.hump_graph import HumpGraph
from plant_models.hump.route import Route, RouteElement, Vertex
from synth.hump.control.cut_record import CutRecord
from synth.hump.control.events import Journal, Kind, Why
from synth.hump.control.models import Misroute, Technology


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


class RouteStore:
    """Cuts in the order in which they come over the hump, and their tracks; filled before each train.

    `PlantError` for a track that no route leads to, a lead that the hump has not, or a number given twice.
    """

    def __init__(self, table: RouteTable, cuts: Sequence[CutRecord]) -> None:
        self._table = table
        self.cuts = tuple(cuts)
        self.place = {cut.serial: place for place, cut in enumerate(self.cuts)}
        require(len(self.place) == len(self.cuts), "route store: two cuts have the same number")
        self._tracks: dict[int, int] = {}
        self._comers: dict[int, list[int]] = {switch: [] for switch in table.needed}
        leads = len(table.graph.leads)
        for cut in self.cuts:
            require(
                cut.lead < leads,
                f"cut {cut.serial}: lead is {cut.lead}; the hump has {leads} lead{'s' if leads > 1 else ''}, from 0 on",
            )
            self._put(cut.serial, cut.track)

    def record(self, cut: int) -> CutRecord:
        """The record of the cut with this serial number."""
        return self.cuts[self.place[cut]]

    def __contains__(self, cut: int) -> bool:
        return cut in self.place

    def track(self, cut: int) -> int:
        """Where it goes now."""
        return self._tracks[cut]

    def next_over(self, switch: int, behind: int) -> int | None:
        """The first cut behind the place `behind` whose route has this switch; None if there is none."""
        comers = self._comers[switch]
        at = bisect_right(comers, behind)
        return self.cuts[comers[at]].serial if at < len(comers) else None

    def position(self, switch: int, cut: int) -> int:
        """The position, 0 left or 1 right, that `cut` needs of a switch of its route."""
        return self._table.needed[switch][self._tracks[cut]]

    def change(self, cut: int, track: int) -> tuple[int, ...]:
        """Give `cut` another track; the switches of both routes."""
        place, old = self.place[cut], self.switches(cut)
        for switch in old:
            comers = self._comers[switch]
            del comers[bisect_left(comers, place)]
        self._put(cut, track)
        return tuple(dict.fromkeys((*old, *self.switches(cut))))

    def switches(self, cut: int) -> tuple[int, ...]:
        """The switches of its route, the first one first."""
        return tuple(self._table.route(self.record(cut).lead, self._tracks[cut]).positions)

    def _put(self, cut: int, track: int) -> None:
        self._tracks[cut] = track
        for switch in self.switches(cut):
            insort(self._comers[switch], self.place[cut])


class Misrouting:
    """Asks the technology for another track, and records where and why."""

    def __init__(self, store: RouteStore, technology: Technology, journal: Journal) -> None:
        self._store, self._technology, self._journal = store, technology, journal

    def send(self, cut: int, element: int, why: Why, reachable: Iterable[int], leader: int = 0) -> tuple[int, ...]:
        """Send `cut`, which is at `element`, to one of the `reachable` tracks; the switches whose next cut may have
        changed by that. A cut that keeps its own track is no misrouted one."""
        tracks, belongs = tuple(sorted(reachable)), self._store.record(cut).track
        leader_track = self._store.track(leader) if leader in self._store else None
        chosen = self._technology(Misroute(cut, element, why, leader, tracks, belongs, leader_track))
        require(
            chosen in tracks, f"technology: track {chosen} for cut {cut} cannot be reached from element {element}; "
            f"it must be one of {', '.join(map(str, tracks))}",
        )  # fmt: skip
        keeps = chosen == self._store.track(cut)
        if chosen != belongs and not (keeps and cut in self._journal.state.misrouted):
            self._journal.tell(Kind.MISROUTED, element, cut, why)
        if keeps:
            return ()
        self._journal.tell(Kind.RE_ROUTED, element, cut, chosen)
        return self._store.change(cut, chosen)
