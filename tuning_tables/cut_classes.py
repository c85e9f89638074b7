"""Tables of one retarder position and the classes of cuts that they are for: what books of every kind check."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Final, Protocol

import numpy as np

from tuning_tables.category_number import LARGEST_OWN, LEAST_OWN
from tuning_tables.errors import InvalidTable
from tuning_tables.provenance import CutId, RetarderId

LEAST_FLOAT32: Final = float(np.finfo(np.float32).smallest_normal)
LARGEST_FLOAT32: Final = float(np.finfo(np.float32).max)


class TableForCuts(Protocol):
    """A table for a class of cuts that shall leave a retarder position with one speed."""

    @property
    def id(self) -> str:
        """Its name."""

    @property
    def retarder(self) -> RetarderId:
        """The position."""

    @property
    def cut(self) -> CutId:
        """The class of cuts."""

    @property
    def target_speed_m_s(self) -> float:
        """The exit speed it aims at."""


def require_one_position(tables: Sequence[TableForCuts]) -> None:
    """`InvalidTable` unless all are for one position, ids differ, and float32 holds masses and targets."""
    first, times = tables[0], Counter(table.id for table in tables)
    for table in tables:
        if position_of(table) != position_of(first):
            raise InvalidTable(
                f"{table.id} is for the retarder {table.retarder.name}, {first.id} for {first.retarder.name}, "
                "or their zones or dead bands differ, but a book serves one position: export them apart."
            )
        if times[table.id] > 1:
            raise InvalidTable(f"the id {table.id} is given to {times[table.id]} tables of the book.")
        for key, value in (("cut.mass_t", table.cut.mass_t), ("target_speed_m_s", table.target_speed_m_s)):
            if not LEAST_FLOAT32 <= value <= LARGEST_FLOAT32:
                raise InvalidTable(f"{key} of {table.id} is {value!r}, which float32 cannot hold.")


def position_of(table: TableForCuts) -> tuple[object, ...]:
    """What makes the retarder position of a table; where the pass ends depends on the length of the cut as well."""
    return table.retarder.name, table.retarder.zones_m, table.retarder.dead_band_kpa


def exported_number(table: TableForCuts) -> int:
    """What stands for the table's weight category in C and Structured Text; `InvalidTable` for one without number."""
    if table.cut.number is None:
        raise InvalidTable(
            f"{table.id} is for the category {table.cut.category}, which has no number, but controller code chooses by "
            f"number: give the table a cut.category_number in [{LEAST_OWN}, {LARGEST_OWN}] (CutId of tuning_tables), "
            "then export it."
        )
    return table.cut.number


def candidates_by_class(tables: Sequence[TableForCuts]) -> Mapping[tuple[str, int], tuple[int, ...]]:
    """Numbers of the tables for every class (category, axles), by rising target; classes in order of first appearance.

    Where several masses answer to a class, those of the largest mass: they begin to brake first. Of tables for one
    target the first. Masses and targets are compared as float32.
    """
    members: dict[tuple[str, int], list[int]] = {}
    for number, table in enumerate(tables):
        members.setdefault((table.cut.category, len(table.cut.axle_offsets_m)), []).append(number)
    return MappingProxyType({each: _heaviest_by_target(tables, numbers) for each, numbers in members.items()})


def _heaviest_by_target(tables: Sequence[TableForCuts], numbers: Sequence[int]) -> tuple[int, ...]:
    heaviest = max(np.float32(tables[number].cut.mass_t) for number in numbers)
    by_target: dict[float, int] = {}
    for number in numbers:
        if np.float32(tables[number].cut.mass_t) == heaviest:
            by_target.setdefault(float(np.float32(tables[number].target_speed_m_s)), number)
    return tuple(by_target[target] for target in sorted(by_target))
