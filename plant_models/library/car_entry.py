"""A car type of the library, its axle pattern stated or worked out of pivots and bogie; and a car mix: which types come
in which shares, and what the wind meets of them.

`plant_models.library` does not name the mix: what it makes knows the library's weight categories.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

from plant_models.cut import Car
from plant_models.errors import PlantError
from plant_models.library.data_file import (
    Quantity,
    number,
    numbers,
    parse_toml,
    shown,
    sourced_table,
    take_string,
    take_strings,
    telling,
)
from plant_models.library.library import BUILT_IN, CAR_MIXES, CARS, Library, TypeFile
from plant_models.library.sourced_value import SourcedTable, SourcedValue, Value
from plant_models.rolling.car_mix import CarMix, MixedCar

LENGTH = {"length_m": Quantity("m", number)}
BOGIE = {"bogie_axle_offsets_m": Quantity("m", numbers)}
MASSES = {"tare_t": Quantity("t", number), "gross_t": Quantity("t", number)}

TWO_BOGIES = {**LENGTH, "pivot_base_m": Quantity("m", number), **BOGIE, **MASSES}
SHARED_BOGIES = {**LENGTH, "pivots_m": Quantity("m", numbers), **BOGIE, **MASSES}
STATED_AXLES = {**LENGTH, "axle_offsets_m": Quantity("m", numbers), **MASSES}
"""Every key of a car file in its three forms."""

OF_MASS = frozenset(MASSES)
"""Keys that limit the mass of a car; all others are its drawing."""


@dataclass(frozen=True)
class CarEntry:
    """A car and the origin of its numbers; `tare_t` is the lightest, `gross_t` the heaviest of the type."""

    name: str
    title: str
    car: Car
    provenance: tuple[SourcedValue, ...]

    def __repr__(self) -> str:
        return f"CarEntry({self.name}: {self.title})"

    @property
    def drawing(self) -> tuple[SourcedValue, ...]:
        """The numbers of its length and axles."""
        return tuple(value for value in self.provenance if value.key not in OF_MASS)


def car_from(file: TypeFile) -> CarEntry:
    """The entry written in `file`; `TypeFileError` names file and key."""
    with telling(file.place, file.text, {f"car {file.name}: ": ""}):
        tree = parse_toml(file.text)
        title = take_string(tree, "title")
        table = sourced_table(tree, schema_of(tree), file.origin)
        car = Car(
            name=file.name,
            axle_offsets_m=axle_offsets_m(table),
            length_m=table.number("length_m"),
            tare_t=table.number("tare_t"),
            gross_t=table.number("gross_t"),
        )
    return CarEntry(file.name, title, car, table.values)


def schema_of(tree: Mapping[str, Any]) -> dict[str, Quantity]:
    """The form that a file has chosen: by all axles, by the pivots of several bogies, or by those of two."""
    if "axle_offsets_m" in tree:
        return STATED_AXLES
    return SHARED_BOGIES if "pivots_m" in tree else TWO_BOGIES


def axle_offsets_m(table: SourcedTable) -> tuple[float, ...]:
    """Axles behind the first: as stated, or those of equal bogies, each moved by its pivot.

    `bogie_axle_offsets_m`: axles of one bogie behind its first. Equal bogies carry the pivot at the same place, so the
    axles of another bogie are those of the first, moved by the distance of the two pivots.
    """
    keys = {value.key for value in table.values}
    if "axle_offsets_m" in keys:
        return table.numbers("axle_offsets_m")
    bogie = table.numbers("bogie_axle_offsets_m")
    pivots = table.numbers("pivots_m") if "pivots_m" in keys else (0.0, table.number("pivot_base_m"))
    return tuple(x if pivot == 0.0 else round(x + pivot, 6) for pivot in pivots for x in bogie)


OF_A_CAR: Final = {
    "share": Quantity("1", number),
    "frontal_area_m2": Quantity("m2", number),
    "drag_coefficient": Quantity("1", number),
}
OF_ALL: Final = {"following_share": Quantity("1", number), "underload_mean_t": Quantity("t", number)}


@dataclass(frozen=True)
class CarMixEntry:
    """A mix and the origin of its numbers, those of its cars among them; keys 'cars.NAME.share' and the like."""

    name: str
    title: str
    notes: tuple[str, ...]
    mix: CarMix
    provenance: tuple[SourcedValue, ...]

    def with_values(self, overrides: Mapping[str, Value]) -> CarMixEntry:
        """This entry with `following_share` or `underload_mean_t` replaced; `PlantError` if it makes no mix."""
        table = SourcedTable(self.provenance).replaced(overrides)
        mix = CarMix(self.mix.cars, table.number("following_share"), table.number("underload_mean_t"))
        return CarMixEntry(self.name, self.title, self.notes, mix, table.values)


def load_car_mix(name: str, library: Library = BUILT_IN) -> CarMixEntry:
    """The car mix `name`; `PlantError` with a hint if there is none, or of a fault in its file."""
    return car_mix_from(library.file(CAR_MIXES, name), library)


def car_mix_from(file: TypeFile, library: Library) -> CarMixEntry:
    """The entry written in `file`, with the cars of `library`; `TypeFileError` names file and key."""
    with telling(file.place, file.text, {"car mix: ": ""}):
        tree = parse_toml(file.text)
        title, notes = take_string(tree, "title"), take_strings(tree, "notes")
        names = car_names_in(tree)
        schema = {f"cars.{name}.{key}": quantity for name in names for key, quantity in OF_A_CAR.items()}
        table = sourced_table(tree, {**schema, **OF_ALL}, file.origin)
        entries = tuple(car_entry(name, library) for name in names)
        cars = tuple(mixed_car(entry, table) for entry in entries)
        mix = CarMix(cars, table.number("following_share"), table.number("underload_mean_t"))
    own = (replace(v, key=f"cars.{entry.name}.{v.key}") for entry in entries for v in entry.provenance)
    return CarMixEntry(file.name, title, notes, mix, (*table.values, *own))


def car_names_in(tree: Mapping[str, Any]) -> tuple[str, ...]:
    """The names of the tables under [cars], which are those of car types."""
    cars = tree.get("cars")
    if not isinstance(cars, dict) or not cars:
        raise PlantError(f"cars is {shown(cars)}; it must be a table with one table for each type of car")
    return tuple(cars)


def car_entry(name: str, library: Library) -> CarEntry:
    """The car type `name`; `PlantError` with the key if there is none."""
    try:
        file = library.file(CARS, name)
    except PlantError as fault:
        raise PlantError(f"cars.{name}: {fault}") from None
    return car_from(file)


def mixed_car(entry: CarEntry, table: SourcedTable) -> MixedCar:
    """A car with its share and its C_x·S."""
    key = f"cars.{entry.name}"
    area = table.number(f"{key}.frontal_area_m2") * table.number(f"{key}.drag_coefficient")
    return MixedCar(entry.car, table.number(f"{key}.share"), area)
