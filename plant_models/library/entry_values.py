"""Entry speeds as files write them: which keys stand for which law, in a position and in a configuration."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from plant_models.entry_speed import EntryLaw, EntrySpeed, HistogramEntrySpeed, NormalEntrySpeed
from plant_models.errors import PlantError, require
from plant_models.library.data_file import Quantity, number, numbers
from plant_models.library.sourced_value import SET_BY_USER, SourcedTable, SourcedValue, Value

ENTRY: Final = "entry."

UNIFORM: Final[Mapping[str, Quantity]] = {"low_m_s": Quantity("m/s", number), "high_m_s": Quantity("m/s", number)}
NORMAL: Final[Mapping[str, Quantity]] = {
    **UNIFORM,
    "mean_m_s": Quantity("m/s", number),
    "std_m_s": Quantity("m/s", number),
}
HISTOGRAM: Final[Mapping[str, Quantity]] = {"edges_m_s": Quantity("m/s", numbers), "shares": Quantity("1", numbers)}
ALTERNATIVES: Final = (
    "low_m_s and high_m_s (uniform), these with mean_m_s and std_m_s (normal), or edges_m_s and shares (histogram)"
)


def entry_schema(keys: set[str]) -> Mapping[str, Quantity]:
    """The keys of the law that `keys` begin to describe; `PlantError` where they are of two laws."""
    if keys & HISTOGRAM.keys():
        require(
            keys <= HISTOGRAM.keys(),
            f"entry: {', '.join(sorted(keys - HISTOGRAM.keys()))} cannot stand beside a histogram; give {ALTERNATIVES}",
        )
        return HISTOGRAM
    return NORMAL if keys & (NORMAL.keys() - UNIFORM.keys()) else UNIFORM


def entry_law(table: SourcedTable, prefix: str = ENTRY) -> EntryLaw:
    """The law whose numbers stand in `table` under `prefix`."""
    keys = {value.key.removeprefix(prefix) for value in table.values if value.key.startswith(prefix)}
    if keys == HISTOGRAM.keys():
        return HistogramEntrySpeed(table.numbers(prefix + "edges_m_s"), table.numbers(prefix + "shares"))
    low, high = table.number(prefix + "low_m_s"), table.number(prefix + "high_m_s")
    if keys == NORMAL.keys():
        return NormalEntrySpeed(low, high, table.number(prefix + "mean_m_s"), table.number(prefix + "std_m_s"))
    return EntrySpeed(low, high)


def with_entry(values: tuple[SourcedValue, ...], changes: Mapping[str, Value]) -> tuple[SourcedValue, ...]:
    """The sourced values of one law (keys without prefix) with those of a configuration put in.

    A histogram replaces the law as a whole, and low_m_s or high_m_s replace a histogram; a mean and a std keep the
    limits that are there. `PlantError` where something is missing for a law.
    """
    if not changes:
        return values
    schema = entry_schema(set(changes))
    there = {value.key: value for value in values}
    if schema is UNIFORM and there.keys() == NORMAL.keys():
        schema = NORMAL
    found = []
    for key, quantity in schema.items():
        if key in changes and key in there:
            found.append(there[key].replaced(changes[key]))
        elif key in changes:
            found.append(SourcedValue(key, changes[key], quantity.unit, None, SET_BY_USER, ""))
        elif key in there:
            found.append(there[key])
        else:
            raise PlantError(f"entry: {key} is missing; give {ALTERNATIVES}")
    return tuple(found)
