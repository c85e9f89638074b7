"""A passage at which the regulator decides, with its switching speeds for every stage in force."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Final

import numpy as np

from tuning_tables.declared.members import Json, Place, require_declared
from tuning_tables.declared.numbers import Count, Number, present_rows
from tuning_tables.errors import InvalidTable, require_finite, require_tuple
from tuning_tables.stage import LARGEST_FLOAT32, MOST_STAGES

PATH_RANGE_M: Final = (-100.0, 1e5)

Row = tuple[float, ...]


@dataclass(frozen=True)
class SwitchingSpeeds:
    """K speeds for each stage k = 0 … K in force, float32 numbers >= 0 that do not fall in a row.

    A speed may be −∞ at j < k and +∞ at j >= k, which JSON writes as null.
    """

    meaning: str
    unit: str = ""
    axes: tuple[str, ...] = ("stage", "threshold")
    dtype: str = "<f4"
    allowed: str = "float32, 0 or more, not falling in a row; null: never"

    def check(self, value: Any, key: str) -> None:
        """They are such speeds, and a stage is lowered below less than it is raised above."""
        require_tuple(value, key)
        highest = len(value) - 1
        for stage, row in enumerate(value):
            at = f"{key}[{stage}]"
            require_tuple(row, at, highest)
            for index, speed in enumerate(row):
                _require_speed(speed, f"{at}[{index}]", never(stage, index))
            if any(later < earlier for earlier, later in pairwise(row)):
                raise InvalidTable(f"{at} is {row!r}, but its speeds must not fall.")
            if 0 < stage < highest and not row[stage - 1] < row[stage]:
                raise InvalidTable(
                    f"{at} is {row!r}, but its speed {stage - 1}, below which the stage is lowered, must be less than "
                    f"its speed {stage}, above which it is raised."
                )

    def written(self, value: Any) -> object:
        """Rows, null for an infinity."""
        return [[None if math.isinf(speed) else float(speed) for speed in row] for row in value]

    def read(self, value: object, place: Place) -> Any:
        """Rows of numbers or null."""
        return tuple(
            tuple(
                never(stage, index) if item is None else SPEED.read(item, place.item(stage).item(index))
                for index, item in enumerate(place.item(stage).array(row))
            )
            for stage, row in enumerate(place.array(value))
        )

    def schema(self) -> Json:
        """Rows of numbers or null."""
        speed = {"anyOf": [{"type": "null"}, SPEED.schema()]}
        row = {"type": "array", "items": speed, "minItems": 1, "maxItems": MOST_STAGES - 1}
        return {"type": "array", "items": row, "minItems": 2, "maxItems": MOST_STAGES}

    def cells(self, value: Any) -> Any:
        """Itself, infinities too."""
        return value

    def of_cells(self, cells: Any) -> Any:
        """Those that are no filling."""
        return present_rows(cells)


def never(stage: int, index: int) -> float:
    """In the row of `stage`, the speed at which stage `index` is never parted from the next."""
    return -math.inf if index < stage else math.inf


SPEED: Final = Number("switching speed", 0.0, LARGEST_FLOAT32)


@dataclass(frozen=True)
class PassageRow:
    """A passage of an axle over a sensor, with its switching speeds.

    `switching_m_s[k][j]` parts wanting stage j from wanting stage j + 1 when stage k is in force (see
    `rule.wanted_stage`): row[k − 1] < row[k] in the row of stage k.

    Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables import PassageRow
    >>> never = float("inf")
    >>> row = PassageRow(sensor=0, axle=0, path_m=-1.0, switching_m_s=((4.5,), (-never,)))
    >>> row.switching_m_s[0]  # at stage 0 in force: raise above 4.5 m/s
    (4.5,)
    """

    sensor: Annotated[int, Count("number of the sensor, from 0")]
    axle: Annotated[int, Count("number of the axle, from 0")]
    path_m: Annotated[float, Number("of the first axle when that axle is at the middle of the base", *PATH_RANGE_M)]
    switching_m_s: Annotated[
        tuple[Row, ...], SwitchingSpeeds("by stage in force, what parts wanting stage j from wanting stage j + 1")
    ]

    def __post_init__(self) -> None:
        require_declared(self, self._key)

    @property
    def _key(self) -> str:
        return f"passages: sensor {self.sensor}, axle {self.axle}"


def _require_speed(speed: float, key: str, never: float) -> None:
    """A float32 number >= 0, or the infinity `never`."""
    if isinstance(speed, float) and speed == never:
        return
    require_finite(speed, key)
    with np.errstate(over="ignore"):
        nearest = float(np.float32(speed))
    if not (nearest == speed and speed >= 0.0):
        raise InvalidTable(
            f"{key} is {speed!r}, but it must be a float32 number, 0 or greater (the nearest float32 number is "
            f"{nearest!r})."
        )
