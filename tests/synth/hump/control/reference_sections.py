"""What a reference track is made of.

What rolls over a reference track: axles, and where the first of them is at which time.
Faults of the equipment that a reference track can have.
The points of a reference track with the faults of their machines.
The insulated sections of a reference track: what is on them, and what they tell.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.errors import require
from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.hump.elements import Switch
from synth.hump.control.models import Occupation
from synth.hump.trains.humped_track import TrackPoints


@frozen_arrays
@dataclass(frozen=True, eq=False)
class MovingCut:
    """An object of number `cut` that rolls from the lead with this place in the list of leads.

    `axles_m`: how far each axle is behind the first one, from 0 on, rising. Its first axle is at `places_m` from the
    crest at `times_s`, both rising, with constant speed between; behind the last place it stands. `PlantError` for
    others.
    """

    cut: int
    axles_m: Floats
    times_s: Floats
    places_m: Floats
    lead: int = 0

    def __post_init__(self) -> None:
        require(self.cut > 0, f"moving cut: its number is {self.cut}; it must be more than 0")
        require(len(self.times_s) == len(self.places_m) >= 2, "moving cut: it needs two places and times at least")
        require(len(self.axles_m) > 0 and self.axles_m[0] == 0.0, "moving cut: its first axle must be at 0")
        for name, rising in (("axles_m", self.axles_m), ("times_s", self.times_s), ("places_m", self.places_m)):
            require(
                bool(np.all(np.isfinite(rising)) and np.all(np.diff(rising) > 0.0)),
                f"moving cut {self.cut}: {name} must be finite numbers that rise",
            )

    def arrivals_s(self, place_m: float) -> list[float]:
        """When each axle is at `place_m`; infinite for those that never are, the first time where it began beyond."""
        at = self.axles_m + place_m
        return [
            float(time)
            for time in np.where(at <= self.places_m[-1], np.interp(at, self.places_m, self.times_s), np.inf)
        ]

    def place_m(self, time_s: float) -> float:
        """Where the first axle is."""
        return float(np.interp(time_s, self.times_s, self.places_m))

    def speed_m_s(self, time_s: float) -> float:
        """How fast it is; 0 before it begins and after it stands."""
        leg = bisect_right(self.times_s.tolist(), time_s) - 1
        if not 0 <= leg < len(self.times_s) - 1:
            return 0.0
        return float((self.places_m[leg + 1] - self.places_m[leg]) / (self.times_s[leg + 1] - self.times_s[leg]))


def moving_cut(
    cut: int, axles_m: Sequence[float], start_s: float, legs: Sequence[tuple[float, float]], lead: int = 0
) -> MovingCut:
    """A cut whose first axle is at the crest at `start_s`; `legs`: up to which metre it has which speed."""
    places, times = [0.0], [start_s]
    for to_m, speed_m_s in legs:
        require(speed_m_s > 0.0, f"moving cut {cut}: a speed is {speed_m_s:g} m/s; it must be more than 0")
        times.append(times[-1] + (to_m - places[-1]) / speed_m_s)
        places.append(to_m)
    return MovingCut(cut, np.array(axles_m, dtype=np.float64), np.array(times), np.array(places), lead)


@dataclass(frozen=True)
class StuckSwitch:
    """Commands that come between two times move no points."""

    switch: int
    from_s: float
    to_s: float


@dataclass(frozen=True)
class LateSwitch:
    """Points need so much more time."""

    switch: int
    extra_s: float


@dataclass(frozen=True)
class CounterSlip:
    """The counter at `end` of an element (ENTRY or a branch) misses (−1) the axle that passes it as number `axle`, from
    0 on, or counts it twice (1)."""

    element: int
    end: int
    axle: int
    change: int

    def __post_init__(self) -> None:
        require(self.change in (-1, 1), f"counter slip: change is {self.change}; it must be −1 or 1")


@dataclass(frozen=True)
class FalselyOccupied:
    """A section is told occupied by nobody known."""

    element: int
    from_s: float
    to_s: float


@dataclass(frozen=True)
class FalselyFree:
    """A section is told free."""

    element: int
    from_s: float
    to_s: float


Fault = StuckSwitch | LateSwitch | CounterSlip | FalselyOccupied | FalselyFree
NOBODY = 1_000_000
"""The object of a falsely occupied section."""


class FaultyPoints(TrackPoints):
    """Points of which some come late, or do not move at all."""

    def __init__(self, switches: Sequence[Switch], faults: Sequence[Fault]) -> None:
        super().__init__(switches)
        self._stuck = [fault for fault in faults if isinstance(fault, StuckSwitch)]
        for fault in faults:
            if isinstance(fault, LateSwitch):
                self.throws_s[fault.switch] += fault.extra_s

    def throw(self, switch: int, position: int, now_s: float) -> bool:
        """Nothing where they are stuck."""
        if any(each.switch == switch and each.from_s <= now_s <= each.to_s for each in self._stuck):
            return False
        return super().throw(switch, position, now_s)

    def is_moving(self, switch: int, time_s: float) -> bool:
        """Whether they are on their way."""
        return switch in self._moving and not self._has_moved(switch, time_s)


class ReferenceSections:
    """Objects on each section in the order in which they came, by their place in the list of moving cuts.

    `sees_axles`: an object between two of its axles is not seen, as by a track circuit.
    """

    def __init__(self, faults: Sequence[Fault], sees_axles: bool) -> None:
        self._sees_axles = sees_axles
        self._axles: dict[int, dict[int, int]] = {}
        self._lies = [fault for fault in faults if isinstance(fault, FalselyFree | FalselyOccupied)]
        turns = {(time, fault.element) for fault in self._lies for time in (fault.from_s, fault.to_s)}
        self._turns = sorted(turns, reverse=True)
        self._changed: dict[int, None] = {}
        self._told: dict[int, tuple[int, ...]] = {}

    def on(self, element: int) -> tuple[int, ...]:
        """The objects whose first axle came in and whose last axle has not left."""
        return tuple(self._axles.get(element, ()))

    def enters(self, element: int, number: int) -> None:
        """An axle of the object came in."""
        axles = self._axles.setdefault(element, {})
        axles[number] = axles.get(number, 0) + 1
        self._changed[element] = None

    def leaves(self, element: int, number: int, last: bool) -> None:
        """An axle of the object left, its last one or another."""
        axles = self._axles[element]
        axles[number] -= 1
        if last:
            del axles[number]
        self._changed[element] = None

    def news(self, now_s: float, names: Sequence[int]) -> Iterator[Occupation]:
        """What the sections tell otherwise than at the last call; `names`: the number of each object."""
        while self._turns and self._turns[-1][0] <= now_s:
            self._changed[self._turns.pop()[1]] = None
        changed, self._changed = self._changed, {}
        for element in changed:
            told = self._seen(element, now_s, names)
            if self._told.get(element, ()) != told:
                self._told[element] = told
                yield Occupation(element, told)

    def _seen(self, element: int, now_s: float, names: Sequence[int]) -> tuple[int, ...]:
        axles = self._axles.get(element, {})
        there = [names[number] for number, within in axles.items() if within > 0 or not self._sees_axles]
        seen = tuple(dict.fromkeys(there))
        for lie in self._lies:
            if lie.element == element and lie.from_s <= now_s < lie.to_s:
                if isinstance(lie, FalselyFree):
                    return ()
                seen = (NOBODY, *seen)
        return seen
