"""One cut of a sorting list, as the control knows it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, IntEnum

from plant_models.errors import require, require_between

MOST_CUTS, MOST_CARS, MOST_AXLES, MOST_AXLE_LOAD_T = 999, 60, 400, 50.0
FASTEST_HUMP_M_S = 4.0
USUAL_CAR_M = 13.92
"""Length of a car where a list does not tell it: a four-axle gondola."""

USUAL_HUMP_SPEED_M_S = 1.7


class Rolling(IntEnum):
    """How well a cut rolls, by the code in its record."""

    GOOD = 0
    MEAN = 1
    BAD = 2


class Mark(Enum):
    """What a list says besides; the value is the word in a file."""

    DO_NOT_HUMP = "do-not-hump"
    LONG_BASE = "long-base"
    HANDLE_WITH_CARE = "handle-with-care"


@dataclass(frozen=True)
class CutRecord:
    """A cut: `serial` from 1 in the order of the list, `category` the number of its weight category, `track` where it
    goes, `lead` 0 or 1 over which hump lead it comes. `PlantError` for what no cut can be."""

    serial: int
    cars: int
    axles: int
    mass_t: float
    category: int
    track: int
    length_m: float
    rolling: Rolling = Rolling.MEAN
    lead: int = 0
    hump_speed_m_s: float = USUAL_HUMP_SPEED_M_S
    marks: frozenset[Mark] = frozenset()

    def __post_init__(self) -> None:
        require_whole("cut", self.serial, 1, MOST_CUTS)
        require_whole("cars", self.cars, 1, MOST_CARS)
        require_whole("axles", self.axles, 2 * self.cars, MOST_AXLES)
        require_between("mass_t", self.mass_t, 1.0, MOST_AXLE_LOAD_T * self.axles)
        require_whole("category", self.category, 1, 255)
        require_whole("track", self.track, 1, 999)
        require_between("length_m", self.length_m, 4.0 * self.cars, 200.0 * self.cars)
        require_whole("lead", self.lead, 0, 1)
        require_between("hump_speed_m_s", self.hump_speed_m_s, 0.1, FASTEST_HUMP_M_S)

    @property
    def goes_over_the_hump(self) -> bool:
        """Whether it is humped at all."""
        return Mark.DO_NOT_HUMP not in self.marks


def require_whole(name: str, value: int, low: int, high: int) -> None:
    """`PlantError` unless `value` is a whole number from `low` to `high`."""
    require(
        type(value) is int and low <= value <= high, f"{name} is {value!r}; it must be a whole number {low} to {high}"
    )
