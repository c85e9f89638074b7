"""Radars and point sensors: resolutions, errors, order of passages, and the types of the library."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from plant_models import Approach, Cut, DopplerSensor, PlantError, PointSensors, every_axle, first_axle
from plant_models.library import BUILT_IN, WHEEL_SENSORS, TypeFile, TypeFileError, load_position, load_wheel_sensor
from plant_models.library.sensor_entry import WHEEL_SENSOR_SCHEMA, wheel_sensor_from
from plant_models.library.sourced_value import SourcedTable
from plant_models.point_sensors import deciding_passages, passages
from plant_models.speed_sensor import FINEST_RESOLUTION_M_S
from plant_models.track_profile import SHORTEST_APPROACH_M


@pytest.mark.parametrize("resolution_m_s", [0.0, 1e-6, 0.01, 1.0])
def test_a_resolution_that_gives_numbers(resolution_m_s: float) -> None:
    sensor = DopplerSensor(0.05, resolution_m_s, 0.1, 0.02)
    if resolution_m_s:
        assert round(9.0 / sensor.resolution_m_s) * sensor.resolution_m_s == pytest.approx(9.0, abs=resolution_m_s)


@pytest.mark.parametrize("resolution_m_s", [5e-324, 1e-300, 9e-7, -1e-6, 1.1, float("nan")])
def test_no_other_resolution(resolution_m_s: float) -> None:
    with pytest.raises(PlantError, match="sensor: resolution_m_s is"):
        DopplerSensor(0.05, resolution_m_s, 0.1, 0.02)


NOTHING_OR_FROM: Final[Mapping[str, tuple[float, Callable[[float], object]]]] = {
    "sensor: resolution_m_s": (FINEST_RESOLUTION_M_S, lambda number: DopplerSensor(0.05, number, 0.1, 0.02)),
    "sensor: missed_burst_s": (0.1, lambda number: DopplerSensor(0.05, 0.0, 0.1, 0.02, 0.1 * (number > 0.0), number)),
    "regulator: approach_m": (SHORTEST_APPROACH_M, Approach),
}


@pytest.mark.parametrize("key", NOTHING_OR_FROM)
def test_nothing_is_allowed_or_a_least_number_and_more(key: str) -> None:
    least, make = NOTHING_OR_FROM[key]
    for allowed in (0.0, least, 2.0 * least):
        make(allowed)
    with pytest.raises(PlantError, match=f"{key} is"):
        make(math.nextafter(least, 0.0))


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


GOOD = BUILT_IN.file(WHEEL_SENSORS, "ds-2").text


def test_a_type_makes_sensors_wherever_they_stand() -> None:
    entry = load_wheel_sensor("ds-2")
    sensors = entry.at((-4.0, 6.0), every_axle)
    assert (sensors.path_m, sensors.base_m, sensors.axles) == ((-4.0, 6.0), 0.2, every_axle)
    assert entry.at((0.0,)) == PointSensors((0.0,), axles=first_axle)  # the plant's own defaults are this type
    changed = entry.with_values({"base_m": 0.25})
    assert changed.at((0.0,)).base_m == 0.25
    assert {v.key: v.source for v in changed.provenance if v.source == "configuration"} == {"base_m": "configuration"}


def test_every_number_has_an_origin() -> None:
    values = load_wheel_sensor("ds-2").provenance
    assert [value.key for value in values] == list(WHEEL_SENSOR_SCHEMA)
    assert all(value.source and value.confidence and value.range and value.in_range for value in values)
    assert [value.key for value in values if not value.assumed] == ["base_m"]  # the only one that the source tells


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("base_m", "bas_m", "unknown key bas_m; did you mean base_m?"),
        ("value = 0.2,", "value = 2.0,", "base_m.value is 2.0; it is outside its own range"),
        ("value = 0.2, range = [0.15, 0.3]", "value = 2.0, range = [0.1, 3.0]", "base_m is 2.0; it must be a"),
        ("value = 0.02, range = [0.005", "value = 0.0, range = [0.0", "scan_period_s is 0.0; it must be a"),
    ],
)  # fmt: skip
def test_a_faulty_type_is_told_with_file_key_and_value(old: str, new: str, said: str) -> None:
    assert old in GOOD
    with pytest.raises(TypeFileError) as caught:
        wheel_sensor_from(TypeFile(WHEEL_SENSORS, "bad", GOOD.replace(old, new, 1), "wheel_sensors/bad.toml"))
    line = 1 + next(number for number, each in enumerate(GOOD.splitlines()) if old in each)
    assert str(caught.value).startswith(f"wheel_sensors/bad.toml, line {line}: {said}")


def test_oil_takes_force_and_certainty_from_the_dumper_position() -> None:
    oiled, dry = load_position("rnz-2m-dumper"), load_position("rnz-2m-park")
    assert oiled.position.zones_m == dry.position.zones_m
    assert oiled.position.pneumatics == dry.position.pneumatics
    pressures = oiled.position.stage_pressures_kpa
    touch = oiled.position.force.touch_pressure_kpa
    slopes = [SourcedTable(entry.provenance).number("retarder.force.slope_kn_per_kpa") for entry in (oiled, dry)]
    # What the note of the position says: with oil stage 3 brakes no harder than stage 2 without.
    assert slopes[0] * (pressures[3] - touch) < slopes[1] * (pressures[2] - touch)
    assert oiled.friction.common_cv > dry.friction.common_cv
    assert oiled.friction.path_std > dry.friction.path_std
