"""A speed sensor of the library: a Doppler radar, each number with its origin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from plant_models.library.data_file import Quantity, number, parse_toml, sourced_table, take_string, telling
from plant_models.library.sourced_value import SourcedTable, SourcedValue
from plant_models.library.type_file import TypeFile
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
