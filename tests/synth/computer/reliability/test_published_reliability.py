"""The figures of [hump-computer-1970s], chapter 4, side by side with inputs that are assumed.

The source tells neither failure rate nor prices but S1, 1.3 to 5 thousand roubles an hour. S1 = 5, λ = 0.0024/h and
checks every 2.5 h are one set that gives its loss of a single computer; nothing else is fitted.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from plant_models import PlantError
from synth.computer.reliability.duplex import Duplex
from synth.computer.reliability.failure_losses import HourPrices, yearly_loss
from synth.computer.reliability.four_states import FourStates, StateShares
from synth.computer.reliability.maintenance_interval import CheckedComputer

UNNOTICED_K_RUB_PER_H = 5.0
"""S1, the upper end of the source."""
FAILURE_PER_H = 0.0024
"""λ, assumed: one failure in 417 h."""
INTERVAL_H = 2.5
"""x, the middle of the 2 to 3 h of the source."""
DUPLEX_K_RUB = 1.5
UNNOTICED_ONLY = HourPrices(UNNOTICED_K_RUB_PER_H, 0.0)


def single(interval_h: float) -> float:
    """Share of time that a failure is unnoticed of one computer with checks that cost nothing."""
    return 1.0 - float(-np.expm1(-FAILURE_PER_H * interval_h) / (FAILURE_PER_H * interval_h))


def loss(unnoticed: float) -> float:
    """Thousand roubles a year of failures that are unnoticed for this share of the time."""
    return yearly_loss(StateShares(1.0 - unnoticed, unnoticed, 0.0, 0.0), UNNOTICED_ONLY).total


def test_a_single_computer_loses_130_thousand_roubles_a_year() -> None:
    """8760·5·λx/2 = 131: "may reach 130 thousand"."""
    assert loss(single(INTERVAL_H)) == pytest.approx(131.0, abs=1.0)


def test_the_chain_gives_about_twice_that_for_the_same_rate_of_checks() -> None:
    """In the chain checks come at random with the rate ν = 1/x: a failure waits x for the next, not x/2."""
    chain = FourStates(FAILURE_PER_H, 0.0, 1.0 / INTERVAL_H, 4.0, 0.5)
    p = chain.stationary()
    unnoticed = p.failed_unnoticed / (p.ready + p.failed_unnoticed)
    assert unnoticed / single(INTERVAL_H) == pytest.approx(2.0, rel=0.01)


def test_two_to_three_hours_need_a_check_worth_of_half_a_minute() -> None:
    """x = 2.5 h is the best interval only if τSc/S1 = λx²/2 = 0.0075 h; with Sc/S1 of 0.1, τ is 4.5 min."""
    worth_h = brentq(lambda w: checked(w).best_useful_h - INTERVAL_H, 1e-5, 1.0, xtol=1e-12)
    assert worth_h == pytest.approx(FAILURE_PER_H * INTERVAL_H**2 / 2.0, rel=0.005)
    assert worth_h == pytest.approx(0.0075, abs=5e-5)
    ends = [checked(w).best_useful_h for w in (0.0048, 0.0108)]
    np.testing.assert_allclose(ends, [2.0, 3.0], rtol=0.005)


def checked(worth_h: float) -> CheckedComputer:
    """The single computer whose check costs as much as `worth_h` hours of an unnoticed failure."""
    return CheckedComputer(FAILURE_PER_H, worth_h, UNNOTICED_K_RUB_PER_H, UNNOTICED_K_RUB_PER_H)


def test_a_duplex_loses_one_and_a_half_thousand_only_with_longer_periods_and_no_checks() -> None:
    """1.5 thousand are p2 = 3.4e-5, (λx)²/3 at x = 4.2 h; at the 2.5 h of the single one it would lose 0.5 thousand."""
    needed = DUPLEX_K_RUB / (8760.0 * UNNOTICED_K_RUB_PER_H)
    assert needed == pytest.approx(3.42e-5, rel=0.01)
    assert Duplex(FAILURE_PER_H, 0.0).longest_period_h(1.0 - needed) == pytest.approx(4.23, abs=0.01)
    same_period = loss(1.0 - float(Duplex(FAILURE_PER_H, 0.0).availability(INTERVAL_H)))
    assert same_period == pytest.approx(0.52, abs=0.01)


def test_its_own_formula_forbids_that_loss_with_checks_of_more_than_two_minutes() -> None:
    """While one is checked the other works alone: at least λτк/2 of the time is lost at the shortest period. With
    τк = 0.25 h (assumed) and x = 4.2 h the duplex loses 26 thousand, not 1.5."""
    needed = DUPLEX_K_RUB / (8760.0 * UNNOTICED_K_RUB_PER_H)
    with pytest.raises(PlantError, match="allow"):
        Duplex(FAILURE_PER_H, 1.01 * 2.0 * needed / FAILURE_PER_H).longest_period_h(1.0 - needed)
    assert 60.0 * 2.0 * needed / FAILURE_PER_H == pytest.approx(1.7, abs=0.05)
    assert loss(1.0 - float(Duplex(FAILURE_PER_H, 0.25).availability(4.2))) == pytest.approx(26.0, abs=1.5)


def test_the_loss_of_an_hour_is_that_of_a_car_at_both_ends() -> None:
    """1.3 to 5.0 thousand an hour, 5000 to 20000 cars a day: 6.2 and 6.0 roubles a car, so S1 goes with the traffic."""
    low, high = 1300.0 * 24.0 / 5000.0, 5000.0 * 24.0 / 20_000.0
    assert low == pytest.approx(high, rel=0.05)


def test_an_availability_of_0_999_does_not_lose_100_thousand() -> None:
    """The conclusions of the source say so; with its own S1 it is 44 thousand at most, and needs 11.4 an hour."""
    assert loss(0.001) == pytest.approx(43.8)
    assert loss(0.001) * 11.4 / UNNOTICED_K_RUB_PER_H == pytest.approx(100.0, abs=0.2)


def test_a_duplex_gains_almost_two_orders() -> None:
    """130/1.5 = 87 in the source; λx/2 against (λx)²/3, that is 3/(2λx), 250 at one and the same period."""
    gain = single(INTERVAL_H) / (1.0 - float(Duplex(FAILURE_PER_H, 0.0).availability(INTERVAL_H)))
    assert gain == pytest.approx(3.0 / (2.0 * FAILURE_PER_H * INTERVAL_H), rel=0.01)
    published = 130.0 / DUPLEX_K_RUB
    assert 80.0 < published < 0.4 * gain
