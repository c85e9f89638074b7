"""What the library holds, by name."""

from __future__ import annotations

from plant_models.library.car_entry import CarEntry, car_from_toml
from plant_models.library.data_file import library_names, library_text
from plant_models.library.retarder_entry import RetarderEntry, retarder_from_toml


def retarder_names() -> tuple[str, ...]:
    """Names of the retarder positions, sorted."""
    return library_names("retarders")


def load_retarder(name: str) -> RetarderEntry:
    """The retarder position `name`; `PlantError` with a hint if there is none."""
    return retarder_from_toml(library_text("retarders", name), name)


def car_names() -> tuple[str, ...]:
    """Names of the car types, sorted."""
    return library_names("cars")


def load_car(name: str) -> CarEntry:
    """The car type `name`; `PlantError` with a hint if there is none."""
    return car_from_toml(library_text("cars", name), name)
