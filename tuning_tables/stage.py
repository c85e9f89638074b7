"""A pressure stage of the retarder with the two lines at which the regulator leaves it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_between, require_count, require_finite, require_tuple

Line: TypeAlias = tuple[float, ...]

SIDES: Final = ("lower", "upper")


@dataclass(frozen=True)
class Stage:
    """Stage `k` at `pressure_kpa` (gauge, >= 0), and its switching lines V(s) = c0 + c1 s + ... in m/s, s in m.

    Below `lower` the regulator goes to stage k-1, above `upper` to stage k+1; None: no such command at this stage.
    Every coefficient must be a float32 number (see `round_coefficients`), so that no reader rounds it once more.

    A line with a slope is a surface, V(s, P) = V(s) + slope (P - P_k), for the pressure P that the gauge shows and that
    of the stage, P_k. The slopes are float32 numbers, too; None: the line is the same at every pressure.

    Raises `InvalidTable`.
    """

    k: int
    pressure_kpa: float
    lower: Line | None
    upper: Line | None
    lower_slope_m_s_per_kpa: float | None = None
    upper_slope_m_s_per_kpa: float | None = None

    def __post_init__(self) -> None:
        require_count(self.k, "stages.k", 0)
        require_between(self.pressure_kpa, f"stages[{self.k}].pressure_kpa", 0.0)
        if self.lower is not None:
            _require_line(self.lower, f"stages[{self.k}].lower")
        if self.upper is not None:
            _require_line(self.upper, f"stages[{self.k}].upper")
        for side, line, slope in zip(SIDES, self.lines, self.slopes, strict=True):
            key = f"stages[{self.k}].{side}_slope_m_s_per_kpa"
            if slope is not None:
                _require_float32(slope, key)
            if slope is not None and line is None:
                raise InvalidTable(f"{key} is given, but stages[{self.k}].{side} is null: there is no line to slope.")

    @property
    def lines(self) -> tuple[Line | None, Line | None]:
        """`lower` and `upper`."""
        return self.lower, self.upper

    @property
    def slopes(self) -> tuple[float | None, float | None]:
        """Those of `lines`, m/s per kPa."""
        return self.lower_slope_m_s_per_kpa, self.upper_slope_m_s_per_kpa


def round_coefficients(values: Iterable[float]) -> tuple[float, ...]:
    """The float32 number nearest to each of `values`, as Python floats (ties to even); zeros without a sign.

    Raises `InvalidTable` for a value that is not finite or exceeds the float32 range.
    """
    with np.errstate(over="ignore"):
        rounded = tuple(float(np.float32(value)) + 0.0 for value in values)  # -0.0 becomes 0.0
    for index, value in enumerate(rounded):
        if not math.isfinite(value):
            raise InvalidTable(f"coefficient {index} has no finite float32 value; rescale the line before rounding it.")
    return rounded


def _require_line(line: Line, key: str) -> None:
    require_tuple(line, key)
    for power, coefficient in enumerate(line):
        _require_float32(coefficient, f"{key}[{power}]")


def _require_float32(value: float, key: str) -> None:
    require_finite(value, key)
    with np.errstate(over="ignore"):
        nearest = float(np.float32(value))
    if nearest != value:
        raise InvalidTable(
            f"{key} is {value!r}, which float32 cannot hold (nearest: {nearest!r}); round it with round_coefficients."
        )
