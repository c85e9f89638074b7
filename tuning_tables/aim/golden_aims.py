"""Golden aims of a table: questions where a wrong implementation of the rule shows, with the right answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.aim.aim_tables import AimTable, AimTables
from tuning_tables.aim.axes import NO_ANSWER
from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN
from tuning_tables.programs.aim_speed import exit_speed

Floats = npt.NDArray[np.float32]
Question = tuple[int, float, float]
"""Cars, free distance in m, resistance in N/kN."""

LARGEST: Final = float(np.finfo(np.float32).max)
SMALLEST: Final = float(np.finfo(np.float32).smallest_subnormal)
INT_LIMITS: Final = (-32768, 32767)
"""Of a 16-bit INT, which every controller has."""

MOST_PLACES: Final = 80
"""On one axis, for one number of cars."""


@dataclass(frozen=True, eq=False)
class GoldenAims:
    """n questions and their answers: cars int32, the others float32, all (n,); the answer in m/s, -1 for none."""

    cars: npt.NDArray[np.int32]
    free_distance_m: Floats
    resistance_n_per_kn: Floats
    exit_speed_m_s: Floats

    def __post_init__(self) -> None:
        for array in vars(self).values():
            array.setflags(write=False)

    def __len__(self) -> int:
        return len(self.cars)


def golden_aims(table: AimTable) -> GoldenAims:
    """For every number of cars: at, beside and between the nodes of one axis, at changing places of the other.

    Of an axis with many nodes each number of cars takes some. And beyond the ends of both, numbers of cars between and
    beyond the listed ones, and what is no number. The same table gives the same questions, in order, each once.
    """
    far, high = _places(table.held.distance_m), _places(table.held.resistance_n_per_kn)
    questions: list[Question] = []
    for row, cars in enumerate(table.axes.cars.tolist()):
        questions += [(cars, d, high[(row + place) % len(high)]) for place, d in enumerate(_some(far, row))]
        questions += [(cars, far[(row + place) % len(far)], r) for place, r in enumerate(_some(high, row))]
    middle, mean = far[len(far) // 2], high[len(high) // 2]
    for cars in _numbers_of_cars(table):
        questions += [(cars, middle, mean), (cars, far[0], high[0])]
    return golden_answers(table, [*questions, *_incredible(table, mean)])


def few_golden_aims(table: AimTable) -> GoldenAims:
    """At most fifteen questions for each number of cars, and some sixty besides: for controllers with little memory.

    At both ends of the distance, at two places between, and at the last node that has a speed for each of the least and
    the largest resistance; numbers of cars below, between and above the listed ones; and what is no number.
    """
    held = table.held
    low, top = held.resistance_n_per_kn[[0, -1]].tolist()
    first, last = held.distance_m[[0, -1]].tolist()
    near, far = (first + (last - first) * part for part in (0.25, 0.8125))
    between = [low + (top - low) * part for part in (0.1875, 0.75)]
    questions: list[Question] = []
    for cars, speeds in zip(held.cars.tolist(), held.speed_m_s, strict=True):
        questions += [(cars, d, r) for d in (first, near, far, last) for r in between]
        questions += [(cars, near, r) for r in (low, top)] + [(cars, last + 1000.0, between[0])]
        for r, column in ((low, 0), (top, -1)):
            reached = np.flatnonzero(speeds[:, column] != NO_ANSWER)
            questions.append((cars, float(held.distance_m[reached[-1] if len(reached) else 0]), r))
    numbers = _numbers_of_cars(table)
    questions += [(cars, near, between[1]) for cars in (*numbers[:4], *numbers[4:-4][:12], *numbers[-4:])]
    return golden_answers(table, [*questions, *_incredible(table, between[1])])


def golden_answers(table: AimTable, questions: Sequence[Question]) -> GoldenAims:
    """The questions, rounded to float32, each once, in their order, with their answers."""
    cars = np.array([question[0] for question in questions], dtype=np.int32)
    distance, resistance = (np.array([each[axis] for each in questions], dtype=np.float32) for axis in (1, 2))
    # By bit pattern, so that NaN equals NaN and -0.0 is not 0.0.
    bits = np.stack([cars.view(np.uint32), distance.view(np.uint32), resistance.view(np.uint32)], axis=1)
    first = np.sort(np.unique(bits, axis=0, return_index=True)[1])
    cars, distance, resistance = cars[first], distance[first], resistance[first]
    asked = zip(cars.tolist(), distance, resistance, strict=True)
    speeds = np.array([exit_speed(table.held, *each) for each in asked], dtype=np.float32)
    return GoldenAims(cars, distance, resistance, speeds)


def golden_selections(aims: AimTables) -> tuple[tuple[int, bool, int], ...]:
    """(category number, measured, number of the table or -1 for none): all that are there, and some that are not."""
    numbers = {0, 6, LARGEST_OWN, *KNOWN_NUMBERS.values(), *aims.exported_numbers().values()}
    asked = [(number, measured) for number in sorted(numbers) for measured in (False, True)]
    found = [(number, measured, aims.select(number, measured)) for number, measured in asked]
    return tuple(
        (number, measured, -1 if table is None else aims.tables.index(table)) for number, measured, table in found
    )


def _places(nodes: Floats) -> list[float]:
    """The nodes, their float32 neighbours, places between them, and far beyond both ends."""
    beside = [np.nextafter(nodes, np.float32(side * np.inf)) for side in (-1, 1)]
    between = [nodes[:-1] + np.diff(nodes) * np.float32(part) for part in (0.3, 0.8125)]
    ends = [nodes[:1] - np.float32(1000.0), nodes[-1:] + np.float32(1000.0)]
    return [float(place) for place in np.unique(np.concatenate([nodes, *beside, *between, *ends]))]


def _some(places: list[float], first: int) -> list[float]:
    """At most `MOST_PLACES` of the places, evenly spread, others for another `first`."""
    step = -(-len(places) // MOST_PLACES)
    return places[first % step :: step]


def _numbers_of_cars(table: AimTable) -> list[int]:
    """Listed numbers and their neighbours, none, less than none, and the most that an INT holds."""
    listed = table.axes.cars.tolist()
    return sorted({cars + step for cars in listed for step in (-1, 0, 1)} | {0, -1, *INT_LIMITS})


def _incredible(table: AimTable, resistance: float) -> list[Question]:
    """What cannot be true, or only just can, with the first and the last number of cars."""
    hard = (np.nan, np.inf, -np.inf, LARGEST, -LARGEST, SMALLEST, -SMALLEST, -1.0, -0.0, 0.0)
    ends, first_m = table.axes.cars[[0, -1]].tolist(), float(table.held.distance_m[0])
    return [question for cars in ends for x in hard for question in ((cars, x, resistance), (cars, first_m, x))]
