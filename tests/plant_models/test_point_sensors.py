"""Point sensors: their errors against closed forms and drawn readings, and the order of the passages."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from plant_models import Cut, PlantError, PointSensors, every_axle, first_axle
from plant_models.point_sensors import deciding_passages, passages

SENSORS = PointSensors(path_m=(-5.0, 3.0, 9.5, 31.0), timer_noise_s=2e-4, timer_resolution_s=1e-4, base_tolerance=4e-3)
CUT = Cut("Л", 22.0, (0.0, 1.85, 8.65, 10.5), 4)


def test_std_of_a_reading_is_that_of_drawn_ones() -> None:
    rng, sensors = np.random.default_rng(1), replace(SENSORS, timer_resolution_s=2.0 * SENSORS.timer_noise_s)
    for speed in (1.5, 4.0, 7.0):
        base = sensors.base_m * (1.0 + sensors.base_tolerance * rng.standard_normal(200_000))
        time = base / speed + sensors.timer_noise_s * rng.standard_normal(200_000)
        time = np.rint(time / sensors.timer_resolution_s) * sensors.timer_resolution_s
        drawn = (sensors.base_m / time).std()
        assert drawn == pytest.approx(float(sensors.reading_std_m_s(speed)), rel=0.02)


def test_a_reading_is_the_speed_at_the_middle_of_the_base() -> None:
    """A braked wheel rolled over the base by solve_ivp: the reading, and how far it is off the speed at the end."""
    v, a, base = 3.0, -1.2, SENSORS.base_m

    def at_end(_: float, y: np.ndarray) -> float:
        return float(y[0] - base)

    at_end.terminal = True  # type: ignore[attr-defined]
    rolled = solve_ivp(lambda _, y: [y[1], a], (0.0, 1.0), [0.0, v], events=at_end, rtol=1e-11, atol=1e-12)
    reading = base / rolled.t[-1]
    middle = np.sqrt(v * v + a * base)
    assert reading == pytest.approx(middle, abs=a * a * rolled.t[-1] ** 2 / (8 * v) * 1.1)
    assert reading - rolled.y[1, -1] == pytest.approx(-a * 0.5 * base / reading, rel=0.05)


def test_passages_come_in_the_order_of_the_path() -> None:
    every = passages(replace(SENSORS, axles=every_axle), CUT)
    assert len(every) == 16
    assert [each.path_m for each in every] == sorted(each.path_m for each in every)
    for each in every:
        assert each.path_m == SENSORS.path_m[each.sensor] + CUT.axle_offsets_m[each.axle]
    first = passages(replace(SENSORS, axles=first_axle), CUT)
    assert [each.path_m for each in first] == list(SENSORS.path_m)
    assert [each.sensor for each in deciding_passages(SENSORS, CUT, 22.5)] == [0, 1, 2]


def test_the_shortest_section_is_allowed_wherever_it_lies() -> None:
    for start in (-5.0, 0.9, 123.4):
        assert PointSensors((start, start + 0.3, start + 0.6)).path_m[0] == start


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"path_m": ()}, "0 entries"),
        ({"path_m": (0.0, 0.1)}, r"path_m\[1\] is 0.1"),
        ({"path_m": (float("nan"),)}, r"path_m\[0\]"),
        ({"path_m": (0.0, 0.5), "base_m": 0.6}, "must not overlap"),
        ({"base_tolerance": -1.0}, "base_tolerance"),
        ({"timer_noise_s": 1.0}, "timer_noise_s"),
        ({"scan_period_s": 0.0}, "scan_period_s"),
    ],
)
def test_impossible_sensors_are_refused(change: dict[str, Any], told: str) -> None:
    with pytest.raises(PlantError, match=told):
        replace(SENSORS, **change)
