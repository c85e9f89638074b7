"""Readings that the estimator does not believe: leaps, repeats, false first ones, a lost cut; and its alarms."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tuning_tables.test_estimator import estimator as estimator
from tuning_tables import unseen_samples
from tuning_tables.estimator import CAUTION, Estimator, begin
from tuning_tables.held_table import lines_apart
from tuning_tables.programs.decide import HEAVIER_ALARM, LOST_ALARM, SENSOR_ALARM, alarms, table_after
from tuning_tables.programs.motion_filter import LEAST_FACTOR
from tuning_tables.programs.observe import observe


def seen_cut(estimator: Estimator, samples: int = 12, speed: float = 5.0) -> np.ndarray:
    """The state after some sound readings of a cut before the brake."""
    state = begin()
    for sample in range(samples):
        observe(lines_apart(estimator), state, 0.1 * sample, speed + 0.01 * (-1) ** sample, 0.0)
    return state


@pytest.mark.requirement("EST-04")
def test_a_leap_is_doubted_and_corrects_nothing(estimator: Estimator) -> None:
    """As if it were missing, but that the alarm says so; doubt ends with a reading near the estimate."""
    doubted, missing = seen_cut(estimator), seen_cut(estimator)
    for sample, v in enumerate((9.0, 0.0, 9.0)):
        told = [
            observe(lines_apart(estimator), state, 1.2 + 0.1 * sample, reading, 0.0)
            for state, reading in ((doubted, v), (missing, np.nan))
        ]
        assert told[0] == told[1]
        assert np.array_equal(doubted[:12], missing[:12])
        assert alarms(lines_apart(estimator), doubted) == SENSOR_ALARM
        assert alarms(lines_apart(estimator), missing) == 0
    observe(lines_apart(estimator), doubted, 1.5, 5.0, 0.0)
    assert (unseen_samples(doubted), alarms(lines_apart(estimator), doubted)) == (0, 0)


def test_what_the_brake_or_noise_can_do_is_no_leap(estimator: Estimator) -> None:
    """A brake that fails is followed: the readings are far from the estimate, but they did not leap there."""
    state = seen_cut(estimator)
    s, v = 1.2, 5.0
    for sample in range(40):
        s, v = s + 0.1 * v, v + 0.01 * (-1) ** sample
        observe(lines_apart(estimator), state, s, v, 500.0)
        assert unseen_samples(state) == 0
    assert state[3] == LEAST_FACTOR
    assert alarms(lines_apart(estimator), state) & HEAVIER_ALARM


def test_false_first_readings_are_left_behind(estimator: Estimator) -> None:
    """The estimate begins anew as long as few readings were believed, so that a false one does not rule the pass."""
    state = begin()
    for v in (0.0, 0.1):
        assert observe(lines_apart(estimator), state, 0.0, v, 0.0) == -1.0
    for sample, v in enumerate((9.0, 5.0, 8.0, 5.0, 5.01, 5.0)):
        found = observe(lines_apart(estimator), state, 0.1 * sample, v, 0.0)
    assert found == pytest.approx(5.0, abs=0.02)
    observe(lines_apart(estimator), state, 0.6, 9.0, 0.0)
    assert alarms(lines_apart(estimator), state) == SENSOR_ALARM  # now it knows better


def test_a_sensor_whose_error_lasts_is_followed_after_a_while(estimator: Estimator) -> None:
    state = seen_cut(estimator)
    for sample in range(estimator.doubted_readings):
        assert unseen_samples(state) == sample
        observe(lines_apart(estimator), state, 1.2 + 0.1 * sample, 6.0 + 0.01 * (-1) ** sample, 0.0)
    assert state[2] == pytest.approx(6.0, abs=0.011)
    assert (unseen_samples(state), alarms(lines_apart(estimator), state)) == (0, 0)


@pytest.mark.requirement("EST-04")
def test_a_reading_that_repeats_itself_is_not_believed(estimator: Estimator) -> None:
    state = seen_cut(estimator)
    for sample in range(20):
        observe(lines_apart(estimator), state, 1.2 + 0.1 * sample, 5.0, 0.0)
        frozen = sample >= estimator.frozen_readings
        assert (unseen_samples(state) > 0) is (3 * sample >= estimator.frozen_readings)
        assert alarms(lines_apart(estimator), state) == (SENSOR_ALARM if frozen else 0)


@pytest.mark.requirement("EST-05")
def test_a_lost_cut_is_taken_for_slower_than_it_seems(estimator: Estimator) -> None:
    """By half the limit at twice the variance; never below 0; the alarm says when."""
    state, limit = seen_cut(estimator), estimator.lost_speed_std_m_s
    for times in (0.5, 1.0, 2.0, 400.0):
        state[5] = times * limit**2
        now = state.copy()
        found = observe(lines_apart(estimator), now, float(state[1]), np.nan, 0.0)
        caution = CAUTION * limit * max(now[5] / limit**2 - 1.0, 0.0)
        assert found == pytest.approx(max(now[2] - caution, 0.0), abs=1e-5)
        assert (alarms(lines_apart(estimator), now) == LOST_ALARM) == (now[5] > np.float32(limit**2))


def test_there_is_no_alarm_before_a_cut_was_seen(estimator: Estimator) -> None:
    assert alarms(lines_apart(estimator), begin()) == 0


@pytest.mark.requirement("EST-06")
def test_a_neighbour_takes_over_where_the_weight_alone_is_in_doubt() -> None:
    for word in range(16):
        step = {4: -1, 8: 1}.get(word, 0)
        for last in range(4):
            for present in range(last + 1):
                assert table_after(word, present, last) == min(max(present + step, 0), last)


def test_a_spike_after_a_repeated_reading_is_doubted_and_one_after_a_missing_reading_is_not(
    estimator: Estimator,
) -> None:
    for readings, believed in (([5.0] * estimator.frozen_readings, False), ([-1.0], True)):
        state = seen_cut(estimator)
        for sample, v in enumerate((*readings, 8.0)):
            observe(lines_apart(estimator), state, 1.2 + 0.05 * sample, v, 0.0)
        assert (unseen_samples(state) == 0) is believed
