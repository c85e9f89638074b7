"""The economic case and its parts over the years.

The whole calculation: consistent with its parts and its limits, and its inputs by name.
Present value and internal rate against sums of money year by year.
Pay-back in the form of Trapeznikov: its balance, and when it never comes.
"""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models.errors import PlantError
from synth.computer.economics.economic_case import EconomicCase, evaluated, total
from synth.computer.economics.investment import (
    Investment,
    Terms,
    annuity,
    discounted_pay_back_years,
    internal_rate,
    net_present_value,
    pay_back,
)
from synth.computer.economics.traffic import HumpChange
from synth.frame.settings.settings_file import changed, with_inputs
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


def worth(flows: tuple[float, ...], rate: float) -> float:
    """Year by year."""
    return sum(flow / (1.0 + rate) ** year for year, flow in enumerate(flows))


@pytest.mark.parametrize("rate", [0.0, 1e-12, 0.03, 0.12, 2.0])
@pytest.mark.parametrize("years", [1, 7, 40])
def test_net_present_value_is_the_sum_of_its_years(rate: float, years: int) -> None:
    for spent in (-30.0, 0.0, 160.0):
        held = Investment(spent, 80.0, years)
        assert net_present_value(held, rate) == pytest.approx(worth(held.flows, rate), rel=1e-12, abs=1e-9)


@given(st.floats(1.0, 1e4), st.floats(0.01, 1e4), st.just(0.0) | st.floats(1e-9, 0.5))
def test_discounted_pay_back_is_where_the_present_value_is_zero(spent: float, income: float, rate: float) -> None:
    years = discounted_pay_back_years(Investment(spent, income, 10), rate)
    if years is None:
        assert income <= rate * spent
        assert income * annuity(rate, 1e6) <= spent * (1.0 + 1e-9)
    else:
        assert income * annuity(rate, years) == pytest.approx(spent, rel=1e-6)


def test_discounted_pay_back_lies_in_the_year_of_the_ledger() -> None:
    held, rate = Investment(160.0, 80.0, 30), 0.1
    left, year = -160.0, 0
    while left < 0.0:
        year += 1
        left += 80.0 / 1.1**year
    found = discounted_pay_back_years(held, rate)
    assert found is not None
    assert year - 1 < found <= year
    assert discounted_pay_back_years(held, 0.0) == 2.0
    assert discounted_pay_back_years(held, 0.5) is None
    assert discounted_pay_back_years(Investment(-1.0, 0.0, 1), 0.1) == 0.0
    assert discounted_pay_back_years(Investment(-1.0, -1.0, 1), 0.1) is None


@given(st.floats(0.1, 1e6), st.floats(0.01, 100.0), st.integers(1, 60))
def test_level_income_has_one_internal_rate(spent: float, yield_per_year: float, years: int) -> None:
    investment = Investment(spent, yield_per_year * spent, years)
    found, flows = internal_rate(investment), investment.flows
    assert found.per_year is not None
    assert found.per_year > -1.0
    # Terms of the sum may be huge where the rate is near −1: its error is told by its largest term.
    terms = [abs(flow) / (1.0 + found.per_year) ** year for year, flow in enumerate(flows)]
    assert abs(worth(flows, found.per_year)) <= 1e-9 * max(terms)


def test_internal_rates_in_closed_form() -> None:
    assert internal_rate(Investment(100.0, 112.0, 1)).per_year == pytest.approx(0.12, abs=1e-13)
    assert internal_rate(Investment(100.0, 50.0, 1)).per_year == pytest.approx(-0.5, abs=1e-13)
    assert internal_rate(Investment(-100.0, -112.0, 1)).per_year == pytest.approx(0.12, abs=1e-13)
    forever = internal_rate(Investment(1.0, 100.0, 200)).per_year
    assert forever == pytest.approx(100.0, rel=1e-9), "an income for ever yields income / spent"


def test_no_internal_rate() -> None:
    for spent, income in ((-1.0, 2.0), (1.0, -2.0), (0.0, 0.0), (1.0, 0.0)):
        found = internal_rate(Investment(spent, income, 3))
        assert found.per_year is None
        assert "no internal rate" in found.statement


@pytest.mark.parametrize("investment", [50.0, 160.0, 267.0])
@pytest.mark.parametrize("effect", [80.0, 200.0])
@pytest.mark.parametrize("interest", [0.0, 0.1, 0.25])
def test_effect_pays_investment_and_simple_interest(investment: float, effect: float, interest: float) -> None:
    found = pay_back(investment, effect, interest)
    assert found.years is not None
    assert effect * found.years == pytest.approx(investment * (1.0 + interest * found.years), rel=1e-14)
    assert found.rate_per_year == pytest.approx(1.0 / found.years)


def test_pay_back_that_never_comes_is_said_plainly() -> None:
    for effect in (40.0, 39.0, 0.0, -10.0):
        found = pay_back(160.0, effect)
        assert found.years is None
        assert found.rate_per_year <= 0.0
        assert found.statement.startswith("It never pays back")
    assert pay_back(160.0, 40.0 + 1e-6).years == pytest.approx(1.6e8)
    assert "more than 40" in pay_back(160.0, 39.0).statement


def test_without_an_investment() -> None:
    assert pay_back(0.0, 1.0).years == 0.0
    assert pay_back(-5.0, 0.0).rate_per_year == math.inf
    found = pay_back(-5.0, -1.0)
    assert found.years is None
    assert "5 less, but 1 more each year" in found.statement
