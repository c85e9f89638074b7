"""What the numbers of a hump may be, stated once for its elements, the reader of hump files, and their schema; and the
numbers of its elements, a group for each kind: those of the control model ([kozachenko-control]).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from plant_models.errors import PlantError


@dataclass(frozen=True)
class Range:
    """The finite numbers from `low` to `high`, both allowed."""

    low: float
    high: float

    def faults(self, name: str, value: float) -> Iterator[str]:
        """A sentence where `value` of the key `name` is not among them."""
        if not (math.isfinite(value) and self.low <= value <= self.high):
            yield f"{name} is {value!r}; it must be a finite number from {self.low:g} to {self.high:g}"

    def require(self, name: str, value: float) -> None:
        """`PlantError` where `value` of the key `name` is not among them."""
        for sentence in self.faults(name, value):
            raise PlantError(sentence)


LONGEST_EDGE_M: Final = 5000.0
STEEPEST_PERMILLE: Final = 60.0
MOST_TRACKS: Final = 199

LENGTH_M: Final = Range(0.1, LONGEST_EDGE_M)
"""Of an edge, and of a section."""

PLACE_M: Final = Range(0.0, LONGEST_EDGE_M)
"""On an edge."""

GRADE_PERMILLE: Final = Range(-STEEPEST_PERMILLE, STEEPEST_PERMILLE)
TURN_DEG: Final = Range(0.0, 30.0)
"""Of a branch."""

CURVE_DEG: Final = Range(-180.0, 180.0)
FOULING_M: Final = Range(0.1, 300.0)
ENTRY_JOINT_M: Final = Range(0.0, 100.0)
SWITCH_EXIT_JOINT_M: Final = Range(0.1, 100.0)
RETARDER_EXIT_JOINT_M: Final = Range(0.0, 300.0)
ZONE_M: Final = Range(0.0, 200.0)
THROW_S: Final = Range(0.05, 10.0)
RELAY_S: Final = Range(0.0, 5.0)
EXIT_STD_M_S: Final = Range(0.0, 1.0)
STANDING_M: Final = Range(0.0, LONGEST_EDGE_M)
TRACK: Final = Range(1, MOST_TRACKS)


class HumpError(PlantError):
    """A hump cannot be as it is described; `element` is the number of the element at fault, None where it is of all."""

    def __init__(self, sentence: str, element: int | None = None) -> None:
        super().__init__(sentence)
        self.element = element


class HumpErrors(HumpError):
    """All `errors` of a hump, at least one; `element` is that of the first."""

    def __init__(self, *errors: HumpError) -> None:
        super().__init__("; ".join(map(str, errors)), errors[0].element)
        self.errors = errors


@dataclass(frozen=True)
class NumberGroup:
    """The numbers `first` to `last` of one kind of elements, which messages call `noun`."""

    noun: str
    first: int
    last: int

    def __contains__(self, number: int) -> bool:
        return self.first <= number <= self.last

    def checked(self, number: int) -> int:
        """`number` itself; `HumpError` if it is not in the group."""
        if number not in self:
            raise HumpError(
                f"{self.noun} {number}: the number is not in its group; give a {self.noun} a number from {self.first} "
                f"to {self.last}",
                number,
            )
        return number


SWITCHES: Final = NumberGroup("switch", 1, 199)
SIGNALS: Final = NumberGroup("signal", 201, 399)
RETARDERS: Final = NumberGroup("retarder", 401, 599)
SECTIONS: Final = NumberGroup("section", 601, 799)
GROUPS: Final = (SWITCHES, SIGNALS, RETARDERS, SECTIONS)


def element_name(number: int) -> str:
    """'switch 7', 'signal 201', …; 'element 1000' for a number of no group."""
    noun = next((group.noun for group in GROUPS if number in group), "element")
    return f"{noun} {number}"


def in_brackets(name: str | None) -> str:
    """' (East 4)' behind a number; '' without a name."""
    return "" if name is None else f" ({name})"


def fault_of(element: int, sentence: str) -> HumpError:
    """The fault `sentence` of an element, whose name is put before it."""
    return HumpError(f"{element_name(element)}: {sentence}", element)
