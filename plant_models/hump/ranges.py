"""What the numbers of a hump may be, stated once: for its elements, the reader of hump files, and their schema."""

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
