"""The two kinds of books, told apart by their schema version: of tables with lines, and for point sensors."""

from __future__ import annotations

from collections.abc import Sequence, Set
from typing import Final

from tuning_tables.any_table import AnyTable
from tuning_tables.book_columns import VERSIONS as LINE_VERSIONS
from tuning_tables.book_columns import layout_of, layout_stored
from tuning_tables.book_layout import Columns, Layout
from tuning_tables.book_rows import tables_of
from tuning_tables.errors import InvalidTable
from tuning_tables.passages.book_columns import PASSAGES_SCHEMA, passage_layout_of, passage_layout_stored
from tuning_tables.passages.book_rows import passage_tables_of
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.table import ControllerTable

VERSIONS: Final = tuple(sorted((*LINE_VERSIONS, PASSAGES_SCHEMA)))


def book_layout(tables: Sequence[AnyTable]) -> Layout:
    """The oldest layout that can hold `tables`; `InvalidTable` where they are of both kinds."""
    lines = [table for table in tables if isinstance(table, ControllerTable)]
    passages = [table for table in tables if isinstance(table, PassageTable)]
    if lines and passages:
        raise InvalidTable(
            f"{lines[0].id} has lines over the path and {passages[0].id} decides at sensor passages, but the tables of "
            "a book are of one kind: write two books."
        )
    return passage_layout_of(passages) if passages else layout_of(lines)


def stored_layout(version: int, names: Set[str]) -> Layout:
    """The layout of a book of this schema version, one of `VERSIONS`, that has datasets of these names."""
    return passage_layout_stored(names) if version == PASSAGES_SCHEMA else layout_stored(version, names)


def stored_tables(arrays: Columns) -> tuple[AnyTable, ...]:
    """The tables in the arrays of a book of either kind; raises as `tables_of`."""
    return passage_tables_of(arrays) if "switching_m_s" in arrays else tables_of(arrays)
