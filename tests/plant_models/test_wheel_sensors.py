"""Point sensors of the library, and the position behind a car dumper that they are for."""

import pytest

from plant_models import PointSensors, every_axle, first_axle
from plant_models.library import BUILT_IN, WHEEL_SENSORS, TypeFile, TypeFileError, load_position, load_wheel_sensor
from plant_models.library.sourced_value import SourcedTable
from plant_models.library.wheel_sensor_entry import WHEEL_SENSOR_SCHEMA, wheel_sensor_from

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
