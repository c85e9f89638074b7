"""A car type of the library: its axle pattern worked out of pivot base and bogie."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.cut import Car
from plant_models.errors import PlantError
from plant_models.library.data_file import Quantity, number, numbers, parse_toml, sourced_table, take_string
from plant_models.library.sourced_value import SourcedValue

CAR_SCHEMA = {
    "length_m": Quantity("m", number),
    "pivot_base_m": Quantity("m", number),
    "bogie_axle_offsets_m": Quantity("m", numbers),
    "tare_t": Quantity("t", number),
    "gross_t": Quantity("t", number),
}
"""Every key of a car file."""


@dataclass(frozen=True)
class CarEntry:
    """A car and the origin of its numbers; `tare_t` is the lightest, `gross_t` the heaviest of the type."""

    name: str
    title: str
    car: Car
    provenance: tuple[SourcedValue, ...]


def car_from_toml(text: str, name: str) -> CarEntry:
    """The entry written in `text`, the content of cars/`name`.toml; `PlantError` names file and key."""
    file = f"cars/{name}.toml"
    tree = parse_toml(text, file)
    title = take_string(tree, "title", file)
    table = sourced_table(tree, CAR_SCHEMA, file)
    try:
        car = Car(
            name=name,
            axle_offsets_m=axle_offsets_m(table.numbers("bogie_axle_offsets_m"), table.number("pivot_base_m")),
            length_m=table.number("length_m"),
            tare_t=table.number("tare_t"),
            gross_t=table.number("gross_t"),
        )
    except PlantError as error:
        raise PlantError(f"{file}: {error}") from None
    return CarEntry(name, title, car, table.values)


def axle_offsets_m(bogie_axle_offsets_m: tuple[float, ...], pivot_base_m: float) -> tuple[float, ...]:
    """Axles behind the first of a car on two equal, symmetric bogies whose pivots are `pivot_base_m` apart.

    `bogie_axle_offsets_m`: axles of one bogie behind its first. Equal bogies carry the pivot at the same
    place, so the second bogie's axles are the first's, moved by the pivot base.
    """
    second = tuple(round(x + pivot_base_m, 6) for x in bogie_axle_offsets_m)
    return bogie_axle_offsets_m + second
