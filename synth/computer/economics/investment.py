"""What an investment pays back: terms, pay-back time in the form of Trapeznikov, as [hump-computer-1970s] uses it,
present value, internal rate of return.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.library.sourced_value import JUDGEMENT
from synth.computer.origins import MONEY, USUAL
from synth.frame.printed_numbers import amount
from synth.frame.settings.section import Section, setting

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


class Terms(Section):
    """What the new control costs, and by which terms it is judged.

    Pay-back counts all released capital by the normative efficiency, as its formula does.
    """

    investment: float = setting(1_000_000.0, "currency", -1e15, 1e15, "what it costs more than what it replaces", USUAL)
    running_cost_per_year: float = setting(
        100_000.0, "currency/a", -1e15, 1e15, "upkeep more than today, losses by failures left out", USUAL
    )
    fixed_saving_per_year: float = setting(
        150_000.0, "currency/a", -1e15, 1e15, "what is saved whatever the traffic", f"{JUDGEMENT}: staff"
    )
    normative_efficiency_per_year: float = setting(
        0.12, "1/a", 0.0, 1.0, "yearly worth of released capital", f"{MONEY}: 0.12 to 0.15"
    )
    discount_per_year: float = setting(0.05, "1/a", 0.0, 1.0, "discount of later money", USUAL)
    years: int = setting(15, "a", 1, 200, "life of the computer", USUAL)
    cashed_share: float = setting(
        0.0, "1", 0.0, 1.0, "part of the released capital that is sold at the start", f"{JUDGEMENT}: none"
    )
    interest_per_year: float = setting(
        TRAPEZNIKOV_INTEREST_PER_YEAR, "1/a", 0.0, 1.0, "simple interest of the pay-back formula", MONEY
    )


@dataclass(frozen=True)
class Investment:
    """`spent` at the start, `income_per_year` at the end of each of `years` years; real money, without inflation.

    What is received at the start (released capital that is sold) is part of `spent`, which may be negative then.
    """

    spent: float
    income_per_year: float
    years: int

    @property
    def flows(self) -> tuple[float, ...]:
        """What comes in at the start and at the end of each year."""
        return (-self.spent, *(self.income_per_year for _ in range(self.years)))


def annuity(discount_per_year: float, years: float) -> float:
    """Present value of 1 at the end of each year: (1 − (1 + r)^−n)/r; n for r = 0. `years` need not be whole."""
    if discount_per_year == 0.0:
        return years
    return -math.expm1(-years * math.log1p(discount_per_year)) / discount_per_year


def net_present_value(investment: Investment, discount_per_year: float) -> float:
    """NPV = −spent + income·(1 − (1 + r)^−n)/r."""
    return -investment.spent + investment.income_per_year * annuity(discount_per_year, investment.years)


def discounted_pay_back_years(investment: Investment, discount_per_year: float) -> float | None:
    """When the discounted income has paid what was spent: n = −ln(1 − r·I/B)/ln(1 + r).

    None where it never does, however long the income lasts (B ≤ r·I); it may be longer than `years`. 0 where
    nothing was spent and nothing is lost. Within a year the income is taken to come as the formula goes on between
    whole years.
    """
    spent, income = investment.spent, investment.income_per_year
    if spent <= 0.0:
        return 0.0 if income >= 0.0 else None
    if income <= discount_per_year * spent:
        return None
    if discount_per_year == 0.0:
        return spent / income
    return -math.log1p(-discount_per_year * spent / income) / math.log1p(discount_per_year)


WIDEST = 700.0
"""ln(1 + r) is sought within ± this; beyond it 1 + r is no double."""


@dataclass(frozen=True)
class InternalRate:
    """`per_year`: the rate at which the flows are worth nothing, None where there is none; `statement`: in words."""

    per_year: float | None
    statement: str


def internal_rate(investment: Investment) -> InternalRate:
    """IRR of what is spent and of the income of each year, any rate above −1.

    Where money goes both ways its worth has one root, by the rule of Descartes: the flows change their sign once.
    """
    if investment.spent * investment.income_per_year <= 0.0:
        return InternalRate(None, "There is no internal rate: money goes one way only.")
    rate = root(investment.flows)
    return InternalRate(rate, f"The internal rate is {100.0 * rate:.3g} % a year.")


def root(flows: Sequence[float]) -> float:
    """The rate at which `flows` at the start and at the end of each year are worth nothing.

    Sought in x = ln(1 + r), from where the last flow decides to where the first one does. A worth is scaled by its
    largest discount, so nothing overflows.
    """
    from scipy.optimize import brentq  # start-up: scipy only where it is needed

    years = np.flatnonzero(flows)
    held = np.asarray(flows, dtype=float)[years]

    def worth(x: float) -> float:
        exponent = -years * x
        return float((held * np.exp(exponent - exponent.max())).sum())

    found = brentq(worth, -WIDEST, WIDEST, xtol=1e-14, rtol=8.9e-16)
    return math.expm1(float(found))
