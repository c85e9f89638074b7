"""A car type of the library: its axle pattern, stated or worked out of pivots and bogie."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from plant_models.cut import Car
from plant_models.library.data_file import (
    Quantity,
    number,
    numbers,
    parse_toml,
    sourced_table,
    take_string,
    telling,
)
from plant_models.library.sourced_value import SourcedTable, SourcedValue
from plant_models.library.type_file import TypeFile

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
