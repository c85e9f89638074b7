"""The guarantee that at no point of the path a stage asks to be lowered and raised at once, float32 rounding included.

A line is evaluated in float32 by Horner's rule. Its result differs from the exact polynomial by at most

    gamma(2 r) * sum |c_i| S^i,   gamma(n) = n u / (1 - n u),   u = 2^-24,   |s| <= S

(N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., eq. 5.3), plus what underflow loses. The lines
keep their order for certain when the smallest gap of the exact polynomials exceeds the sum of both bounds.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.polynomial import polynomial

from tuning_tables.errors import InvalidTable

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
