"""A pressure stage of the retarder with the two lines at which the regulator leaves it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_between, require_count, require_finite, require_tuple


@dataclass(frozen=True)
class Stage:
    """Stage `k` at `pressure_kpa` (gauge, >= 0), and its switching lines V(s) = c0 + c1 s + ... in m/s, s in m.

    Below `lower` the regulator goes to stage k-1, above `upper` to stage k+1; None: no such command at this stage.
    Every coefficient must be a float32 number (see `round_coefficients`), so that no reader rounds it once more.

    Raises `InvalidTable`.
    """

    k: int
    pressure_kpa: float
    lower: tuple[float, ...] | None
    upper: tuple[float, ...] | None

    def __post_init__(self) -> None:
        require_count(self.k, "stages.k", 0)
        require_between(self.pressure_kpa, f"stages[{self.k}].pressure_kpa", 0.0)
        if self.lower is not None:
            _require_line(self.lower, f"stages[{self.k}].lower")
        if self.upper is not None:
            _require_line(self.upper, f"stages[{self.k}].upper")


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


def _require_line(line: tuple[float, ...], key: str) -> None:
    require_tuple(line, key)
    for power, coefficient in enumerate(line):
        require_finite(coefficient, f"{key}[{power}]")
        with np.errstate(over="ignore"):
            nearest = float(np.float32(coefficient))
        if nearest != coefficient:
            raise InvalidTable(
                f"{key}[{power}] is {coefficient!r}, which float32 cannot hold (nearest: {nearest!r}); "
                "round it with round_coefficients."
            )
