"""What a book of tables consists of: its kind, its columns, and the meaning of their axes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final

import numpy.typing as npt

from tuning_tables.book_categories import category_numbers
from tuning_tables.declared.columns import (
    Column,
    Columns,
    columns_of,
    row_value,
    stacked,
    stored_sections,
    told_sections,
)
from tuning_tables.errors import InvalidTable
from tuning_tables.table_kinds import KINDS, StageTable, kind_of

AXES: Final[Mapping[str, str]] = MappingProxyType({
    "table": "index of the table in the book",
    "stage": "pressure stage k, in a row of switching speeds the one in force",
    "power": "power of the path in m",
    "threshold": "j of the switching speed that parts stage j from stage j + 1",
    "passage": "index of the passage in the order of the path",
    "sensor": "index of the point sensor along the path",
    "zone": "index of the retarder along the path",
    "axle": "index of the axle from the front",
    "break": "index of the path break of the estimator's work",
    "end": "0: beginning or smallest, 1: end or largest",
})  # fmt: skip
"""What the axes count."""


@dataclass(frozen=True)
class Layout:
    """What a book consists of: the kind of its tables, and its columns."""

    kind: str
    columns: tuple[Column, ...]

    @property
    def axes(self) -> Mapping[str, str]:
        """The axes of the columns, and what they count."""
        used = {axis for column in self.columns for axis in column.axes}
        return {axis: meaning for axis, meaning in AXES.items() if axis in used}

    def length(self, axis: str, arrays: Columns) -> int:
        """The length of `axis` in the arrays of a book of this layout."""
        column = next(column for column in self.columns if axis in column.axes)
        return int(arrays[column.name].shape[column.axes.index(axis)])

    def arrays_of(self, tables: Sequence[StageTable]) -> dict[str, npt.NDArray[Any]]:
        """The arrays of a book of `tables`, by name.

        Raises `InvalidTable` for an id given twice, and where numbers and names of categories do not belong together
        one by one.
        """
        (name, times), *_ = Counter(table.id for table in tables).most_common(1)
        if times > 1:
            raise InvalidTable(f"{times} tables of the book have the id {name!r}, but ids must differ within a book.")
        category_numbers(tables)
        return stacked(self.columns, tables)


def book_layout(tables: Sequence[StageTable]) -> Layout:
    """The layout of a book of `tables`; `InvalidTable` for none at all, and where they are of two kinds."""
    if not tables:
        raise InvalidTable("the book has no tables, but it must have at least one.")
    first = tables[0]
    for table in tables:
        if type(table) is not type(first):
            raise InvalidTable(
                f"{first.id} is of the kind {kind_of(type(first))} and {table.id} of the kind {kind_of(type(table))}, "
                "but the tables of a book are of one kind: write two books."
            )
    return Layout(kind_of(type(first)), tuple(columns_of(type(first), told_sections(type(first), tables))))


def stored_layout(kind: str, names: Set[str]) -> Layout:
    """The layout of a book of tables of this kind that has datasets of these names."""
    return Layout(kind, tuple(columns_of(KINDS[kind], stored_sections(KINDS[kind], names))))


def stored_tables(layout: Layout, arrays: Columns) -> tuple[StageTable, ...]:
    """The tables in the arrays of a book, which must have the names, types and numbers of axes of its layout.

    Raises `InvalidTable` for values that make no table, `UnicodeDecodeError` for text that is no UTF-8.
    """
    declared = KINDS[layout.kind]
    rows = range(len(arrays["id"]))
    return tuple(row_value(declared, {name: column[row] for name, column in arrays.items()}) for row in rows)
