"""Failures, checks and repairs of one computer and of two.

The four states of the computer: closed form, elimination, integration in time, and what must rise.
Losses of a year, by hand.
Two computers side by side: availability against its integral, limits, longest periods.
Failures of a common cause in two computers, against the mean of what they are after each hour.
The best interval between checks: against the Lambert function and simulated cycles.
"""

from __future__ import annotations

from dataclasses import astuple, replace
from math import expm1

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp
from scipy.special import lambertw

from plant_models import PlantError
from synth.computer.reliability.four_states import FourStates, HourPrices, State, StateShares, yearly_loss
from synth.computer.reliability.maintenance import LONGEST_CHECK, CheckedComputer, Duplex, single_availability
from synth.computer.reliability.upkeep import Upkeep
from synth.frame.settings.settings_file import changed

PRINTED = FourStates(0.01, 0.2, 0.4, 4.0, 0.5)
TO_REPAIR = replace(PRINTED, failed_check_to=State.REPAIR)
rates = st.floats(1e-4, 1e2)
chains = st.builds(
    FourStates, rates, rates, rates, rates, rates, st.sampled_from([State.MAINTENANCE, State.REPAIR])
)  # fmt: skip


def stationary_shares(generator_per_h: np.ndarray) -> np.ndarray:
    """Share of time (n,) in each state of a chain with this generator (n, n).

    One state after the other is taken out, without any subtraction: so a share of 1e-15 has all its digits, which the
    null space does not give. Grassmann, Taksar and Heyman, Operations Research 33 (1985).
    """
    rates, n = generator_per_h.copy(), len(generator_per_h)
    for k in range(n - 1, 0, -1):
        rates[:k, k] /= rates[k, :k].sum()
        rates[:k, :k] += np.outer(rates[:k, k], rates[k, :k])
    shares = np.ones(n)
    for k in range(1, n):
        shares[k] = shares[:k] @ rates[:k, k]
    return np.asarray(shares / shares.sum())


def test_the_matrix_is_that_of_the_print() -> None:
    """The rows of the print, with dt left out: λ ν on the first, ν μ on the second, ε on the third, γ on the fourth."""
    expected = [[-0.41, 0.01, 0.4, 0.0], [0.0, -0.6, 0.4, 0.2], [4.0, 0.0, -4.0, 0.0], [0.5, 0.0, 0.0, -0.5]]
    np.testing.assert_allclose(PRINTED.generator_per_h(), expected, atol=1e-15)
    assert TO_REPAIR.generator_per_h()[State.FAILED_UNNOTICED].tolist() == [
        0.0,
        -0.6000000000000001,
        0.0,
        0.6000000000000001,
    ]


@given(chains)
def test_closed_form_is_what_elimination_gives_in_every_digit(chain: FourStates) -> None:
    np.testing.assert_allclose(astuple(chain.stationary()), stationary_shares(chain.generator_per_h()), rtol=1e-13)


