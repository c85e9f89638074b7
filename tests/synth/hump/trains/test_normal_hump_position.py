"""The position of known exactness: its error, what it cannot do, and the time that a cut takes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from plant_models.library.catalogue import load_car, load_position, load_weight_categories
from synth.hump.trains.hump_position import Arrivals
from synth.hump.trains.normal_hump_position import SLOWEST_M_S, LibraryBrake, NormalHumpPosition

BRAKE = LibraryBrake(load_position("knp-5-bunch").position, load_weight_categories(), load_car("gondola-4").car)


def test_error_is_normal_about_the_command(arrivals: Callable[..., Arrivals]) -> None:
    error = NormalHumpPosition(0.15, BRAKE).passed(arrivals(20_000)).exit_m_s - 3.0
    assert abs(error.mean()) < 3.9 * 0.15 / np.sqrt(20_000)
    assert error.std() == pytest.approx(0.15, rel=3.9 / np.sqrt(40_000))
    assert stats.kstest(error / 0.15, "norm").pvalue > 1e-4


def test_errors_of_two_positions_are_independent_and_scale_with_the_deviation(
    arrivals: Callable[..., Arrivals],
) -> None:
    first, second = (NormalHumpPosition(0.15, BRAKE).passed(arrivals(9000, position=p)).exit_m_s for p in (0, 1))
    assert abs(np.corrcoef(first, second)[0, 1]) * np.sqrt(9000) < 3.9
    half = NormalHumpPosition(0.075, BRAKE).passed(arrivals(9000, position=1)).exit_m_s
    np.testing.assert_allclose(half - 3.0, 0.5 * (second - 3.0), atol=1e-12)


def test_an_ideal_position_obeys_within_its_power(arrivals: Callable[..., Arrivals]) -> None:
    """By hand: 90 t, four wheel pairs, 535 kPa · 20/550 kN/kPa, 24.95 m; 7 m/s unbraked."""
    commands = np.array([0.0, 1.0, 3.0, 7.0, 9.0])
    came = replace(arrivals(5, mass_t=90.0, unbraked_m_s=7.0, category=4), commanded_m_s=commands)
    passed = NormalHumpPosition(0.0, BRAKE).passed(came)
    least = np.sqrt(7.0**2 - 2.0 * 4 * 535.0 * 20.0 / 550.0 * 24.95 / (90.0 + 0.42 * 4))
    assert 1.0 < least < 3.0
    np.testing.assert_allclose(passed.exit_m_s, [least, least, 3.0, 7.0, 7.0], rtol=1e-9)
    assert (passed.switchings == 0).all()


def test_a_light_cut_may_be_given_low_stages_only(arrivals: Callable[..., Arrivals]) -> None:
    """Stage 2 takes 52 t from 6.5 m/s to 3.7, stage 4 to almost nothing."""
    ordered, light = arrivals(2, mass_t=52.0, commanded_m_s=0.0), np.array([0, 2])
    exit_m_s = NormalHumpPosition(0.0, BRAKE).passed(replace(ordered, category=light)).exit_m_s
    taken = 2.0 * 4 * 235.0 * 20.0 / 550.0 * 24.95 / (52.0 + 0.42 * 4)
    assert exit_m_s[0] == pytest.approx(np.sqrt(6.5**2 - taken))
    assert exit_m_s[1] == SLOWEST_M_S


def test_what_stops_unbraked_never_leaves(arrivals: Callable[..., Arrivals]) -> None:
    passed = NormalHumpPosition(0.2, BRAKE).passed(arrivals(50, unbraked_m_s=0.0))
    assert (passed.exit_m_s == 0.0).all()
    assert np.isinf(passed.time_s).all()


def test_time_is_that_of_even_deceleration(arrivals: Callable[..., Arrivals]) -> None:
    passed = NormalHumpPosition(0.2, BRAKE).passed(arrivals(50))
    deceleration = (6.0**2 - passed.exit_m_s**2) / (2.0 * 37.45)
    np.testing.assert_allclose(passed.time_s, (6.0 - passed.exit_m_s) / deceleration, rtol=1e-12)


def test_a_cut_passes_the_same_whoever_is_beside_it(arrivals: Callable[..., Arrivals]) -> None:
    position, came = NormalHumpPosition(0.2, BRAKE), arrivals(300)
    whole = position.passed(came)
    few = position.passed(came.chosen(np.array([250, 3, 77])))
    assert (few.exit_m_s == whole.exit_m_s[[250, 3, 77]]).all()
    assert (few.time_s == whole.time_s[[250, 3, 77]]).all()


def test_bad_values_are_refused(arrivals: Callable[..., Arrivals]) -> None:
    with pytest.raises(ValueError, match="mass_t has the shape"):
        replace(arrivals(5), mass_t=np.ones(4))
