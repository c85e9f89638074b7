"""Speed sensors of the library, each number with its origin: a Doppler radar, and a point sensor, wherever it
stands.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from plant_models.library.data_file import Quantity, number, parse_toml, sourced_table, take_string, telling
from plant_models.library.library import TypeFile
from plant_models.library.sourced_value import SourcedTable, SourcedValue
from plant_models.point_sensors import Axles, PointSensors, first_axle
from plant_models.speed_sensor import DopplerSensor

SENSOR_SCHEMA: Mapping[str, Quantity] = {
    "noise_m_s": Quantity("m/s", number),
    "resolution_m_s": Quantity("m/s", number),
    "sample_period_s": Quantity("s", number),
    "computing_delay_s": Quantity("s", number),
    "missed_share": Quantity("1", number),
    "missed_burst_s": Quantity("s", number),
}
"""Every key of a sensor file."""


@dataclass(frozen=True)
class SensorEntry:
    """A radar and the origin of its numbers; keys as in its file."""

    name: str
    title: str
    sensor: DopplerSensor
    provenance: tuple[SourcedValue, ...]


def sensor_from(file: TypeFile) -> SensorEntry:
    """The entry written in `file`; `TypeFileError` names file and key."""
    with telling(file.place, file.text, {"sensor: ": ""}):
        tree = parse_toml(file.text)
        title = take_string(tree, "title")
        table = sourced_table(tree, SENSOR_SCHEMA, file.origin)
        return SensorEntry(file.name, title, sensor_of(table, ""), table.values)


def sensor_of(table: SourcedTable, prefix: str) -> DopplerSensor:
    """The sensor whose numbers stand in `table` under `prefix`."""
    return DopplerSensor(**{key: table.number(prefix + key) for key in SENSOR_SCHEMA})


WHEEL_SENSOR_SCHEMA: Mapping[str, Quantity] = {
    "base_m": Quantity("m", number),
    "base_tolerance": Quantity("1", number),
    "timer_noise_s": Quantity("s", number),
    "timer_resolution_s": Quantity("s", number),
    "computing_delay_s": Quantity("s", number),
    "scan_period_s": Quantity("s", number),
    "missed_share": Quantity("1", number),
}
"""Every key of a wheel sensor's file."""

AT_THE_ENTRANCE = (0.0,)
"""A place for one sensor, to try its numbers."""


@dataclass(frozen=True)
class WheelSensorEntry:
    """A type of point sensors and the origin of its numbers; keys as in its file."""

    name: str
    title: str
    provenance: tuple[SourcedValue, ...]

    def with_values(self, overrides: Mapping[str, float]) -> WheelSensorEntry:
        """This entry with the user's numbers under some of the keys."""
        return WheelSensorEntry(self.name, self.title, SourcedTable(self.provenance).replaced(overrides).values)

    def at(self, path_m: tuple[float, ...], axles: Axles = first_axle) -> PointSensors:
        """Such sensors at `path_m`, whose regulator decides on `axles`; `PlantError` if that makes no sense."""
        table = SourcedTable(self.provenance)
        return PointSensors(path_m, **{key: table.number(key) for key in WHEEL_SENSOR_SCHEMA}, axles=axles)


def wheel_sensor_from(file: TypeFile) -> WheelSensorEntry:
    """The entry written in `file`; `TypeFileError` names file and key."""
    with telling(file.place, file.text, {"sensors: ": ""}):
        tree = parse_toml(file.text)
        title = take_string(tree, "title")
        entry = WheelSensorEntry(file.name, title, sourced_table(tree, WHEEL_SENSOR_SCHEMA, file.origin).values)
        entry.at(AT_THE_ENTRANCE)
        return entry
