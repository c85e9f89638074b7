"""A pressure stage of the retarder with the two lines at which the regulator leaves it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Final, TypeAlias

import numpy as np

from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Count, Number, Row
from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_count

Line: TypeAlias = tuple[float, ...]

SIDES: Final = ("lower", "upper")
MOST_STAGES: Final = 32
HIGHEST_DEGREE: Final = 9


def coefficients(meaning: str) -> Row:
    """The coefficients of a line, in ascending powers of the path."""
    return Row(Number(meaning, is_single=True, unit="m/s per m^power"), "power", 1, HIGHEST_DEGREE + 1)


def slope(side: str) -> Number:
    """How fast a line rises with the pressure above that of its stage."""
    return Number(f"rise of the {side} line with the pressure; null: none", is_single=True)


@dataclass(frozen=True)
class Stage:
    """A pressure stage, with its switching lines V(s) = c0 + c1 s + ... in m/s, s in m.

    Below `lower` the regulator goes to stage k-1, above `upper` to stage k+1; None: no such command at this stage.
    Every coefficient must be a float32 number (see `round_coefficients`), so that no reader rounds it once more.

    A line with a slope is a surface, V(s, P) = V(s) + slope (P - P_k), for the pressure P that the gauge shows and that
    of the stage, P_k. None: the line is the same at every pressure.

    Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables import Stage
    >>> stage = Stage(k=1, pressure_kpa=300.0, lower=(4.0, -0.0625), upper=None)
    >>> stage.lines
    ((4.0, -0.0625), None)
    """

    k: Annotated[int, Count("number of the stage, as its place", 0, MOST_STAGES - 1)]
    pressure_kpa: Annotated[float, Number("gauge pressure of the stage, above that of the stage below", 0.0)]
    lower: Annotated[Line | None, coefficients("below this line go a stage down; null: never")]
    upper: Annotated[Line | None, coefficients("above this line go a stage up; null: never")]
    lower_slope_m_s_per_kpa: Annotated[float | None, slope("lower")] = None
    upper_slope_m_s_per_kpa: Annotated[float | None, slope("upper")] = None

    def __post_init__(self) -> None:
        require_count(self.k, "stages.k", 0, MOST_STAGES - 1)
        require_declared(self, f"stages[{self.k}]")
        for side, line, rise in zip(SIDES, self.lines, self.slopes, strict=True):
            if rise is not None and line is None:
                raise InvalidTable(
                    f"stages[{self.k}].{side}_slope_m_s_per_kpa is given, but stages[{self.k}].{side} is null: there "
                    "is no line to slope."
                )

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
