"""The insulated sections of a reference track: what is on them, and what they tell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.hump.control.models import Occupation
from tests.synth.hump.control.reference_faults import NOBODY, FalselyFree, FalselyOccupied, Fault


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
