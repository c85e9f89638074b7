"""Numbers as a reader wants them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

ABSENT = "–"


def speed(value_m_s: float) -> str:
    """A speed error in m/s, to a tenth of a millimetre a second."""
    return f"{value_m_s:.4f}" if math.isfinite(value_m_s) else ABSENT


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


def quotient_interval(ends: tuple[float, float], digits: int = 2) -> str:
    """A confidence interval of a ratio; '' for none."""
    return f"[{ends[0]:.{digits}f}, {ends[1]:.{digits}f}]" if math.isfinite(ends[0]) else ""


def in_ten_thousand(share: float, ends: tuple[float, float]) -> str:
    """A probability as cuts in 10 000, with its interval."""
    low, most, high = (few(1e4 * each) for each in (ends[0], share, ends[1]))
    return f"{most} [{low}, {high}]" if share else f"fewer than {high}"


def plus_minus(value: float | None, ends: Sequence[float | None] | None, digits: int = 2) -> str:
    """A figure with the wider half of its 95 % interval, which is never printed as 0; None is what is not known."""
    if value is None or ends is None or ends[0] is None or ends[1] is None:
        return ABSENT
    return f"{value:.{digits}f} ±{max(value - ends[0], ends[1] - value, 0.1**digits):.{digits}f}"


def ten_thousand(share: float, ends: Sequence[float | None]) -> str:
    """A probability as cuts in 10 000, with the wider half of its 95 % interval; where no pass met one, a bound."""
    low, high = (1e4 * (end or 0.0) for end in ends)
    if share == 0.0:
        return f"below {few(high)}"
    return f"{few(1e4 * share)} ±{few(max(1e4 * share - low, high - 1e4 * share))}"


def of_ten_thousand(share: float) -> str:
    """A share as cuts of 10 000."""
    return few(1e4 * share) if math.isfinite(share) else three_figures(share)


def few(number: float) -> str:
    """A number of cuts: two figures below 10."""
    return f"{number:#.2g}" if number < 9.95 else f"{number:.0f}"


def span(values: Sequence[float], form: str = ".2f") -> str:
    """'from a to b', or the one value where both read the same."""
    low, high = format(min(values), form), format(max(values), form)
    return low if low == high else f"from {low} to {high}"


def counted(number: int, noun: str, plural: str = "") -> str:
    """'1 case', '3 cases'."""
    return f"{number} {noun}" if number == 1 else f"{number} {plural or noun + 's'}"


def three_figures(value: float) -> str:
    """Three figures, all of them before the point where there are more."""
    if not math.isfinite(value):
        return ABSENT if math.isnan(value) else "∞" if value > 0.0 else "−∞"
    return f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:.3g}"


def whole(value: float) -> str:
    """A number without decimals, its thousands apart."""
    return f"{value:,.0f}" if math.isfinite(value) else three_figures(value)


def decimals(digits: int) -> Callable[[float], str]:
    """So many digits behind the point."""
    return lambda value: f"{value:.{digits}f}" if math.isfinite(value) else three_figures(value)


def per_cent(value: float) -> str:
    """A share in per cent, three figures; the unit stands in the cell."""
    return f"{100.0 * value:.3g} %" if math.isfinite(value) else three_figures(value)


def four_figures(value: float) -> str:
    """As many as the ends of an interval need."""
    return f"{value:.4g}"


def six_figures(value: float) -> str:
    """Six figures, all of them before the point where there are more; thousands apart."""
    if not math.isfinite(value):
        return three_figures(value)
    return whole(value) if abs(value) >= 1e5 else f"{value:,.6g}"
