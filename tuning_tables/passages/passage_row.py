"""A passage at which the regulator decides, with its switching speeds for every stage in force."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_between, require_count, require_finite, require_tuple

PATH_RANGE_M: Final = (-100.0, 1e5)

Row = tuple[float, ...]


@dataclass(frozen=True)
class PassageRow:
    """Axle `axle` over sensor `sensor`, both numbered from 0, when the first axle is at `path_m`.

    `switching_m_s` has a row of K speeds for each stage k = 0 … K in force; row[j] parts wanting stage j from wanting
    stage j + 1 (see `rule.wanted_stage`). The speeds of a row are float32 numbers >= 0 that do not fall, and
    row[k − 1] < row[k] in the row of stage k. A speed may be −∞ at j < k (never lower so far) and +∞ at j >= k (never
    raise so far).

    Raises `InvalidTable`.
    """

    sensor: int
    axle: int
    path_m: float
    switching_m_s: tuple[Row, ...]

    def __post_init__(self) -> None:
        require_count(self.sensor, "passages.sensor", 0)
        require_count(self.axle, "passages.axle", 0)
        require_between(self.path_m, "passages.path_m", *PATH_RANGE_M)
        require_tuple(self.switching_m_s, "passages.switching_m_s")
        highest = len(self.switching_m_s) - 1
        for stage, row in enumerate(self.switching_m_s):
            key = f"{self._key}.switching_m_s[{stage}]"
            require_tuple(row, key, highest)
            for index, speed in enumerate(row):
                _require_speed(speed, f"{key}[{index}]", -math.inf if index < stage else math.inf)
            if any(later < earlier for earlier, later in pairwise(row)):
                raise InvalidTable(f"{key} is {row!r}, but its speeds must not fall.")
            if 0 < stage < highest and not row[stage - 1] < row[stage]:
                raise InvalidTable(
                    f"{key} is {row!r}, but its speed {stage - 1}, below which the stage is lowered, must be less than "
                    f"its speed {stage}, above which it is raised."
                )

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
