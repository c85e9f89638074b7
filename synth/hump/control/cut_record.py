"""One cut of a sorting list as the control knows it; the list, its cuts in the order in which they come over the hump;
and a cut as one word of 53 bits, by the fields that [hump-computer-1970s] lists; the widths are ours.
docs/explanation/hump-control.md has the steps and ranges of the fields, of which the first is the highest part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, IntEnum
from itertools import accumulate, pairwise

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


@dataclass(frozen=True)
class SortingList:
    """Cuts with rising serial numbers; `PlantError` for none, and for numbers that do not rise."""

    cuts: tuple[CutRecord, ...]

    def __post_init__(self) -> None:
        require(len(self.cuts) > 0, "sorting list: it holds no cut")
        for ahead, behind in pairwise(self.cuts):
            require(
                ahead.serial < behind.serial,
                f"sorting list: cut {behind.serial} stands behind cut {ahead.serial}; the numbers must rise",
            )

    def __len__(self) -> int:
        return len(self.cuts)

    @property
    def humped(self) -> tuple[CutRecord, ...]:
        """The cuts that go over the hump."""
        return tuple(cut for cut in self.cuts if cut.goes_over_the_hump)


WIDTHS = {
    "serial": 6,
    "mass_2t": 10,
    "length_2m": 8,
    "axle_pairs": 7,
    "cars": 6,
    "rolling_code": 4,
    "destination": 6,
    "hump_speed_dm_s": 5,
    "lead": 1,
}
WORD_BITS = 53
DIGITS = WIDTHS["destination"]

LOWEST = {"serial": 1, "axle_pairs": 1, "cars": 1, "hump_speed_dm_s": 5}
"""Where a field does not begin at 0; the word holds the value less this."""

HIGHEST = {"rolling_code": 14}
"""Where a field ends before its bits do."""

SHIFTS = dict(zip(WIDTHS, (WORD_BITS - upto for upto in accumulate(WIDTHS.values())), strict=True))


def limits(field: str) -> tuple[int, int]:
    """The least and the greatest value of `field`."""
    low = LOWEST.get(field, 0)
    return low, HIGHEST.get(field, low + 2 ** WIDTHS[field] - 1)


@dataclass(frozen=True)
class MachineRecord:
    """The fields of a word, in whole steps: `mass_2t` in 2 t, `length_2m` in 2 m, `hump_speed_dm_s` in 0.1 m/s."""

    serial: int
    mass_2t: int
    length_2m: int
    axle_pairs: int
    cars: int
    rolling_code: int
    destination: int
    hump_speed_dm_s: int
    lead: int

    def __post_init__(self) -> None:
        for field in WIDTHS:
            require_whole(f"machine record: {field}", getattr(self, field), *limits(field))

    @property
    def word(self) -> int:
        """The 53 bits."""
        return sum((getattr(self, field) - LOWEST.get(field, 0)) << shift for field, shift in SHIFTS.items())

    @property
    def category(self) -> int:
        """The number of the weight category, 1 to 5."""
        return self.rolling_code // len(Rolling) + 1

    @property
    def rolling(self) -> Rolling:
        """How well it rolls."""
        return Rolling(self.rolling_code % len(Rolling))

    def position(self, rank: int) -> int:
        """The position of the switch `rank` of the route, 0 for the first: a digit of the destination."""
        require_whole("rank of the switch", rank, 0, DIGITS - 1)
        return self.destination >> (DIGITS - 1 - rank) & 1


def record_of_word(word: int) -> MachineRecord:
    """The record that `word` holds; `PlantError` for what is none."""
    require_whole("word of a cut", word, 0, 2**WORD_BITS - 1)
    return MachineRecord(
        **{field: (word >> shift & 2 ** WIDTHS[field] - 1) + LOWEST.get(field, 0) for field, shift in SHIFTS.items()}
    )


def machine_record(record: CutRecord, positions: Sequence[int]) -> MachineRecord:
    """`record` rounded to the steps of the word, half to even; `positions`: of the switches of its route, the first
    switch first. `PlantError` where a field cannot hold it: nothing is cut off."""
    require(
        record.axles % 2 == 0, f"cut {record.serial}: {record.axles} axles; a machine record holds pairs of axles only"
    )
    return MachineRecord(
        serial=record.serial,
        mass_2t=round(record.mass_t / 2.0),
        length_2m=round(record.length_m / 2.0),
        axle_pairs=record.axles // 2,
        cars=record.cars,
        rolling_code=len(Rolling) * (record.category - 1) + record.rolling,
        destination=destination_code(positions),
        hump_speed_dm_s=round(10.0 * record.hump_speed_m_s),
        lead=record.lead,
    )


def destination_code(positions: Sequence[int]) -> int:
    """The binary code of a route: its digits are the positions of the switches, the first is the highest of six.

    A route of fewer switches has zeros behind; no code of a shorter route is the beginning of a longer one's, so routes
    of one hump never share a code.
    """
    require(len(positions) <= DIGITS, f"route: {len(positions)} switches; the code has {DIGITS} digits")
    require(set(positions) <= {0, 1}, f"route: positions {list(positions)}; each must be 0 (left) or 1 (right)")
    return sum(position << DIGITS - 1 - rank for rank, position in enumerate(positions))
