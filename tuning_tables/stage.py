"""A pressure stage of the retarder with the two lines at which the regulator leaves it, and the guarantee that at
no point of the path, and for surfaces at no pressure, a stage asks to be lowered and raised at once.

The guarantee that at no point of the path a stage asks to be lowered and raised at once, float32 rounding included. A
line is evaluated in float32 by Horner's rule. Its result differs from the exact polynomial by at most

    gamma(2 r) * sum |c_i| S^i,   gamma(n) = n u / (1 - n u),   u = 2^-24,   |s| <= S

(N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., eq. 5.3), plus what underflow loses. The lines
keep their order for certain when the smallest gap of the exact polynomials exceeds the sum of both bounds.

The guarantee of `line_order` for surfaces: at no path and no pressure does a stage ask to be lowered and raised. A
surface is evaluated in float32 as line(s) + slope * x, x = P - P_k. To the error of the line come those of the
difference, of the product and of the sum; so it differs from the exact value by at most

    gamma(2 r + 1) * sum |c_i| S^i + gamma(3) * |slope| X,   |x| <= X

and what underflow loses. The exact gap between two surfaces is linear in x, so it is least at an end of the pressures:
there both are lines with another constant coefficient.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Final, TypeAlias

import numpy as np
import numpy.typing as npt
from numpy.polynomial import polynomial

from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Count, Number, Row
from tuning_tables.errors import InvalidTable, require_count

UNIT_ROUNDOFF: Final = 2.0**-24
SMALLEST_STEP: Final = 2.0**-149
LARGEST_FLOAT32: Final = float(np.finfo(np.float32).max)
# The bound itself and the gap are computed in double precision, whose roundoff is 2^-29 of that of float32: a millionth
# on top outweighs it, and with it the (backward stable) error of the roots, at which the gap is stationary anyway.
DOUBLE_PRECISION_ALLOWANCE: Final = 1.0 + 1e-6


def require_representable(line: tuple[float, ...], s_range_m: tuple[float, float], key: str) -> None:
    """No intermediate value of `line` on the range can leave the float32 numbers; raises `InvalidTable`."""
    # No partial result of Horner's rule exceeds sum |c_i| max(1, S)^i, up to roundoff: hence the half.
    if not polynomial.polyval(max(1.0, _reach(s_range_m)), np.abs(line)) < LARGEST_FLOAT32 / 2:
        raise InvalidTable(f"{key} is {line!r}, which exceeds the float32 range for s_m in {s_range_m!r}.")


def require_order(lower: tuple[float, ...], upper: tuple[float, ...], s_range_m: tuple[float, float], key: str) -> None:
    """`lower` lies below `upper` on the whole range, however float32 rounds them; raises `InvalidTable`."""
    gap_m_s, s_m = smallest_gap(lower, upper, s_range_m)
    needed_m_s = rounding_bound(lower, s_range_m) + rounding_bound(upper, s_range_m)
    if not gap_m_s > needed_m_s:
        raise InvalidTable(
            f"{key}: upper - lower is {gap_m_s!r} m/s at s_m = {s_m!r}, but it must exceed {needed_m_s!r} "
            f"for all s_m in {s_range_m!r}; fit the two lines further apart."
        )


def smallest_gap(
    lower: tuple[float, ...], upper: tuple[float, ...], s_range_m: tuple[float, float]
) -> tuple[float, float]:
    """The least upper(s) - lower(s) in m/s over the range, and an s in m where it is attained."""
    # With s = scale * t, |t| <= 1, the coefficients are of comparable size; a power of two makes the change exact.
    scale_m = 2.0 ** np.ceil(np.log2(_reach(s_range_m)))
    difference = (np.array(upper) - np.array(lower)) * scale_m ** np.arange(len(lower))
    ends = np.array(s_range_m) / scale_m
    # Real parts of complex roots are no extrema, but one more point can only lower the minimum that is taken.
    slope = polynomial.polyder(difference)
    # A last coefficient next to nothing spoils all roots; without it they hardly move, where the gap is stationary.
    trimmed = polynomial.polytrim(slope, 2.0**-26 * float(np.abs(slope).max(initial=0.0)))
    with np.errstate(over="ignore", invalid="ignore"):
        roots = np.concatenate([polynomial.polyroots(each) for each in (slope, trimmed)]).real
    stationary = roots[np.isfinite(roots)]
    candidates = np.concatenate([ends, np.clip(stationary, ends[0], ends[1])])
    gaps = polynomial.polyval(candidates, difference)
    least = int(np.argmin(gaps))
    return float(gaps[least]), float(candidates[least] * scale_m)


def rounding_bound(line: tuple[float, ...], s_range_m: tuple[float, float]) -> float:
    """The largest error, m/s, that float32 Horner evaluation can make on `line` over the range."""
    degree = len(line) - 1
    gamma = 2 * degree * UNIT_ROUNDOFF / (1 - 2 * degree * UNIT_ROUNDOFF)
    underflow = degree * max(1.0, _reach(s_range_m)) ** degree * SMALLEST_STEP
    return (gamma * _magnitude(line, s_range_m) + underflow) * DOUBLE_PRECISION_ALLOWANCE


def _magnitude(line: tuple[float, ...], s_range_m: tuple[float, float]) -> float:
    """sum |c_i| S^i."""
    return float(polynomial.polyval(_reach(s_range_m), np.abs(line)))


def _reach(s_range_m: tuple[float, float]) -> float:
    return max(abs(s_range_m[0]), abs(s_range_m[1]))


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


Range = tuple[float, float]

NO_PRESSURE: Final = (0.0, 0.0)
"""Of stages without slopes: they are the same at every pressure."""


def range_above(pressures: npt.NDArray[np.float32], highest_raised: int, stage: int) -> Range:
    """The lowest and the highest pressure that the surfaces of `stage` are asked at, less the pressure of the stage.

    pressures float32 (K+1,), kPa. The range holds 0 also at a stage above `highest_raised`, the highest stage that the
    table raises to: the pressure of a silent gauge counts as that of the stage.
    """
    own, lowest, highest = (float(pressures[k]) for k in (stage, 0, highest_raised))
    return lowest - own, max(highest - own, 0.0)


def require_stage(stage: Stage, s_range_m: Range, above_kpa: Range, key: str) -> None:
    """Both lines or surfaces of `stage` stay float32 numbers and keep their order; raises `InvalidTable`.

    `above_kpa`: what `range_above` gives, or `NO_PRESSURE`.
    """
    for side, line, slope in zip(SIDES, stage.lines, stage.slopes, strict=True):
        if line is not None:
            reach = (abs(line[0]) + abs(slope or 0.0) * reach_kpa(above_kpa), *line[1:])
            require_representable(reach, s_range_m, f"{key}.{side}")
    if stage.lower is None or stage.upper is None:
        return
    if stage.slopes == (None, None):
        require_order(stage.lower, stage.upper, s_range_m, key)
        return
    gap_m_s = stage_gap(stage, s_range_m, above_kpa)
    needed_m_s = sum(
        surface_bound(line, slope or 0.0, s_range_m, above_kpa)
        for line, slope in zip((stage.lower, stage.upper), stage.slopes, strict=True)
    )
    if not gap_m_s > needed_m_s:
        raise InvalidTable(
            f"{key}: upper - lower comes down to {gap_m_s!r} m/s, but it must exceed {needed_m_s!r} for all s_m in "
            f"{s_range_m!r} and all pressures from {above_kpa[0]:g} to {above_kpa[1]:g} kPa above that of the stage; "
            "fit the two surfaces further apart."
        )


def stage_gap(stage: Stage, s_range_m: Range, above_kpa: Range) -> float:
    """The least V_hi - V_lo of a stage that has both, m/s, exact, over the path and the pressures."""
    gaps = []
    for kpa in above_kpa:
        lower, upper = (
            (line[0] + (slope or 0.0) * kpa, *line[1:])
            for line, slope in zip(stage.lines, stage.slopes, strict=True)
            if line is not None
        )
        gaps.append(smallest_gap(lower, upper, s_range_m)[0])
    return min(gaps)


def surface_bound(line: Line, slope: float, s_range_m: Range, above_kpa: Range) -> float:
    """The largest error, m/s, that the evaluation of a surface in float32 can make."""
    if above_kpa == NO_PRESSURE:
        return rounding_bound(line, s_range_m)
    rise = abs(slope) * reach_kpa(above_kpa)
    sizes = sum(abs(value) * max(map(abs, s_range_m)) ** power for power, value in enumerate(line))
    further = (gamma(3) * rise + gamma(1) * sizes + SMALLEST_STEP) * DOUBLE_PRECISION_ALLOWANCE
    # gamma(2 r) + gamma(1) + gamma(2 r) gamma(1) <= gamma(2 r + 1)
    return (1.0 + gamma(1)) * rounding_bound(line, s_range_m) + further


def gamma(operations: int) -> float:
    """What so many roundings can change, relatively."""
    return operations * UNIT_ROUNDOFF / (1 - operations * UNIT_ROUNDOFF)


def reach_kpa(above_kpa: Range) -> float:
    """X: the farthest from the pressure of the stage."""
    return max(map(abs, above_kpa))
