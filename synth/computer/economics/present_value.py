"""Present value of an investment with the same income every year, and its discounted pay-back time."""

from __future__ import annotations

import math
from dataclasses import dataclass


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
