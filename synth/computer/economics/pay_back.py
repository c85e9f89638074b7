"""Pay-back time in the form of Trapeznikov, as [hump-computer-1970s] uses it."""

from __future__ import annotations

from dataclasses import dataclass

from synth.frame.printed_numbers import amount

TRAPEZNIKOV_INTEREST_PER_YEAR = 0.25
"""Simple interest a year on what is invested, in the formula of the source."""


def yearly_effect(
    savings_per_year: float, released_capital: float, normative_efficiency_per_year: float, running_cost_per_year: float
) -> float:
    """B = ΔE + Eн·ΔK − Sг, in currency a year.

    Eн, the normative efficiency (0.12 to 0.15 a year), turns released capital into yearly worth. Sг: what the new
    system costs a year, its losses by failures included.
    """
    return savings_per_year + normative_efficiency_per_year * released_capital - running_cost_per_year


@dataclass(frozen=True)
class PayBack:
    """`years` until an investment is paid back, None where it never is; `rate_per_year` = 1/years.

    The rate is a number in both cases: 0 or less where it never pays back, so it goes through intervals and indices
    where years would be infinite. `statement` says it in a sentence.
    """

    years: float | None
    rate_per_year: float
    statement: str


def pay_back(
    investment: float, effect_per_year: float, interest_per_year: float = TRAPEZNIKOV_INTEREST_PER_YEAR
) -> PayBack:
    """T = ΔA / (B − E·ΔA): when B has paid the investment ΔA with simple interest E, ΔA·(1 + E·T) = B·T.

    It exists for B > E·ΔA only. Print of the source: ΔA = (ΔE + ΔK·Eн − Sг)·T/(1 + 0.25·T), the same solved for ΔA; it
    has the right dimension if 0.25 is per year. Without an investment (ΔA ≤ 0) it pays at once, unless B < 0.
    """
    if investment <= 0.0:
        return without_investment(investment, effect_per_year)
    needed = interest_per_year * investment
    rate = (effect_per_year - needed) / investment
    if rate <= 0.0:
        return PayBack(
            None,
            rate,
            f"It never pays back: the effect is {amount(effect_per_year)} a year, and {amount(investment)} at "
            f"{interest_per_year:.4g} a year asks for more than {amount(needed)}.",
        )
    return PayBack(1.0 / rate, rate, f"It pays back in {1.0 / rate:.3g} years.")


def without_investment(investment: float, effect_per_year: float) -> PayBack:
    """Where the new system costs no more than what it replaces."""
    if effect_per_year >= 0.0:
        return PayBack(0.0, float("inf"), "It pays back at once: it costs no more than what it replaces.")
    return PayBack(
        None,
        float("-inf"),
        f"It never pays back: it costs {amount(-investment)} less, but {amount(-effect_per_year)} more each year.",
    )
