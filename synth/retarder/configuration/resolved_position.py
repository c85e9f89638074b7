"""The position that a configuration names, with the user's types and values in it; its point sensors with every
number filled in, and the plants that they serve.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Final

from plant_models import Plant, PlantError, PointSensors, every_axle, first_axle
from plant_models.library import (
    POSITIONS,
    RETARDERS,
    SENSORS,
    WHEEL_SENSORS,
    Library,
    PositionEntry,
    SourcedValue,
    load_wheel_sensor,
)
from plant_models.library.position_entry import position_with_types
from plant_models.point_sensors import Axles
from synth.frame.faults import InputError
from synth.frame.settings.numbers import library_values, numbers_of
from synth.retarder.configuration.plant_fault import in_file, require_held
from synth.retarder.configuration.plant_settings import DEFAULT_POSITION, PointSensorSettings
from synth.retarder.configuration.settings import Settings
from synth.solver.chain.sampling import with_point_sensors


def resolve_position(settings: Settings, file: str, library: Library) -> PositionEntry:
    """The library's position, other types in it where the file says so, and the values that it sets."""
    name = require_held(f"{file}: position.name", POSITIONS, settings.position.name or DEFAULT_POSITION, library)
    types = (("retarder.type", RETARDERS, settings.retarder.type), ("sensor.type", SENSORS, settings.sensor.type))
    for key, kind, chosen in types:
        if chosen is not None:
            require_held(f"{file}: {key}", kind, chosen, library)
    zones = settings.retarder.zones_m
    if zones is not None and zones[0][0] != 0.0:
        raise InputError(
            f"{file}: retarder.zones_m begins with {zones[0]}; the first zone must start at 0, the entrance"
        )
    with in_file(file):
        entry = position_with_types(name, library, settings.retarder.type, settings.sensor.type)
        return entry.with_values(settings.library_overrides())


SECTION: Final = "sensors."
AXLES: Final[dict[str, Axles]] = {"first_axle": first_axle, "every_axle": every_axle}


@dataclass(frozen=True)
class ResolvedSensors:
    """The sensors, the name of their type, whose passages they decide at, and the origin of their numbers.

    `provenance`: keys as in a configuration.
    """

    type: str
    sensors: PointSensors
    decides_on: str
    provenance: tuple[SourcedValue, ...]

    def canonical(self) -> dict[str, Any]:
        """The section as it enters the canonical JSON of a configuration."""
        numbers = {value.key.removeprefix(SECTION): value.value for value in self.provenance}
        return {**numbers, "decides_on": self.decides_on}

    def serving(self, plant: Plant) -> Plant:
        """`plant` with these sensors in place of its radar: the regulator acts from the first of them on.

        `PlantError` begins with "sensors: " where the sensors are at fault.
        """
        try:
            return with_point_sensors(plant, self.sensors)
        except PlantError as fault:
            told = str(fault)
            approach = "regulator: approach_m is "
            if not told.startswith(approach):
                raise
            way = "sensors: path_m: the way from the first sensor to the entrance is "
            raise PlantError(way + told.removeprefix(approach).replace("shorten the approach", "shorten it")) from None


def resolve_sensors(settings: PointSensorSettings, file: str, library: Library) -> ResolvedSensors:
    """The sensors of the section [sensors]; `InputError` names `file`, key and value of what does not fit."""
    require_held(f"{file}: sensors.type", WHEEL_SENSORS, settings.type, library)
    with in_file(file):
        entry = load_wheel_sensor(settings.type, library).with_values(dict(library_values(settings)))
        sensors = entry.at(settings.path_m, AXLES[settings.decides_on])
    numbers = (*numbers_of(settings), *entry.provenance)
    origins = tuple(replace(value, key=SECTION + value.key) for value in numbers)
    return ResolvedSensors(settings.type, sensors, settings.decides_on, origins)


def require_served(resolved: ResolvedSensors, plants: Iterable[tuple[str, Plant]], file: str) -> None:
    """`InputError` where the sensors cannot serve one of the (label, plant)."""
    for label, plant in plants:
        with in_file(file):
            try:
                resolved.serving(plant)
            except PlantError as fault:
                raise PlantError(f"{fault} (cut class {label})") from fault
