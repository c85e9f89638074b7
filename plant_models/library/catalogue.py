"""What a library holds, by name."""

from __future__ import annotations

from plant_models.library.car_entry import CarEntry, car_from
from plant_models.library.library import BUILT_IN, Library
from plant_models.library.position_entry import PositionEntry, position_with_types
from plant_models.library.track_entry import TrackEntry, track_from
from plant_models.library.type_file import (
    CARS,
    POSITIONS,
    TRACKS,
    WEIGHT_CATEGORIES,
    WHEEL_SENSORS,
)
from plant_models.library.weight_category import WeightCategories, categories_from
from plant_models.library.wheel_sensor_entry import WheelSensorEntry, wheel_sensor_from

YARD_CATEGORIES = "hump-norm"
"""The set of weight categories that counts where none is named."""


def position_names(library: Library = BUILT_IN) -> tuple[str, ...]:
    """Names of the retarder positions, sorted."""
    return library.names(POSITIONS)


def load_position(name: str, library: Library = BUILT_IN) -> PositionEntry:
    """The retarder position `name`; `PlantError` with a hint if there is none, or of a fault in its files."""
    return position_with_types(name, library)


def car_names(library: Library = BUILT_IN) -> tuple[str, ...]:
    """Names of the car types, sorted."""
    return library.names(CARS)


def load_car(name: str, library: Library = BUILT_IN) -> CarEntry:
    """The car type `name`; `PlantError` as `load_position`."""
    return car_from(library.file(CARS, name))


def load_wheel_sensor(name: str, library: Library = BUILT_IN) -> WheelSensorEntry:
    """The wheel sensor `name`; `PlantError` as `load_position`."""
    return wheel_sensor_from(library.file(WHEEL_SENSORS, name))


def load_weight_categories(name: str = YARD_CATEGORIES, library: Library = BUILT_IN) -> WeightCategories:
    """The set of weight categories `name`; `PlantError` as `load_position`."""
    return categories_from(library.file(WEIGHT_CATEGORIES, name))


def load_track(name: str, library: Library = BUILT_IN) -> TrackEntry:
    """The track `name`; `PlantError` as `load_position`."""
    return track_from(library.file(TRACKS, name))
