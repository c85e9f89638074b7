"""From prices, traffic and the figures of two humps to the pay-back: the whole calculation, with its inputs by name."""

from __future__ import annotations

import math
from dataclasses import dataclass

from synth.computer.economics.hump_rates import HumpChange, HumpRates, rates_after
from synth.computer.economics.hump_work import HumpWork, hump_work
from synth.computer.economics.internal_rate import InternalRate, internal_rate
from synth.computer.economics.pay_back import (
    PayBack,
    pay_back,
    yearly_effect,
)
from synth.computer.economics.present_value import (
    Investment,
    discounted_pay_back_years,
    net_present_value,
)
from synth.computer.economics.prices import Prices
from synth.computer.economics.savings import Item, operating_savings, released_capital, total
from synth.computer.economics.terms import Terms
from synth.computer.economics.traffic import Handling, Traffic
from synth.frame.settings.section import Section


class EconomicCase(Section):
    """All inputs of the calculation; `change`: figures of the hump with the new control less those of `today`."""

    prices: Prices
    traffic: Traffic
    handling: Handling
    today: HumpRates
    change: HumpChange
    terms: Terms


@dataclass(frozen=True)
class EconomicResult:
    """What `evaluated` found; `savings` is ΔE a year, `capital` ΔK, `effect_per_year` B.

    `money`: what is spent and comes in for NPV, discounted pay-back and internal rate."""

    today: HumpWork
    new: HumpWork
    savings: tuple[Item, ...]
    capital: tuple[Item, ...]
    effect_per_year: float
    pay_back: PayBack
    money: Investment
    net_present_value: float
    discounted_pay_back_years: float | None

    @property
    def internal_rate(self) -> InternalRate:
        """The internal rate of return of `money`; sought when it is asked for, as draws do not ask."""
        return internal_rate(self.money)

    def figures(self) -> dict[str, float]:
        """The results by name; a time that never comes is infinite, so it can be ranked among draws."""
        return {
            "savings_per_year": total(self.savings),
            "released_capital": total(self.capital),
            "effect_per_year": self.effect_per_year,
            "pay_back_rate_per_year": self.pay_back.rate_per_year,
            "pay_back_years": math.inf if self.pay_back.years is None else self.pay_back.years,
            "net_present_value": self.net_present_value,
            "discounted_pay_back_years": (
                math.inf if self.discounted_pay_back_years is None else self.discounted_pay_back_years
            ),
        }


def evaluated(case: EconomicCase) -> EconomicResult:
    """The calculation; `PlantError` where a hump is overloaded, today's or the new one."""
    terms = case.terms
    today = hump_work(case.today, case.traffic, case.handling)
    new = hump_work(rates_after(case.today, case.change), case.traffic, case.handling)
    savings = operating_savings(today, new, case.traffic, case.prices, terms.fixed_saving_per_year)
    capital = released_capital(today, new, case.traffic, case.prices)
    gain, freed = total(savings), total(capital)
    effect = yearly_effect(gain, freed, terms.normative_efficiency_per_year, terms.running_cost_per_year)
    cashed = terms.cashed_share * freed
    money = Investment(
        spent=terms.investment - cashed,
        income_per_year=effect - terms.normative_efficiency_per_year * cashed,
        years=terms.years,
    )
    return EconomicResult(
        today=today,
        new=new,
        savings=savings,
        capital=capital,
        effect_per_year=effect,
        pay_back=pay_back(terms.investment, effect, terms.interest_per_year),
        money=money,
        net_present_value=net_present_value(money, terms.discount_per_year),
        discounted_pay_back_years=discounted_pay_back_years(money, terms.discount_per_year),
    )
