"""A table as a sheet: a column for each figure, and for an interval its ends and its n beside it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from synth.frame.exhibits import Column, Row, Table
from synth.frame.interval import Interval
from tuning_tables.sheet import sheet


def to_csv(table: Table) -> bytes:
    """The whole table as CSV; numbers with all their digits, nothing for a figure that is not there."""
    head, *rows = sheet_rows(table)
    return sheet(head, (tuple(cell(value) for value in row) for row in rows))


def sheet_rows(table: Table) -> list[tuple[Any, ...]]:
    """The head, then a row for each row of the table: plain values, None for a figure that is not there."""
    open_ones = {column.key for column in table.columns if any(is_open(row, column) for row in table.rows)}
    head = tuple(name for column in table.columns for name in names_of(column, column.key in open_ones))
    return [
        head,
        *(
            tuple(each for column in table.columns for each in cells_of(row.get(column.key), column.key in open_ones))
            for row in table.rows
        ),
    ]


def is_open(row: Row, column: Column) -> bool:
    """The row has an interval there."""
    return isinstance(row.get(column.key), Interval)


def names_of(column: Column, is_interval: bool) -> Iterator[str]:
    """What stands above the figure."""
    yield column.key
    if is_interval:
        yield from (f"{column.key}_{part}" for part in ("low95", "high95", "n"))


def cells_of(value: Any, is_interval: bool) -> Iterator[Any]:
    """The figure, and where its column has intervals the ends and the n of its own."""
    if isinstance(value, Interval):
        yield from (plain(each) for each in (value.value, value.low95, value.high95, value.n))
        return
    yield plain(value)
    if is_interval:
        yield from (None, None, None)


def plain(value: Any) -> Any:
    """One value: a number, a word, a truth value, or None; a list in words, with blanks between."""
    if isinstance(value, list | tuple):
        return " ".join(cell(plain(each)) for each in value)
    return value.item() if hasattr(value, "item") else value


def cell(value: Any) -> str:
    """A plain value in words."""
    match value:
        case None:
            return ""
        case bool():
            return "true" if value else "false"
        case str():
            return value
    return "" if isinstance(value, float) and math.isnan(value) else repr(value)
