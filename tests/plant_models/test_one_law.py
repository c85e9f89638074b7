"""What is said once of the plant: a reading's std, the free acceleration, and when a valve opens."""

import math

import numpy as np
import pytest

from plant_models import (
    Cut,
    DopplerSensor,
    Pneumatics,
    PressingForce,
    RetarderPosition,
    TrackProfile,
    path_coefficients,
)


def test_std_of_a_reading_adds_noise_and_the_uniform_law_of_rounding() -> None:
    seen = DopplerSensor(0.03, 0.12, 0.1, 0.0)
    assert seen.reading_std_m_s == pytest.approx(math.sqrt(0.03**2 + 0.12**2 / 12.0))
    exact = DopplerSensor(0.0, 0.0, 0.1, 0.0)
    assert exact.exact
    assert exact.reading_std_m_s == 1e-4
    assert not seen.exact


def test_std_of_a_reading_is_that_of_simulated_readings() -> None:
    rng = np.random.default_rng(3)
    v = rng.uniform(2.0, 6.0, 400_000)
    sensor = DopplerSensor(0.03, 0.12, 0.1, 0.0)
    readings = np.round((v + sensor.noise_m_s * rng.standard_normal(v.size)) / 0.12) * 0.12
    assert float(np.std(readings - v)) == pytest.approx(sensor.reading_std_m_s, rel=0.005)


def test_a_cut_rolls_freely_where_grade_and_resistance_are_equal() -> None:
    valves = Pneumatics(700.0, 0.0, 0.1, 0.2, 0.1, 0.3, 0.3, 15.0)
    position = RetarderPosition("x", ((0.0, 10.0),), (0.0, 300.0), PressingForce(0.03, 50.0), valves, 7.0)
    cut = Cut("x", 80.0, (0.0, 1.85, 8.65, 10.5), 1)
    cells = path_coefficients(position, cut, TrackProfile.uniform(2.5), np.linspace(0.0, 20.5, 5))
    np.testing.assert_allclose(cells.free_m_s2(2.5), 0.0, atol=1e-15)
    np.testing.assert_allclose(cells.free_m_s2(1.5), 9.81 * 80.0 / (80.0 + 0.42 * 4) * 1e-3)


def test_a_valve_opens_after_its_own_delay() -> None:
    valves = Pneumatics(700.0, 0.0, 0.11, 0.2, 0.07, 0.31, 0.4, 15.0)
    for start, end, delay in ((0.0, 300.0, 0.31), (50.0, 300.0, 0.31), (135.0, 300.0, 0.11), (285.0, 0.0, 0.07)):
        assert valves.respond(start, end, 50.0).starts_s[1] == pytest.approx(delay)
