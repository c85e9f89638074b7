"""Present value and internal rate against sums of money year by year."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from synth.computer.economics.internal_rate import internal_rate
from synth.computer.economics.present_value import (
    Investment,
    annuity,
    discounted_pay_back_years,
    net_present_value,
)


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
