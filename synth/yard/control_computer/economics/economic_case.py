"""From prices, traffic and the figures of two humps to the pay-back: the whole calculation, with its inputs by name."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import TypeVar

from plant_models.errors import PlantError, require, require_between
from synth.yard.control_computer.economics.hump_rates import HumpChange, HumpRates, changed
from synth.yard.control_computer.economics.hump_work import HumpWork, hump_work
from synth.yard.control_computer.economics.internal_rate import InternalRate, internal_rate
from synth.yard.control_computer.economics.pay_back import (
    TRAPEZNIKOV_INTEREST_PER_YEAR,
    PayBack,
    pay_back,
    yearly_effect,
)
from synth.yard.control_computer.economics.present_value import (
    Investment,
    discounted_pay_back_years,
    net_present_value,
)
from synth.yard.control_computer.economics.prices import Prices
from synth.yard.control_computer.economics.savings import Item, operating_savings, released_capital, total
from synth.yard.control_computer.economics.traffic import Handling, Traffic

_T = TypeVar("_T")


@dataclass(frozen=True)
class Terms:
    """What the new control costs, and by which terms it is judged.

    `investment`: ΔA, what it costs more than what it replaces. `running_cost_per_year`: Sг, upkeep more than today and
    losses by failures. `fixed_saving_per_year`: see `operating_savings`. `normative_efficiency_per_year`: Eн.
    `cashed_share`: part of the released capital that is sold at the start; the rest is worth Eн a year. Pay-back
    counts all of it by Eн, as its formula does. `PlantError` for a value outside its range.
    """

    investment: float
    running_cost_per_year: float
    fixed_saving_per_year: float
    normative_efficiency_per_year: float
    discount_per_year: float
    years: int
    cashed_share: float = 0.0
    interest_per_year: float = TRAPEZNIKOV_INTEREST_PER_YEAR

    def __post_init__(self) -> None:
        for name in ("investment", "running_cost_per_year", "fixed_saving_per_year"):
            require_between(name, getattr(self, name), -1e15, 1e15)
        require_between("normative_efficiency_per_year", self.normative_efficiency_per_year, 0.0, 1.0)
        require_between("discount_per_year", self.discount_per_year, 0.0, 1.0)
        require_between("cashed_share", self.cashed_share, 0.0, 1.0)
        require_between("interest_per_year", self.interest_per_year, 0.0, 1.0)
        require(1 <= self.years <= 200, f"years is {self.years!r}; it must be from 1 to 200")


@dataclass(frozen=True)
class EconomicCase:
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
        return internal_rate(self.money.flows)

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
    new = hump_work(changed(case.today, case.change), case.traffic, case.handling)
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


def with_inputs(value: _T, inputs: Mapping[str, float]) -> _T:
    """`value`, a frozen dataclass, with other numbers: `{"prices.per_car_h": 2.0}` goes into its parts by their names.

    A field that is a whole number takes the nearest one. `PlantError` for a name that is none of its numbers.
    """
    known = names_of(value)
    parts: dict[str, dict[str, float]] = {}
    given: dict[str, object] = {}
    for name, number in inputs.items():
        head, _, rest = name.partition(".")
        held = getattr(value, head, None) if head in known else None
        require(
            (is_dataclass(held) and bool(rest)) or (isinstance(held, int | float) and not rest),
            f"{name!r} is no input of {type(value).__name__}; it has {', '.join(known)}",
        )
        if rest:
            parts.setdefault(head, {})[rest] = number
        else:
            given[head] = round(number) if isinstance(held, int) else number
    for head, inner in parts.items():
        given[head] = with_inputs(getattr(value, head), inner)
    return replace(value, **given)  # type: ignore[type-var]  # a dataclass, or its names would be empty


def names_of(value: object) -> tuple[str, ...]:
    """The fields of a dataclass instance."""
    if not is_dataclass(value):
        raise PlantError(f"{type(value).__name__} has no named inputs")
    return tuple(field.name for field in fields(value))
