"""How cuts that follow each other hold each other up, and where some of them stall."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from synth.hump.control.cut_routes import RouteTable

Floats = NDArray[np.float64]

APART_M = 9.0
"""Between the last axle of an object and the first of the next one, uncoupled, at least."""

FASTER_M_S2, FASTEST_M_S = 0.6, 7.0
"""No cut that was held up gets faster than by this; 60 permille give 0.59 m/s². None is faster than that."""

SLOW_M, SLOW_M_S = 15.0, 0.6
"""So far ahead of the place where it stalls an object gets slow, and so slow."""

FOULING_M = 27.0
"""The fouling points of random humps, behind the points."""

CREPT_M = 0.001
"""What a stalled object creeps, since places must rise with the times."""


@dataclass(frozen=True)
class Stall:
    """An object stops with its first axle at `place_m` for `for_s`; infinite: for good."""

    place_m: float
    for_s: float


NO_STALLS: Final[Mapping[int, Stall]] = MappingProxyType({})


@dataclass
class Queue:
    """The object that came last: where its first axle is when; `stops_m`: places where it or one ahead of it stalls, as
    its first axle has them; `end_m`: where it stands for good."""

    places_m: Floats = field(default_factory=lambda: np.array([0.0]))
    times_s: Floats = field(default_factory=lambda: np.array([-np.inf]))
    behind_m: float = 0.0
    """From its first axle to that of an object close behind."""
    stops_m: tuple[float, ...] = ()
    end_m: float = np.inf

    def behind(self, grid_m: Floats, wish_s: Floats, axles_m: Floats, stall: Stall | None) -> tuple[Floats, Floats]:
        """(places, times) of the next object, which wishes to be at `grid_m` at `wish_s`."""
        stops = [stop - self.behind_m for stop in self.stops_m]
        end = self.end_m - self.behind_m
        waits_s = 0.0
        if stall is not None and stall.place_m < end:
            stops += [stall.place_m - SLOW_M, stall.place_m, stall.place_m + CREPT_M]
            end, waits_s = (stall.place_m, 0.0) if np.isinf(stall.for_s) else (end, stall.for_s)
        places = np.unique([*grid_m, *(stop for stop in stops if 0.0 < stop < grid_m[-1])])
        if np.isfinite(end):
            places = np.append(places[places < end], end) if end > 0.0 else np.array([end - 1.0, end])
        stalled = np.inf if stall is None else stall.place_m
        times = self._times(places, np.interp(places, grid_m, wish_s), stalled, waits_s)
        self.places_m, self.times_s, self.behind_m = places, times, float(axles_m[-1]) + APART_M
        self.stops_m, self.end_m = tuple(stops), end
        return places, times

    def _times(self, places: Floats, wish: Floats, stalled_m: float, waits_s: float) -> Floats:
        """As wished, but never ahead of what the object ahead and the stall of its own allow."""
        leaves = np.interp(places + self.behind_m, self.places_m, self.times_s)
        times, wish = wish.copy(), wish + np.where(places > stalled_m, waits_s, 0.0)
        times[0] = max(times[0], leaves[0])
        had = (places[1] - places[0]) / max(wish[1] - wish[0], 1e-3)
        for k in range(1, len(places)):
            step = places[k] - places[k - 1]
            fastest = min(FASTEST_M_S, (had**2 + 2.0 * FASTER_M_S2 * step) ** 0.5)
            if stalled_m - SLOW_M < places[k] <= stalled_m:
                fastest = min(fastest, SLOW_M_S)
            waits = waits_s if places[k - 1] == stalled_m else 0.0
            times[k] = max(wish[k], leaves[k], times[k - 1] + step / fastest + waits)
            had = step / (times[k] - times[k - 1])
        return times


def random_stalls(
    axles_m: Sequence[Floats], table: RouteTable, lead: int, random: np.random.Generator, share: float
) -> dict[int, Stall]:
    """Stalls of objects for 10 to 60 s, or one in four for good: anywhere, with an axle just behind a joint, or with
    the last axle between the exit joint of a switch and its fouling point."""
    found: dict[int, Stall] = {}
    if not share:
        return found  # nothing drawn: the trains of a seed are those without stalls
    there = table.places[lead]
    joints = [joint for place in there.values() for joint in (place.from_m, place.to_m)]
    fouled = [(there[number].to_m, there[number].at_m + FOULING_M) for number in there if table.is_switch(number)]
    for number, axles in enumerate(axles_m):
        if random.random() >= share:
            continue
        kind = random.random()
        if kind < 0.4:
            place = random.uniform(10.0, max(joints))
        elif kind < 0.8 or not fouled:
            place = random.choice(joints) + random.choice(axles) + random.uniform(0.0, 2.0)
        else:
            place = random.uniform(*random.choice(fouled)) + axles[-1]
        found[number] = Stall(float(place), np.inf if random.random() < 0.25 else float(random.uniform(10.0, 60.0)))
    return found
