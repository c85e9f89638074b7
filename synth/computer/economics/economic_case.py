"""From prices, traffic and the figures of two humps to what the new control saves, item by item, and to the pay-
back: the whole calculation, with its inputs by name.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from synth.computer.economics.hump_work import HOURS_PER_DAY, HumpWork, hump_work
from synth.computer.economics.investment import (
    InternalRate,
    Investment,
    PayBack,
    Terms,
    discounted_pay_back_years,
    internal_rate,
    net_present_value,
    pay_back,
    yearly_effect,
)
from synth.computer.economics.traffic import Handling, HumpChange, HumpRates, Prices, Traffic, rates_after
from synth.frame.settings.section import Section


@dataclass(frozen=True)
class Item:
    """One saving: `quantity` in `unit` (a year, or set free once) times its mean `price` is `amount`, in the currency.

    A negative amount is a loss.
    """

    name: str
    quantity: float
    unit: str
    price: float

    @property
    def amount(self) -> float:
        """Money."""
        return self.quantity * self.price


def total(items: tuple[Item, ...]) -> float:
    """All amounts together."""
    return sum(item.amount for item in items)


def operating_savings(
    today: HumpWork, new: HumpWork, traffic: Traffic, prices: Prices, fixed_per_year: float = 0.0
) -> tuple[Item, ...]:
    """ΔE, a year, after the list of Mukha's method in [hump-computer-1970s], and damages, sorting again and gaps.

    `fixed_per_year`: what does not depend on the work of the hump (staff, energy). The source gives the list alone; the
    quantities are ours. Time of locomotives is priced by hour, wherever it is spent; no hour is counted twice.
    """
    days = traffic.days_per_year

    def saved(name: str, figure: str, unit: str, price: float) -> Item:
        return Item(name, days * (getattr(today, figure) - getattr(new, figure)), unit, price)

    hour = prices.per_locomotive_h
    return (
        Item("what does not depend on the work of the hump", 1.0, "year", fixed_per_year),
        saved("cars: shorter humping", "car_h_humping", "car h", prices.per_car_h),
        saved("cars: shorter wait for humping", "car_h_waiting", "car h", prices.per_car_h),
        saved("locomotive: shorter humping", "locomotive_h_humping", "locomotive h", hour),
        saved("locomotive: gaps pushed up", "locomotive_h_pushing_up", "locomotive h", hour),
        saved("locomotive: cuts sorted again", "locomotive_h_sorting_again", "locomotive h", hour),
        saved("damage: couplings to 1.5 m/s", "over_speeds_to_1_5", "couplings", prices.per_over_speed_to_1_5),
        saved("damage: couplings to 2 m/s", "over_speeds_to_2", "couplings", prices.per_over_speed_to_2),
        saved("damage: couplings above 2 m/s", "over_speeds_above_2", "couplings", prices.per_over_speed_above_2),
        saved("catch-ups", "catch_ups", "cuts", prices.per_catch_up),
        saved("cuts sorted again, besides the locomotive", "misrouted", "cuts", prices.per_misrouted_cut),
        saved("gaps pushed up, besides the locomotive", "gap_m", "m", prices.per_gap_m),
    )


def released_capital(today: HumpWork, new: HumpWork, traffic: Traffic, prices: Prices) -> tuple[Item, ...]:
    """ΔK, once: cars that are no longer needed, and the cargo in them.

    Cars in the yard = N·Δt/24 with N cars a day and Δt hours less for each (Little's law): the car hours of a day / 24.
    Cargo in transit: the same cars × share of loaded ones × load × worth of a tonne.
    """
    cars = (today.car_h - new.car_h) / HOURS_PER_DAY
    return (
        Item("released cars", cars, "cars", prices.per_car),
        Item("cargo in transit", cars * traffic.loaded_share * traffic.load_t, "t", prices.per_cargo_t),
    )


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
