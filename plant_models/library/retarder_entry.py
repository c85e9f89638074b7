"""A retarder type of the library: length, pressures, force law and drive of one unit, each number with its origin."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from plant_models.errors import near_miss, require
from plant_models.library.data_file import (
    Quantity,
    number,
    numbers,
    parse_toml,
    sourced_table,
    take_string,
    take_strings,
    telling,
)
from plant_models.library.library import TypeFile
from plant_models.library.sourced_value import SourcedTable, SourcedValue
from plant_models.pneumatics import Pneumatics
from plant_models.retarder import ForceLaw, PressingForce, RetarderPosition, WeightForce

FORCE = "force."
PNEUMATICS = "pneumatics."

DAY_SPREAD: Final = "retarder." + PNEUMATICS + "day_spread"
"""Where a configuration has the spread of the valves from day to day."""


@dataclass(frozen=True)
class LawInLibrary:
    """A force law as files name it: the key of its slope, the slope's unit, and its constructor."""

    slope_key: str
    slope_unit: str
    build: Callable[[float, float, tuple[float, ...]], ForceLaw]


FORCE_LAWS: Mapping[str, LawInLibrary] = MappingProxyType(
    {
        "pressing": LawInLibrary(FORCE + "slope_kn_per_kpa", "kN/kPa per wheel pair", PressingForce),
        "weight": LawInLibrary(FORCE + "slope_kn_per_kpa_per_t", "kN/kPa per tonne of axle load", WeightForce),
    }
)

LENGTH = {"length_m": Quantity("m", number)}


def drive_schema(law: str) -> dict[str, Quantity]:
    """Every key of a retarder file with the force law `law`, but its length."""
    force = FORCE_LAWS[law]
    return {
        "stage_pressures_kpa": Quantity("kPa gauge", numbers),
        "max_entry_speed_m_s": Quantity("m/s", number),
        force.slope_key: Quantity(force.slope_unit, number),
        FORCE + "touch_pressure_kpa": Quantity("kPa gauge", number),
        FORCE + "slope_factor_by_axles": Quantity("1", numbers),
        PNEUMATICS + "supply_pressure_kpa": Quantity("kPa gauge", number),
        PNEUMATICS + "exhaust_pressure_kpa": Quantity("kPa gauge", number),
        PNEUMATICS + "brake_delay_s": Quantity("s", number),
        PNEUMATICS + "touch_delay_s": Quantity("s", number),
        PNEUMATICS + "release_delay_s": Quantity("s", number),
        PNEUMATICS + "fill_time_constant_s": Quantity("s", number),
        PNEUMATICS + "exhaust_time_constant_s": Quantity("s", number),
        PNEUMATICS + "dead_band_kpa": Quantity("kPa", number),
        PNEUMATICS + "closing_delay_s": Quantity("s", number),
        PNEUMATICS + "day_spread": Quantity("1", number),
    }


@dataclass(frozen=True)
class RetarderEntry:
    """A type: what one unit of it is like wherever it stands.

    `drive`: every number but the length, keys as in the file; with the zones of a site they make a position.
    """

    name: str
    title: str
    notes: tuple[str, ...]
    law: str
    length: SourcedValue
    drive: SourcedTable

    @property
    def length_m(self) -> float:
        """Length over which one unit brakes."""
        assert isinstance(self.length.value, float)
        return self.length.value


def retarder_from(file: TypeFile) -> RetarderEntry:
    """The entry written in `file`; `TypeFileError` names file and key."""
    with telling(file.place, file.text, {"retarder: ": "", "force: ": FORCE, "pneumatics: ": PNEUMATICS}):
        tree = parse_toml(file.text)
        title, law = take_string(tree, "title"), take_string(tree, "law")
        notes = take_strings(tree, "notes")
        require(law in FORCE_LAWS, f"law is {law!r}; {near_miss(law, FORCE_LAWS)}")
        table = sourced_table(tree, {**LENGTH, **drive_schema(law)}, file.origin)
        length, *drive = table.values
        length_m = table.number("length_m")
        require(0.5 <= length_m <= 100.0, f"length_m.value is {length_m:g}; it must be from 0.5 to 100")
        entry = RetarderEntry(file.name, title, notes, law, length, SourcedTable(tuple(drive)))
        unit = position_of(file.name, ((0.0, length_m),), law, entry.drive, "")  # a type must make sense by itself
        unit.require_settling()
    return entry


def position_of(
    name: str, zones_m: tuple[tuple[float, float], ...], law: str, table: SourcedTable, prefix: str
) -> RetarderPosition:
    """The position `name` of retarders in `zones_m` whose other numbers stand in `table` under `prefix`."""
    force = FORCE_LAWS[law]
    pneumatics = {
        key.removeprefix(PNEUMATICS): table.number(prefix + key)
        for key in drive_schema(law)
        if key.startswith(PNEUMATICS)
    }
    return RetarderPosition(
        name=name,
        zones_m=zones_m,
        stage_pressures_kpa=table.numbers(prefix + "stage_pressures_kpa"),
        force=force.build(
            table.number(prefix + force.slope_key),
            table.number(prefix + FORCE + "touch_pressure_kpa"),
            table.numbers(prefix + FORCE + "slope_factor_by_axles"),
        ),
        pneumatics=Pneumatics(**pneumatics),
        max_entry_speed_m_s=table.number(prefix + "max_entry_speed_m_s"),
    )
