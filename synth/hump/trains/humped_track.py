"""A track geometry of one humped train: the ground on which the hump control works beside the simulation.

Cuts are where the simulation had them, and go where they went there, however the control sets the points. So where the
control throws points otherwise than the simulation assumed, it is told as a disagreement.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from enum import IntEnum
from heapq import heapify, heappop
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from plant_models.hump.elements import Switch
from synth.hump.control.cut_routes import RouteTable
from synth.hump.control.events import MOVING
from synth.hump.control.models import ENTRY, AxlePass, Braking, Occupation
from synth.hump.trains.train_passages import Passage, TrainPassages


class TrackPoints:
    """All points lie left at first; a throw takes the time of its relay and its machine."""

    def __init__(self, switches: Sequence[Switch]) -> None:
        self.throws_s = {switch.number: switch.relay_s + switch.throw_s for switch in switches}
        self._lies = dict.fromkeys(self.throws_s, 0)
        self._moving: dict[int, tuple[float, int]] = {}
        self._news: list[tuple[int, int]] = list(self._lies.items())

    def throw(self, switch: int, position: int, now_s: float) -> bool:
        """Command points; whether they begin to move."""
        self._settle(switch, now_s)
        if switch not in self._moving and self._lies[switch] == position:
            return False
        self._moving[switch] = now_s + self.throws_s[switch], position
        self._news.append((switch, MOVING))
        return True

    def lay(self, switch: int, position: int) -> None:
        """Points lie so at once, wherever they were."""
        if self._moving.pop(switch, None) is not None or self._lies[switch] != position:
            self._lies[switch] = position
            self._news.append((switch, position))

    def lies(self, switch: int, time_s: float) -> int:
        """Position at `time_s`; points on their way count as where they were."""
        return self._moving[switch][1] if self._has_moved(switch, time_s) else self._lies[switch]

    def news(self, now_s: float) -> Iterator[tuple[int, int]]:
        """Detected positions that changed since the last call."""
        for switch in tuple(self._moving):
            self._settle(switch, now_s)
        news, self._news = self._news, []
        yield from news

    def _has_moved(self, switch: int, time_s: float) -> bool:
        return switch in self._moving and self._moving[switch][0] <= time_s

    def _settle(self, switch: int, now_s: float) -> None:
        if self._has_moved(switch, now_s):
            self._lies[switch] = self._moving.pop(switch)[1]
            self._news.append((switch, self._lies[switch]))


class Disagreement(NamedTuple):
    """`cut`, by its serial number, came on the section of `switch` and went by the branch `went`; the points lay for
    the other one."""

    time_s: float
    switch: int
    cut: int
    went: int


class Step(IntEnum):
    """What an axle does; at equal times axles go out before others come in."""

    GOES_OUT = 0
    COMES_IN = 1


class HumpedTrack:
    """A `TrackGeometry` of the train `passages`. Sections are occupied from the first axle in to the last axle out.

    Points that are still on their way when a first axle comes on their section count as where they lay, and go back
    there, as the simulation has it. If the cut went by the other branch in the simulation, that is one of the
    `disagreements`, and the points lie from then on as it went. Nothing brakes: the simulation has the exit speeds.
    """

    def __init__(self, table: RouteTable, passages: TrainPassages) -> None:
        self._table, self._passages, self._now_s = table, passages, float("-inf")
        self._serials = tuple(cut + 1 for cut in range(len(passages.ways)))
        self._points = TrackPoints(table.graph.switches)
        self._on: dict[int, tuple[int, ...]] = defaultdict(tuple)
        self._told: dict[int, tuple[int, ...]] = defaultdict(tuple)
        self._changed: list[int] = []
        self._axles: list[AxlePass] = []
        self._came: dict[int, list[int]] = defaultdict(list)
        self.disagreements: list[Disagreement] = []
        self._steps = [
            (time, step, cut, element, axle)
            for cut, way in enumerate(passages.ways)
            for element, passage in enumerate(way)
            for step, times in ((Step.COMES_IN, passage.in_s), (Step.GOES_OUT, passage.out_s))
            for axle, time in enumerate(times)
            if np.isfinite(time)
        ]
        heapify(self._steps)

    def advance(self, time_s: float) -> None:
        """Let every axle come to where it is at `time_s`."""
        while self._steps and self._steps[0][0] <= time_s:
            time, step, cut, place, axle = heappop(self._steps)
            passage = self._passages.ways[cut][place]
            if step is Step.COMES_IN:
                self._enter(time, cut, passage, axle)
            else:
                self._leave(time, cut, passage, axle)
        self._now_s = time_s

    def occupations(self) -> Iterator[Occupation]:
        """Sections whose objects changed."""
        changed, self._changed = dict.fromkeys(self._changed), []
        for element in changed:
            if self._told[element] != self._on[element]:
                self._told[element] = self._on[element]
                yield Occupation(element, self._on[element])

    def axles(self) -> Sequence[AxlePass]:
        """Axles that passed a counter."""
        passed, self._axles = self._axles, []
        return passed

    def positions(self) -> Iterator[tuple[int, int]]:
        """Points that lie otherwise."""
        return self._points.news(self._now_s)

    def throw(self, switch: int, position: int) -> None:
        """Command points."""
        self._points.throw(switch, position, self._now_s)

    def brake(self, retarder: int, braking: Braking | None) -> None:
        """Nothing: the simulation has braked."""

    def show(self, signal: int, aspect: int) -> None:
        """Nothing: the simulation has pushed the train."""

    def is_fouled(self, switch: int, slowest_m_s: float) -> bool:
        """Whether a cut that came on the points is so slow with its last axle short of the fouling point."""
        return any(
            passage.in_s[0] <= self._now_s < passage.clear_s and self.speed_m_s(serial) < slowest_m_s
            for serial, way in zip(self._serials, self._passages.ways, strict=True)
            for passage in way
            if passage.element == switch
        )

    def place_m(self, cut: int) -> float:
        """Where its first axle is: between joints it moves evenly."""
        way = self._passages.ways[cut - 1]
        return float(np.interp(self._now_s, [passage.in_s[0] for passage in way], [passage.from_m for passage in way]))

    def speed_m_s(self, cut: int) -> float:
        """How fast it is between two joints; 0 before the first one and behind the last one."""
        for here, there in pairwise(self._passages.ways[cut - 1]):
            if here.in_s[0] <= self._now_s < there.in_s[0]:
                return (there.from_m - here.from_m) / (there.in_s[0] - here.in_s[0])
        return 0.0

    def track_ahead(self, element: int, cut: int) -> int | None:
        """On which track the cut ends that came on the element before `cut`, which came already; None: nobody did."""
        came = self._came[element]
        place = came.index(cut)
        return self._passages.tracks[came[place - 1] - 1] if place else None

    def _enter(self, time_s: float, cut: int, passage: Passage, axle: int) -> None:
        if axle == 0:
            self._occupied_by(passage.element, (*self._on[passage.element], self._serials[cut]))
            self._came[passage.element].append(self._serials[cut])
            if self._table.is_switch(passage.element):
                self._choose(time_s, cut, passage)
        self._count(time_s, passage.element, ENTRY)

    def _occupied_by(self, element: int, objects: tuple[int, ...]) -> None:
        self._on[element] = objects
        self._changed.append(element)

    def _choose(self, time_s: float, cut: int, passage: Passage) -> None:
        switch = passage.element
        if self._points.lies(switch, time_s) != passage.branch:
            self.disagreements.append(Disagreement(time_s, switch, self._serials[cut], passage.branch))
        self._points.lay(switch, passage.branch)

    def _leave(self, time_s: float, cut: int, passage: Passage, axle: int) -> None:
        if axle == len(passage.out_s) - 1:
            serial = self._serials[cut]
            self._occupied_by(passage.element, tuple(each for each in self._on[passage.element] if each != serial))
        self._count(time_s, passage.element, passage.branch)

    def _count(self, time_s: float, element: int, end: int) -> None:
        if element in self._table.counted:
            self._axles.append(AxlePass(time_s, element, end))
