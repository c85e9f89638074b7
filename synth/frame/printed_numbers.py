"""Numbers as a reader wants them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

ABSENT = "–"


def speed(value_m_s: float) -> str:
    """A speed error in m/s, to a tenth of a millimetre a second."""
    return f"{value_m_s:.4f}" if math.isfinite(value_m_s) else ABSENT


def percent(share: float) -> str:
    """A probability in per cent, two figures where it is small."""
    if share == 0.0:
        return "0"
    return f"{100.0 * share:.2g}" if share < 0.1 else f"{100.0 * share:.1f}"


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


def ranges(numbers: Sequence[int]) -> str:
    """Increasing numbers with runs as '401 to 408'."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(str(first) if first == last else f"{first} to {last}" for first, last in runs)


def counted(number: int, noun: str, plural: str = "") -> str:
    """'1 case', '3 cases'."""
    return f"{number} {noun}" if number == 1 else f"{number} {plural or noun + 's'}"


def three_figures(value: float) -> str:
    """Three figures, all of them before the point where there are more."""
    if not math.isfinite(value):
        return ABSENT if math.isnan(value) else "∞" if value > 0.0 else "−∞"
    return f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:.3g}"


def amount(value: float) -> str:
    """Three figures of an amount of money: 312, 9.12k, 1.92M."""
    if not math.isfinite(value):
        return three_figures(value)
    rounded = float(f"{value:.3g}")
    for factor, letter in ((1e6, "M"), (1e3, "k")):
        if abs(rounded) >= factor:
            return f"{three_figures(rounded / factor)}{letter}"
    return f"{rounded:g}"


def as_known(value: float, low: float, high: float) -> float:
    """`value` with no more figures than it is known to: the last counts a tenth of the first of `high` − `low`."""
    spread = abs(high - low)
    if spread == 0.0 or not math.isfinite(spread) or not math.isfinite(value):
        return value
    return round(value, 1 - math.floor(math.log10(spread)))


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