@pytest.mark.parametrize("chain", [PRINTED, TO_REPAIR])
@pytest.mark.parametrize("start", list(State))
def test_transient_is_that_of_the_differential_equations(chain: FourStates, start: State) -> None:
    hours = np.array([0.0, 0.1, 1.0, 5.0, 40.0])
    q, begin = chain.generator_per_h(), np.eye(4)[start]
    solved = solve_ivp(lambda _, p: p @ q, (0.0, 40.0), begin, "DOP853", hours, rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(chain.transient(hours, start), solved.y.T, atol=1e-9)
    (late,) = chain.transient(np.array([1e4]), start)
    np.testing.assert_allclose(late, astuple(chain.stationary()), rtol=1e-9)


@given(chains, st.floats(1.05, 10.0))
def test_detection_raises_availability_unless_maintenance_is_the_shorter_repair(
    chain: FourStates, factor: float
) -> None:
    """Where the check leads to repair, always. As printed only if a repair, 1/γ, is shorter than waiting for the check
    and its maintenance, 1/ν + 1/ε: for there the check repairs too."""
    now = chain.stationary().availability
    sooner = replace(chain, detection_per_h=factor * chain.detection_per_h).stationary().availability
    if chain.failed_check_to is State.REPAIR:
        assert sooner >= now
        return
    gain = 1.0 / chain.check_per_h + 1.0 / chain.maintenance_per_h - 1.0 / chain.repair_per_h
    assert (sooner - now) * gain >= -1e-12 * abs(gain)


def test_without_checks_or_without_detection_a_chain_still_works() -> None:
    unchecked, unaware = replace(PRINTED, check_per_h=0.0), replace(PRINTED, detection_per_h=0.0)
    assert unchecked.stationary().maintenance == 0.0
    assert unaware.stationary().repair == 0.0
    for chain in (unchecked, unaware):
        p = chain.stationary()
        np.testing.assert_allclose(astuple(p) @ chain.generator_per_h(), 0.0, atol=1e-14)


def test_losses_of_a_year_by_hand() -> None:
    loss = yearly_loss(StateShares(0.9, 0.01, 0.06, 0.03), HourPrices(unnoticed=5.0, by_hand=0.5))
    assert loss.unnoticed == pytest.approx(438.0)
    assert loss.maintenance == pytest.approx(262.8)
    assert loss.repair == pytest.approx(131.4)
    assert loss.total == pytest.approx(832.2)


POINTS = ((0.01, 24.0, 1.0), (0.01, 100.0, 2.0), (0.05, 24.0, 1.0), (0.001, 168.0, 2.0), (0.02, 10.0, 0.0))


def corrected(rate: float, period: float, check: float) -> float:
    """Kг with both signs set right, term for term."""
    return float(
        3.0 / (2.0 * rate * period)
        + np.exp(-2.0 * rate * (period - check)) / (2.0 * rate * period)
        - (1.0 + np.exp(rate * check)) * np.exp(-rate * period) / (rate * period)
    )


@pytest.mark.parametrize(("rate", "period", "check"), POINTS)
def test_availability_is_the_corrected_print_and_its_integral(rate: float, period: float, check: float) -> None:
    share = float(Duplex(rate, check).availability(period))
    assert share == pytest.approx(corrected(rate, period, check), rel=1e-12)
    both, _ = quad(lambda t: 2.0 * np.exp(-rate * t) - np.exp(-2.0 * rate * t), 0.0, period - check)
    alone, _ = quad(lambda t: np.exp(-rate * t), period - check, period)
    assert share == pytest.approx((both + alone) / period, rel=1e-12)


@given(st.floats(1e-4, 0.1), st.floats(0.0, 2.0), st.floats(0.3, 0.99999))
def test_the_longest_period_just_keeps_the_availability(rate: float, check: float, required: float) -> None:
    duplex = Duplex(rate, check)
    assume(check == 0.0 or required < float(duplex.availability(check)))
    period = duplex.longest_period_h(required)
    assert float(duplex.availability(period)) == pytest.approx(required, abs=1e-10)
    assert float(duplex.availability(1.001 * period)) < required


def test_with_checks_of_many_lives_a_longer_period_may_be_better() -> None:
    """Falling up to `LONGEST_CHECK`; with checks of six mean times between failures no more."""
    periods = LONGEST_CHECK + np.linspace(0.0, 30.0, 20_001)
    assert (np.diff(Duplex(1.0, LONGEST_CHECK).availability(periods)) < 0.0).all()
    first, later = Duplex(1.0, 6.0).availability(np.array([7.0, 7.9]))
    assert later > first
    with pytest.raises(PlantError, match=r"check_h is 6 h; .* more than 3 mean times"):
        Duplex(1.0, 6.0).longest_period_h(0.1)


def test_a_single_computer_by_hand_and_simulated() -> None:
    """The four points of the design notes."""
    shares = [float(single_availability(rate, check, period)) for rate, period, check in POINTS[:4]]
    np.testing.assert_allclose(shares, [0.856, 0.625, 0.569, 0.910], atol=5e-4)
    life, n = np.random.default_rng(8).exponential(100.0, 400_000), 400_000
    ready = np.minimum(life, 23.0) / 24.0
    assert abs(ready.mean() - shares[0]) < 3.9 * ready.std() / np.sqrt(n)


def test_an_availability_that_no_period_keeps_is_refused() -> None:
    with pytest.raises(PlantError, match=r"allow 0\.990066335 at most"):
        Duplex(0.01, 2.0).longest_period_h(0.999)


@pytest.mark.parametrize("common_share", [0.0, 0.1, 0.7, 1.0])
@pytest.mark.parametrize(("failure_per_h", "period_h"), [(1e-5, 24.0), (0.01, 60.0), (0.01, 600.0)])
def test_two_computers_with_a_common_cause(failure_per_h: float, period_h: float, common_share: float) -> None:
    """Checks that take no time: none is ready after a common cause, or when each has failed for itself."""
    asked = changed(
        Upkeep(),
        failure_per_h=failure_per_h, check_interval_h=period_h, check_h=1e-5, common_share=common_share,
    )  # fmt: skip

    def none_ready(hours: float) -> float:
        together = -expm1(-common_share * failure_per_h * hours)
        alone = -expm1(-(1.0 - common_share) * failure_per_h * hours)
        return together + (1.0 - together) * alone**2

    expected, _ = quad(none_ready, 0.0, period_h, epsabs=0.0, epsrel=1e-10)
    assert asked.duplex_unavailability == pytest.approx(expected / period_h, rel=1e-5, abs=1e-9)


COMPUTER = CheckedComputer(failure_per_h=0.01, check_h=0.25, manual_price_per_h=0.2, unnoticed_price_per_h=2.0)
computers = st.builds(
    CheckedComputer, st.floats(1e-5, 1.0), st.floats(0.01, 5.0), st.floats(0.01, 5.0), st.floats(0.05, 5.0)
)


def losses(computer: CheckedComputer, interval_h: np.ndarray) -> tuple[tuple[float, np.ndarray], ...]:
    """Both best intervals, each with the loss that it makes least: for an hour of use, for one of the calendar."""
    per_use = computer.cycle_loss(interval_h) / computer.ready_h(interval_h)
    return (computer.best_useful_h, per_use), (computer.best_calendar_h, computer.loss_per_year(interval_h))


@given(computers)
def test_the_best_interval_is_that_of_the_lambert_function(computer: CheckedComputer) -> None:
    """e^y − y = 1 + c: y = −W(−e^{−(1+c)}) − 1 − c; e^{−y}(1 + y + m) = 1 + m − c: y = −W(…) − 1 − m; lower branch."""
    rate, c, m = computer.failure_per_h, computer.check_worth, computer.failure_per_h * computer.check_h
    assume(c > 1e-6)  # nearer to its branch point the function has no digits left
    useful = -lambertw(-np.exp(-(1.0 + c)), -1).real - 1.0 - c
    tolerance = 1e-13 / c
    assert rate * computer.best_useful_h == pytest.approx(useful, rel=tolerance)
    if c >= 1.0 + m:
        assert computer.best_calendar_h == np.inf
        return
    assume(1.0 + m - c > 1e-6)
    tolerance = 1e-13 / c + 1e-13 / (1.0 + m - c)
    cycle = -lambertw(-(1.0 + m - c) * np.exp(-(1.0 + m)), -1).real - 1.0 - m
    assert rate * computer.best_calendar_h == pytest.approx(cycle, rel=tolerance)


def test_losses_are_those_of_simulated_cycles() -> None:
    n, rng = 400_000, np.random.default_rng(11)
    life = rng.exponential(1.0 / 0.05, n)
    computer = replace(COMPUTER, failure_per_h=0.05)
    for interval in (0.5, 2.0, 10.0, 60.0):
        ready = np.minimum(life, interval)
        loss = 2.0 * (interval - ready) + 0.2 * 0.25
        per_use, per_year = (float(told[0]) for _, told in losses(computer, np.array([interval])))
        for told, hours in ((per_use, ready), (per_year / 8760.0, np.full(n, interval + 0.25))):
            residual = loss - told * hours
            assert abs(residual.mean()) < 3.9 * residual.std() / np.sqrt(n), interval


def test_where_a_check_costs_too_much_none_pays() -> None:
    dear = replace(COMPUTER, failure_per_h=1.0, check_h=4.0, manual_price_per_h=3.0)
    assert dear.best_calendar_h == np.inf
    x = np.array([1.0, 10.0, 100.0, 1e4])
    assert (np.diff(dear.loss_per_year(x)) < 0.0).all()
    assert np.isfinite(dear.best_useful_h)
