"""Pay-back in the form of Trapeznikov: its balance, the figures of the source, and when it never comes."""

from __future__ import annotations

import math

import pytest

from synth.computer.economics.pay_back import pay_back, yearly_effect


@pytest.mark.parametrize("investment", [50.0, 160.0, 267.0])
@pytest.mark.parametrize("effect", [80.0, 200.0])
@pytest.mark.parametrize("interest", [0.0, 0.1, 0.25])
def test_effect_pays_investment_and_simple_interest(investment: float, effect: float, interest: float) -> None:
    found = pay_back(investment, effect, interest)
    assert found.years is not None
    assert effect * found.years == pytest.approx(investment * (1.0 + interest * found.years), rel=1e-14)
    assert found.rate_per_year == pytest.approx(1.0 / found.years)


def test_printed_formula() -> None:
    """The print of the source gives the investment for a time; ours the time for that investment."""
    for years in (0.5, 2.0, 4.0, 30.0):
        savings, capital, normative, running = 60.0, 500.0, 0.13, 5.0
        printed = (savings + capital * normative - running) * years / (1.0 + 0.25 * years)
        effect = yearly_effect(savings, capital, normative, running)
        assert pay_back(printed, effect).years == pytest.approx(years)


def test_figures_of_the_source_side_by_side() -> None:
    """[hump-computer-1970s]: ΔE 40 to 85 and ΔK 240 to 1000 thousand roubles; effect 80 to 200 a year; 2 to 4 years.

    Its investment is not told: 267 and 160 thousand roubles give the ends.
    """
    effects = [yearly_effect(e, k, normative, 0.0) for normative in (0.12, 0.15) for e, k in ((40, 240), (85, 1000))]
    assert effects == pytest.approx([68.8, 205.0, 76.0, 235.0])
    assert min(effects) < 80.0
    assert max(effects) > 200.0
    assert pay_back(800.0 / 3.0, 200.0).years == pytest.approx(2.0)
    assert pay_back(160.0, 80.0).years == pytest.approx(4.0)


def test_pay_back_that_never_comes_is_said_plainly() -> None:
    for effect in (40.0, 39.0, 0.0, -10.0):
        found = pay_back(160.0, effect)
        assert found.years is None
        assert found.rate_per_year <= 0.0
        assert found.statement.startswith("It never pays back")
    assert pay_back(160.0, 40.0 + 1e-6).years == pytest.approx(1.6e8)
    assert "more than 40" in pay_back(160.0, 39.0).statement


def test_rate_goes_through_zero_without_a_jump() -> None:
    below, at, above = (pay_back(100.0, 25.0 + step).rate_per_year for step in (-1e-9, 0.0, 1e-9))
    assert below < at == 0.0 < above
    assert above - below == pytest.approx(2e-11, rel=1e-4)


def test_without_an_investment() -> None:
    assert pay_back(0.0, 1.0).years == 0.0
    assert pay_back(-5.0, 0.0).rate_per_year == math.inf
    found = pay_back(-5.0, -1.0)
    assert found.years is None
    assert "5 less, but 1 more each year" in found.statement
