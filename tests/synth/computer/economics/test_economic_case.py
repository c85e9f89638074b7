"""The whole calculation: consistent with its parts and its limits, and its inputs by name."""

from __future__ import annotations

import math

import pytest

from plant_models.errors import PlantError
from synth.computer.economics.economic_case import (
    EconomicCase,
    evaluated,
)
from synth.computer.economics.hump_rates import HumpChange
from synth.computer.economics.savings import total
from synth.computer.economics.terms import Terms
from synth.frame.settings.changed import changed, with_inputs
from tests.synth.computer.economics.made_cases import CASE, TERMS


def with_terms(**terms: float) -> EconomicCase:
    return changed(CASE, terms=changed(TERMS, **terms))


def test_parts_make_the_whole() -> None:
    found = evaluated(CASE)
    effect = total(found.savings) + 0.12 * total(found.capital) - 50_000.0
    assert found.effect_per_year == pytest.approx(effect)
    assert found.pay_back.years == pytest.approx(3e6 / (effect - 0.25 * 3e6))
    by_year = -3e6 + sum(effect / 1.08**year for year in range(1, 16))
    assert found.net_present_value == pytest.approx(by_year)
    rate = found.internal_rate.per_year
    assert rate is not None
    assert sum(effect / (1.0 + rate) ** year for year in range(1, 16)) == pytest.approx(3e6)


def test_capital_is_counted_once_whether_sold_or_not() -> None:
    """Sold: at the start; not sold: Eн a year. With Eн = r for ever both are worth the same."""
    kept, sold = (
        evaluated(with_terms(cashed_share=share, discount_per_year=0.12, normative_efficiency_per_year=0.12, years=200))
        for share in (0.0, 1.0)
    )
    assert sold.net_present_value == pytest.approx(kept.net_present_value, rel=1e-6)
    assert sold.effect_per_year == kept.effect_per_year
    half = evaluated(with_terms(cashed_share=0.5))
    ends = [evaluated(with_terms(cashed_share=share)).net_present_value for share in (0.0, 1.0)]
    assert half.net_present_value == pytest.approx(0.5 * sum(ends))


def test_losses_of_failures_shorten_the_effect_by_themselves() -> None:
    """130 and 1.5 thousand roubles a year, single and duplex in [hump-computer-1970s]: running cost takes them as they
    are."""
    single, duplex = (evaluated(with_terms(running_cost_per_year=loss)) for loss in (130_000.0, 1_500.0))
    assert duplex.effect_per_year - single.effect_per_year == pytest.approx(128_500.0)
    assert duplex.pay_back.rate_per_year > single.pay_back.rate_per_year


def test_never_is_infinite_among_the_figures() -> None:
    figures = evaluated(with_terms(running_cost_per_year=1e8)).figures()
    assert figures["pay_back_years"] == math.inf
    assert figures["discounted_pay_back_years"] == math.inf
    assert figures["pay_back_rate_per_year"] < 0.0


def test_nothing_changed_costs_what_it_costs() -> None:
    found = evaluated(changed(CASE, change=HumpChange()))
    assert found.effect_per_year == pytest.approx(100_000.0 - 50_000.0)
    assert found.pay_back.years is None


def test_inputs_by_name() -> None:
    made = with_inputs(CASE, {"prices.per_car_h": 2.0, "terms.years": 9.6, "prices.per_car": 1.0})
    assert (made.prices.per_car_h, made.prices.per_car, made.terms.years) == (2.0, 1.0, 10)
    assert changed(made, prices=CASE.prices, terms=CASE.terms) == CASE
    assert with_inputs(CASE, {}) == CASE


@pytest.mark.parametrize(
    "name", ["price.per_car", "prices.per_wagon", "prices", "prices.per_car.x", "prices.currency", ""]
)
def test_a_name_that_is_no_input(name: str) -> None:
    with pytest.raises(PlantError, match="is no input of"):
        with_inputs(CASE, {name: 1.0})


def test_impossible_terms() -> None:
    with pytest.raises(PlantError, match="cashed_share is 1"):
        changed(TERMS, cashed_share=1.5)
    with pytest.raises(PlantError, match="years is 0"):
        with_inputs(CASE, {"terms.years": 0.0})
    assert isinstance(TERMS, Terms)
