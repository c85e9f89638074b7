"""Which tables of a book are of one family: they differ in nothing but target and lines, so there is something between.

A controller holds the number of its family with each table, so it need not compare tables to know.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tuning_tables.active_table import interpolable
from tuning_tables.table import ControllerTable


def families_of(tables: Sequence[ControllerTable]) -> tuple[int, ...]:
    """Of each table its family: the number of the first table, from 0, that is for the same cut and `interpolable`."""
    found: list[int] = []
    for number, table in enumerate(tables):
        first = (each for each in dict.fromkeys(found) if is_family(tables[each], table))
        found.append(next(first, number))
    return tuple(found)


def is_family(one: ControllerTable, other: ControllerTable) -> bool:
    """Whether the two are for the same cut, as a controller knows it, and what lies between has a meaning."""
    return for_cut(one) == for_cut(other) and interpolable(one, other)


def for_cut(table: ControllerTable) -> tuple[str, int, np.float32]:
    """What a controller knows of the cut of a table: category, axles, mass in t."""
    return table.cut.category, len(table.cut.axle_offsets_m), np.float32(table.cut.mass_t)
