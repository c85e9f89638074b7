"""The best interval between checks: against a grid, the Lambert function, simulated cycles, and the damaged print."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.special import lambertw

from synth.computer.reliability.maintenance_interval import CheckedComputer

COMPUTER = CheckedComputer(failure_per_h=0.01, check_h=0.25, manual_price_per_h=0.2, unnoticed_price_per_h=2.0)
computers = st.builds(
    CheckedComputer, st.floats(1e-5, 1.0), st.floats(0.01, 5.0), st.floats(0.01, 5.0), st.floats(0.05, 5.0)
)


def losses(computer: CheckedComputer, interval_h: np.ndarray) -> tuple[tuple[float, np.ndarray], ...]:
    """Both best intervals, each with the loss that it makes least: for an hour of use, for one of the calendar."""
    per_use = computer.cycle_loss(interval_h) / computer.ready_h(interval_h)
    return (computer.best_useful_h, per_use), (computer.best_calendar_h, computer.loss_per_year(interval_h))


def test_the_best_interval_is_the_minimum_of_a_grid() -> None:
    grid = np.arange(0.5, 6.0, 1e-4)
    for (best, loss), interval_h in zip(losses(COMPUTER, grid), (2.2278, 2.0142), strict=True):
        assert best == pytest.approx(grid[loss.argmin()], abs=1e-4)
        assert best == pytest.approx(interval_h, abs=1e-4)


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


def test_the_print_has_no_root() -> None:
    """e^{−λx} − λx = 1 + λ·Sc/S1: the left side is below 1 for every x > 0, the right side above."""
    x = np.geomspace(1e-6, 1e4, 2000)
    for rate in (1e-4, 0.0024, 0.01, 0.5):
        assert (np.exp(-rate * x) - rate * x < 1.0).all()


def test_the_equation_needs_the_duration_of_the_check() -> None:
    """The same computer in minutes: with τ the interval is the same time, without it, as printed, another one."""
    minutes = CheckedComputer(0.01 / 60.0, 0.25 * 60.0, 0.2 / 60.0, 2.0 / 60.0)
    assert minutes.best_useful_h == pytest.approx(60.0 * COMPUTER.best_useful_h, rel=1e-9)
    assert minutes.best_calendar_h == pytest.approx(60.0 * COMPUTER.best_calendar_h, rel=1e-9)
    without_h, without_min = (np.sqrt(2.0 * 0.1 / rate) for rate in (0.01, 0.01 / 60.0))
    assert without_min / without_h == pytest.approx(np.sqrt(60.0))


def test_where_a_check_costs_too_much_none_pays() -> None:
    dear = replace(COMPUTER, failure_per_h=1.0, check_h=4.0, manual_price_per_h=3.0)
    assert dear.best_calendar_h == np.inf
    x = np.array([1.0, 10.0, 100.0, 1e4])
    assert (np.diff(dear.loss_per_year(x)) < 0.0).all()
    assert np.isfinite(dear.best_useful_h)


def test_loss_of_a_year() -> None:
    """By hand: 8760·(2·(x − G) + 0.05)/(x + 0.25) at x = 2."""
    ready = (1.0 - np.exp(-0.02)) / 0.01
    assert float(COMPUTER.loss_per_year(2.0)) == pytest.approx(8760.0 * (2.0 * (2.0 - ready) + 0.05) / 2.25)
