"""A track geometry whose cuts move by tables of places and times: the ground on which the control is tested.

Every axle is followed from section to section. The first axle of a cut decides, at the points, which branch the cut
takes. Nothing brakes and nothing touches: cuts move as their tables say, whatever the retarders are told.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from heapq import heappop, heappush
from itertools import count
from math import isfinite

from plant_models.hump.elements import Switch
from synth.hump.control.cut_routes import RouteTable
from synth.hump.control.models import ENTRY, AxlePass, Braking, Occupation
from tests.synth.hump.control.reference_sections import CounterSlip, Fault, FaultyPoints, MovingCut, ReferenceSections


class Step(IntEnum):
    """What an axle comes to next."""

    ENTRY_JOINT = 0
    POINTS = 1
    EXIT_JOINT = 2


@dataclass
class Truth:
    """What really happened; objects are places in the list of moving cuts.

    `thrown_under`: (time, switch, object) where points began to move under an object, or ahead of it on their section.
    `moved_under`: where points were on their way as a first axle came to them. `came_s`, `left_s`: when the first axle
    of (element, object) came in, and the last one left. `ends`: the last element of each object.
    """

    thrown_under: list[tuple[float, int, int]] = field(default_factory=list)
    moved_under: list[tuple[float, int, int]] = field(default_factory=list)
    came_s: dict[tuple[int, int], float] = field(default_factory=dict)
    left_s: dict[tuple[int, int], float] = field(default_factory=dict)
    ends: dict[int, int] = field(default_factory=dict)


class ReferenceTrack:
    """A `TrackGeometry` of `cuts`, which come over the hump in this order; `faults` are those of its equipment.

    `sees_axles`: a section is occupied while an axle is on it, as a track circuit tells; otherwise from the first axle
    in to the last axle out, as the published model has it.
    """

    def __init__(
        self, table: RouteTable, cuts: Sequence[MovingCut], faults: Sequence[Fault] = (), sees_axles: bool = True
    ) -> None:
        self._table, self._cuts, self.truth, self._now_s = table, tuple(cuts), Truth(), float("-inf")
        self._names = [cut.cut for cut in cuts]
        self._sections = ReferenceSections(faults, sees_axles)
        self._points = FaultyPoints(table.graph.switches, faults)
        self._slips = {(f.element, f.end, f.axle): f.change for f in faults if isinstance(f, CounterSlip)}
        self._counted: dict[tuple[int, int], int] = defaultdict(int)
        self._passes: list[AxlePass] = []
        self._steps: list[tuple[float, int, Step, int, int, int]] = []
        self._row = count()
        self._branches: dict[tuple[int, int], int] = {}
        self._behind: dict[int, list[int]] = defaultdict(list)
        self._latest: dict[int, int] = {}
        self.aspects: dict[int, int] = {}
        self.braking: dict[int, Braking | None] = {}
        for number, cut in enumerate(self._cuts):
            self._approach(number, table.next_section(table.graph.leads[cut.lead]))

    def advance(self, time_s: float) -> None:
        """Let every axle come to where it is at `time_s`."""
        steps = self._steps
        while steps and steps[0][0] <= time_s:
            time, _, step, number, element, axle = heappop(steps)
            if step is Step.ENTRY_JOINT:
                self._enter(time, number, element, axle)
            elif step is Step.POINTS:
                self._choose(time, number, element)
            else:
                self._leave(time, number, element, axle)
        self._now_s = time_s

    def occupations(self) -> Iterator[Occupation]:
        """Sections whose objects changed."""
        return self._sections.news(self._now_s, self._names)

    def axles(self) -> Sequence[AxlePass]:
        """Axles that passed a counter."""
        passes, self._passes = self._passes, []
        return passes

    def positions(self) -> Iterator[tuple[int, int]]:
        """Points that lie otherwise."""
        return self._points.news(self._now_s)

    def throw(self, switch: int, position: int) -> None:
        """Command points."""
        if self._points.throw(switch, position, self._now_s):
            self.truth.thrown_under += [(self._now_s, switch, number) for number in self._sections.on(switch)]

    def brake(self, retarder: int, braking: Braking | None) -> None:
        """Remember what the retarder is told."""
        self.braking[retarder] = braking

    def show(self, signal: int, aspect: int) -> None:
        """Remember what the signal shows."""
        self.aspects[signal] = aspect

    def is_fouled(self, switch: int, slowest_m_s: float) -> bool:
        """Whether an object that passed the points is so slow with its last axle short of the fouling point."""
        vertex = self._table.vertex(switch)
        assert isinstance(vertex, Switch)
        behind = self._behind[switch]
        for number in tuple(behind):
            cut = self._cuts[number]
            points_m = self._table.places[self._table.graph.leads[cut.lead]][switch].at_m
            tail_m = cut.place_m(self._now_s) - float(cut.axles_m[-1])
            if tail_m >= points_m + vertex.branches[self._branches[switch, number]].fouling_m:
                behind.remove(number)
            elif cut.speed_m_s(self._now_s) < slowest_m_s:
                return True
        return False

    def place_m(self, cut: int) -> float:
        """Where the first axle is of the object of this number that came last."""
        return self._object(cut).place_m(self._now_s)

    def speed_m_s(self, cut: int) -> float:
        """How fast it is."""
        return self._object(cut).speed_m_s(self._now_s)

    def is_empty(self) -> bool:
        """Whether nothing more will move over a joint or points."""
        return not self._steps

    def _object(self, cut: int) -> MovingCut:
        return self._cuts[self._latest[cut]]

    def _approach(self, number: int, element: int | None) -> None:
        """Work out when the axles of the object come to the next element of its way."""
        if element is None:
            return
        cut = self._cuts[number]
        place = self._table.places[self._table.graph.leads[cut.lead]][element]
        for axle, time in enumerate(cut.arrivals_s(place.from_m)):
            self._push(time, Step.ENTRY_JOINT, number, element, axle)
        if self._table.is_switch(element):
            self._push(cut.arrivals_s(place.at_m)[0], Step.POINTS, number, element, 0)
        if element not in self._table.last:
            for axle, time in enumerate(cut.arrivals_s(place.to_m)):
                self._push(time, Step.EXIT_JOINT, number, element, axle)

    def _push(self, time_s: float, step: Step, number: int, element: int, axle: int) -> None:
        if isfinite(time_s):
            heappush(self._steps, (time_s, next(self._row), step, number, element, axle))

    def _enter(self, time_s: float, number: int, element: int, axle: int) -> None:
        if axle == 0:
            self.truth.came_s[element, number] = time_s
            self.truth.ends[number] = element
            self._latest[self._names[number]] = number
            if not self._table.is_switch(element):
                self._go_on(number, element, 0)
        self._sections.enters(element, number)
        self._count(time_s, element, ENTRY)

    def _choose(self, time_s: float, number: int, switch: int) -> None:
        if self._points.is_moving(switch, time_s):
            self.truth.moved_under.append((time_s, switch, number))
        self._behind[switch].append(number)
        self._go_on(number, switch, self._points.lies(switch, time_s))

    def _go_on(self, number: int, element: int, branch: int) -> None:
        self._branches[element, number] = branch
        self._approach(number, self._table.next_section(element, branch))

    def _leave(self, time_s: float, number: int, element: int, axle: int) -> None:
        last = axle == len(self._cuts[number].axles_m) - 1
        self._sections.leaves(element, number, last)
        self._count(time_s, element, self._branches[element, number])
        if last:
            self.truth.left_s[element, number] = time_s

    def _count(self, time_s: float, element: int, end: int) -> None:
        if element not in self._table.counted:
            return
        passed = self._counted[element, end]
        self._counted[element, end] = passed + 1
        times = 1 + self._slips.get((element, end, passed), 0)
        self._passes += [AxlePass(time_s, element, end)] * times
