"""What a library holds, by name."""

from __future__ import annotations

from plant_models.library.car_entry import CarEntry, car_from
from plant_models.library.library import (
    BUILT_IN,
    CARS,
    POSITIONS,
    TRACKS,
    WEIGHT_CATEGORIES,
    WHEEL_SENSORS,
    Library,
)
from plant_models.library.position_entry import PositionEntry, position_with_types
from plant_models.library.sensor_entry import WheelSensorEntry, wheel_sensor_from
from plant_models.library.track_entry import TrackEntry, track_from
from plant_models.library.weight_category import WeightCategories, categories_from

YARD_CATEGORIES = "hump-norm"
"""The set of weight categories that counts where none is named."""


def position_names(library: Library = BUILT_IN) -> tuple[str, ...]:
    """Names of the retarder positions, sorted.

    Parameters
    ----------
    library
        The types of the program, or those with your own beside them.

    Returns
    -------
    tuple of str
        What `load_position` takes.

    Examples
    --------
    >>> from plant_models.library import position_names
    >>> position_names()[:2]
    ('knp-5-bunch', 'kv-3-bunch')
    """
    return library.names(POSITIONS)


def load_position(name: str, library: Library = BUILT_IN) -> PositionEntry:
    """Load a retarder position with its usual surroundings.

    Parameters
    ----------
    name
        Name of the position.
    library
        The types of the program, or those with your own beside them.

    Returns
    -------
    PositionEntry
        `position`, `profile`, `entry`, `friction`, `sensor` and `approach`; `provenance` says where each number is
        from.

    Raises
    ------
    PlantError
        There is no such name, or its file is at fault; the sentence says what is near.

    Examples
    --------
    >>> from plant_models.library import load_position
    >>> at = load_position("knp-5-bunch")
    >>> at.position.stage_pressures_kpa
    (0.0, 150.0, 300.0, 450.0, 600.0)
    """
    return position_with_types(name, library)


def car_names(library: Library = BUILT_IN) -> tuple[str, ...]:
    """Names of the car types, sorted.

    Parameters
    ----------
    library
        The types of the program, or those with your own beside them.

    Returns
    -------
    tuple of str
        What `load_car` takes.

    Examples
    --------
    >>> from plant_models.library import car_names
    >>> "gondola-4" in car_names()
    True
    """
    return library.names(CARS)


def load_car(name: str, library: Library = BUILT_IN) -> CarEntry:
    """Load a car type.

    Parameters
    ----------
    name
        Name of the car.
    library
        The types of the program, or those with your own beside them.

    Returns
    -------
    CarEntry
        `car`, and where its numbers are from.

    Raises
    ------
    PlantError
        There is no such name, or its file is at fault; the sentence says what is near.

    Examples
    --------
    >>> from plant_models.library import load_car
    >>> load_car("gondola-4").car.length_m
    13.92
    """
    return car_from(library.file(CARS, name))


def load_wheel_sensor(name: str, library: Library = BUILT_IN) -> WheelSensorEntry:
    """Load a wheel sensor.

    Parameters
    ----------
    name
        Name of the sensor.
    library
        The types of the program, or those with your own beside them.

    Returns
    -------
    WheelSensorEntry
        The sensor, and where its numbers are from.

    Raises
    ------
    PlantError
        There is no such name, or its file is at fault; the sentence says what is near.

    Examples
    --------
    >>> from plant_models.library import BUILT_IN, WHEEL_SENSORS, load_wheel_sensor
    >>> name = BUILT_IN.names(WHEEL_SENSORS)[0]
    >>> load_wheel_sensor(name).name == name
    True
    """
    return wheel_sensor_from(library.file(WHEEL_SENSORS, name))


def load_weight_categories(name: str = YARD_CATEGORIES, library: Library = BUILT_IN) -> WeightCategories:
    """Load a set of weight categories.

    Parameters
    ----------
    name
        Name of the set.
    library
        The types of the program, or those with your own beside them.

    Returns
    -------
    WeightCategories
        `of` gives the category of a mass, `named` that of a name.

    Raises
    ------
    PlantError
        There is no such name, or its file is at fault; the sentence says what is near.

    Examples
    --------
    >>> from plant_models.library import load_weight_categories
    >>> load_weight_categories().of(52.0).label
    'С (S)'
    """
    return categories_from(library.file(WEIGHT_CATEGORIES, name))


def load_track(name: str, library: Library = BUILT_IN) -> TrackEntry:
    """Load the track of a park.

    Parameters
    ----------
    name
        Name of the track.
    library
        The types of the program, or those with your own beside them.

    Returns
    -------
    TrackEntry
        The track, and where its numbers are from.

    Raises
    ------
    PlantError
        There is no such name, or its file is at fault; the sentence says what is near.

    Examples
    --------
    >>> from plant_models.library import BUILT_IN, TRACKS, load_track
    >>> name = BUILT_IN.names(TRACKS)[0]
    >>> load_track(name).name == name
    True
    """
    return track_from(library.file(TRACKS, name))
