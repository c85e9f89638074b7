"""The layout of least expected cost for a number of sensors: from the best of a few starts, descent place by place.

The cost is compared on the coarse chains of `candidate_places`. Nothing proves that the descent ends in the best layout
of all; for three sensors exhaustive search finds the same (tests).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from plant_models.point_sensors import SHORTEST_SECTION_M
from synth.retarder.sensors.layout import CandidatePlaces, equal_layout

PlaceNumbers = tuple[int, ...]
"""Numbers of the places at which deciding sensors stand, rising."""

ForEach = Callable[[Callable[[CandidatePlaces], list[float]], Sequence[CandidatePlaces]], Iterable[list[float]]]
"""Calls a function for every case, in their order, as `map` does; that of a pool of threads does it at once."""

STRIDES = (4, 2, 1)
"""By so many places a sensor is moved, the longest first."""

LEAST_GAIN = 5e-3
"""A round of moves of all sensors must lower the cost by this part of it, else it was the last with its stride."""


@dataclass(frozen=True)
class LayoutSearch:
    """Mean cost of layouts over `cases`, each worked out once; `path_m` (P,): where sensors may stand, rising.

    `first_m`, `exit_m`: of equal layouts. `for_each` changes no cost.
    """

    cases: tuple[CandidatePlaces, ...]
    path_m: tuple[float, ...]
    first_m: float
    exit_m: float
    for_each: ForEach = map
    known: dict[PlaceNumbers, float] = field(default_factory=dict, compare=False, repr=False)

    def costs(self, layouts: Sequence[PlaceNumbers]) -> list[float]:
        """Mean costs over the cases; infinite where sensors stand too near to each other or off the path."""
        asked = [each for each in dict.fromkeys(layouts) if each not in self.known]
        self.known.update((each, float("inf")) for each in asked if not self._can_stand(each))
        possible = [each for each in asked if each not in self.known]
        for first in range(0, len(possible), self.together):
            self._solve(possible[first : first + self.together])
        return [self.known[each] for each in layouts]

    def least(self, layouts: Sequence[PlaceNumbers]) -> PlaceNumbers:
        """The layout of least cost; the first of several."""
        return layouts[int(np.argmin(self.costs(layouts)))]

    @property
    def together(self) -> int:
        """How many layouts are best solved at once."""
        return min(case.together for case in self.cases)

    def places_m(self, layout: PlaceNumbers) -> tuple[float, ...]:
        """The places of a layout."""
        return tuple(round(self.path_m[number], 3) for number in layout)

    def numbers(self, places_m: Sequence[float]) -> PlaceNumbers:
        """The numbers of the places next to these."""
        return tuple(int(np.argmin(np.abs(np.array(self.path_m) - place))) for place in places_m)

    def best_layouts(self, most: int) -> Iterator[PlaceNumbers]:
        """The best layout found of one deciding sensor, of two, and so on up to `most`.

        A descent begins from the best layout that has one sensor more than the one before; and from equal sections
        where these cost less.
        """
        found: PlaceNumbers = ()
        for count in range(1, most + 1):
            starts = [self.equal(count)]
            if found:
                grown = self.least([*self.inserted(found), *self.spread(found)])
                starts = [grown] if self.least([grown, *starts]) == grown else [*starts, grown]
            found = self.least([self.descended(each) for each in starts])
            yield found

    def equal(self, count: int) -> PlaceNumbers:
        """The places next to equal sections."""
        return self.numbers(equal_layout(self.first_m, self.exit_m, count))

    def inserted(self, layout: PlaceNumbers) -> list[PlaceNumbers]:
        """Layouts with one more sensor, in the middle of a section, before the first or behind the last."""
        ends = [0, *layout, len(self.path_m) - 1]
        new = {(a + b) // 2 for a, b in pairwise(ends)} - set(layout)
        return [tuple(sorted((*layout, number))) for number in sorted(new)]

    def spread(self, layout: PlaceNumbers) -> Iterator[PlaceNumbers]:
        """Layouts with one more sensor, spread as those of `layout` are: all of them, or all but the first."""
        places = self.places_m(layout)
        for kept in range(min(2, len(places) - 1)):
            spread = places[kept:]
            parts = np.linspace(0.0, len(spread) - 1.0, len(spread) + 1)
            yield self.numbers((*places[:kept], *np.interp(parts, np.arange(len(spread)), spread)))

    def descended(self, layout: PlaceNumbers) -> PlaceNumbers:
        """Sensors moved one by one, round after round, while that pays."""
        best = layout
        for stride in STRIDES:
            before, gained = self.costs([best])[0], True
            while gained:
                for sensor in range(len(layout)):
                    tried = [best, *(shifted(best, sensor, by) for by in (-stride, stride))]
                    if any(each not in self.known for each in tried):
                        self.costs([*tried, *self.asked_next(best, sensor, stride)])
                    best = self.least(tried)
                gained = self.known[best] < before * (1.0 - LEAST_GAIN)
                before = self.known[best]
        return best

    def asked_next(self, layout: PlaceNumbers, sensor: int, stride: int) -> list[PlaceNumbers]:
        """Moves of the sensors behind `sensor`, then of those before it, that fill up one solution.

        The descent asks for them next unless it moves first.
        """
        order = [*range(sensor + 1, len(layout)), *range(sensor)]
        moves = (shifted(layout, other, by) for other in order for by in (-stride, stride))
        unknown = [each for each in moves if each not in self.known and self._can_stand(each)]
        now = [shifted(layout, sensor, by) for by in (0, -stride, stride)]
        free = self.together - sum(each not in self.known and self._can_stand(each) for each in now)
        return unknown[: max(0, free)]

    def _can_stand(self, layout: PlaceNumbers) -> bool:
        if any(number < 0 or number >= len(self.path_m) for number in layout):
            return False
        places = [self.path_m[number] for number in layout]
        return places[0] < 0.0 and all(b - a >= SHORTEST_SECTION_M for a, b in pairwise(places))

    def _solve(self, layouts: Sequence[PlaceNumbers]) -> None:
        places = [[self.path_m[number] for number in layout] for layout in layouts]
        by_case = np.array(list(self.for_each(lambda case: case.mean_costs(places), self.cases)))
        self.known.update(zip(layouts, by_case.mean(axis=0).tolist(), strict=True))


def shifted(layout: PlaceNumbers, sensor: int, by: int) -> PlaceNumbers:
    """`layout` with one sensor moved by so many nodes."""
    return tuple(number + by if which == sensor else number for which, number in enumerate(layout))
