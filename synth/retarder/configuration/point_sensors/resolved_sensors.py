"""Point sensors of a configuration with every number filled in, and the plants that they serve."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Final

from plant_models import Plant, PlantError, PointSensors, every_axle, first_axle
from plant_models.library import WHEEL_SENSORS, Library, SourcedValue, load_wheel_sensor
from plant_models.point_sensors import Axles
from synth.frame.settings.numbers import library_values, numbers_of
from synth.retarder.configuration.plant_fault import in_file, require_held
from synth.retarder.configuration.point_sensors.settings import PointSensorSettings
from synth.solver.chain.sensor_passages import with_point_sensors

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
