"""Two computers side by side: availability against simulated periods, limits, the damaged print, longest periods."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import quad

from plant_models import PlantError
from synth.computer.reliability.duplex import LONGEST_CHECK, Duplex, single_availability

POINTS = ((0.01, 24.0, 1.0), (0.01, 100.0, 2.0), (0.05, 24.0, 1.0), (0.001, 168.0, 2.0), (0.02, 10.0, 0.0))


def printed(rate: float, period: float, check: float) -> float:
    """Kг as the source prints it."""
    return float(
        3.0 / (2.0 * rate * period)
        + np.exp(-2.0 * rate * (period - check)) / (2.0 * rate * period)
        - (1.0 - np.exp(-rate * check)) * np.exp(-rate * period) / (rate * period)
    )


def corrected(rate: float, period: float, check: float) -> float:
    """Kг with both signs set right, term for term."""
    return float(
        3.0 / (2.0 * rate * period)
        + np.exp(-2.0 * rate * (period - check)) / (2.0 * rate * period)
        - (1.0 + np.exp(rate * check)) * np.exp(-rate * period) / (rate * period)
    )


@pytest.mark.parametrize(("rate", "period", "check"), POINTS)
def test_availability_is_that_of_simulated_periods(rate: float, period: float, check: float) -> None:
    n, rng = 400_000, np.random.default_rng(5)
    lives = rng.exponential(1.0 / rate, (2, n))
    together = np.minimum(lives.max(axis=0), period - check)
    alone = np.clip(lives[0] - (period - check), 0.0, check)
    ready, share = together + alone, float(Duplex(rate, check).availability(period))
    assert abs(ready.mean() / period - share) < 3.9 * ready.std() / period / np.sqrt(n)


@pytest.mark.parametrize(("rate", "period", "check"), POINTS)
def test_availability_is_the_corrected_print_and_its_integral(rate: float, period: float, check: float) -> None:
    share = float(Duplex(rate, check).availability(period))
    assert share == pytest.approx(corrected(rate, period, check), rel=1e-12)
    both, _ = quad(lambda t: 2.0 * np.exp(-rate * t) - np.exp(-2.0 * rate * t), 0.0, period - check)
    alone, _ = quad(lambda t: np.exp(-rate * t), period - check, period)
    assert share == pytest.approx((both + alone) / period, rel=1e-12)


@pytest.mark.parametrize(("rate", "period", "check"), POINTS)
def test_the_printed_signs_are_no_availability(rate: float, period: float, check: float) -> None:
    assert printed(rate, period, check) > 1.0


def test_the_print_by_hand() -> None:
    assert printed(0.01, 24.0, 1.0) == pytest.approx(7.53, abs=0.01)
    assert printed(1e-6, 24.0, 1.0) > 1e4
    assert float(Duplex(1e-6, 1.0).availability(24.0)) == pytest.approx(1.0, abs=1e-6)


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
