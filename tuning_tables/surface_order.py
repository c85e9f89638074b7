"""The guarantee of `line_order` for surfaces: at no path and no pressure does a stage ask to be lowered and raised.

A surface is evaluated in float32 as line(s) + slope * x, x = P - P_k. To the error of the line come those of the
difference, of the product and of the sum; so it differs from the exact value by at most

    gamma(2 r + 1) * sum |c_i| S^i + gamma(3) * |slope| X,   |x| <= X

and what underflow loses. The exact gap between two surfaces is linear in x, so it is least at an end of the pressures:
there both are lines with another constant coefficient.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import InvalidTable
from tuning_tables.line_order import (
    DOUBLE_PRECISION_ALLOWANCE,
    SMALLEST_STEP,
    UNIT_ROUNDOFF,
    require_order,
    require_representable,
    rounding_bound,
    smallest_gap,
)
from tuning_tables.stage import SIDES, Line, Stage

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
