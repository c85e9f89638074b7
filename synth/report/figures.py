"""Numbers as a reader wants them."""

from __future__ import annotations

import math
from collections.abc import Sequence

ABSENT = "–"


def speed(value_m_s: float) -> str:
    """A speed error in m/s, to the millimetre."""
    return f"{value_m_s:.3f}" if math.isfinite(value_m_s) else ABSENT


def quotient(value: float, digits: int = 2) -> str:
    """A ratio."""
    return f"{value:.{digits}f}" if math.isfinite(value) else ABSENT


def percent(share: float) -> str:
    """A probability in per cent, two figures where it is small."""
    if share == 0.0:
        return "0"
    return f"{100.0 * share:.2g}" if share < 0.1 else f"{100.0 * share:.1f}"


def interval(ends: tuple[float, float]) -> str:
    """A confidence interval of a speed."""
    return f"[{speed(ends[0])}, {speed(ends[1])}]"


def span(values: Sequence[float], form: str = ".2f") -> str:
    """'from a to b', or the one value where both read the same."""
    low, high = format(min(values), form), format(max(values), form)
    return low if low == high else f"from {low} to {high}"


def counted(number: int, noun: str) -> str:
    """'1 case', '3 cases'."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
