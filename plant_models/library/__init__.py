"""Retarders, cars, sensors, weight categories and positions as data: every number with unit, range and source."""

from plant_models.library.car_entry import CarEntry
from plant_models.library.catalogue import (
    YARD_CATEGORIES,
    car_names,
    load_car,
    load_position,
    load_track,
    load_weight_categories,
    load_wheel_sensor,
    position_names,
)
from plant_models.library.hump_entry import HumpEntry, hump_names, load_hump
from plant_models.library.library import (
    BUILT_IN,
    CAR_MIXES,
    CARS,
    KINDS,
    POSITIONS,
    RETARDERS,
    SENSORS,
    TRACKS,
    WEIGHT_CATEGORIES,
    WHEEL_SENSORS,
    Kind,
    Library,
    TypeFile,
    TypeFileError,
)
from plant_models.library.position_entry import PositionEntry
from plant_models.library.retarder_entry import RetarderEntry
from plant_models.library.sensor_entry import SensorEntry, WheelSensorEntry
from plant_models.library.source import Source, sources, sources_cited_in
from plant_models.library.sourced_value import SourcedValue, Value
from plant_models.library.track_entry import TrackEntry
from plant_models.library.weight_category import WeightCategories, WeightCategory

__all__ = [
    "BUILT_IN",
    "CARS",
    "CAR_MIXES",
    "KINDS",
    "POSITIONS",
    "RETARDERS",
    "SENSORS",
    "TRACKS",
    "WEIGHT_CATEGORIES",
    "WHEEL_SENSORS",
    "YARD_CATEGORIES",
    "CarEntry",
    "HumpEntry",
    "Kind",
    "Library",
    "PositionEntry",
    "RetarderEntry",
    "SensorEntry",
    "Source",
    "SourcedValue",
    "TrackEntry",
    "TypeFile",
    "TypeFileError",
    "Value",
    "WeightCategories",
    "WeightCategory",
    "WheelSensorEntry",
    "car_names",
    "hump_names",
    "load_car",
    "load_hump",
    "load_position",
    "load_track",
    "load_weight_categories",
    "load_wheel_sensor",
    "position_names",
    "sources",
    "sources_cited_in",
]


def __dir__() -> list[str]:
    return __all__
