"""A table as CSV: a column for each figure, and for an interval its ends and its n beside it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from synth.frame.exhibits import Column, Row, Table
from synth.frame.interval import Interval
from tuning_tables.sheet import sheet


def to_csv(table: Table) -> bytes:
    """The whole table; numbers with all their digits, nothing for a figure that is not there."""
    open_ones = {column.key for column in table.columns if any(is_open(row, column) for row in table.rows)}
    head = tuple(name for column in table.columns for name in names_of(column, column.key in open_ones))
    rows = (
        tuple(cell for column in table.columns for cell in cells_of(row.get(column.key), column.key in open_ones))
        for row in table.rows
    )
    return sheet(head, rows)


def is_open(row: Row, column: Column) -> bool:
    """The row has an interval there."""
    return isinstance(row.get(column.key), Interval)


def names_of(column: Column, is_interval: bool) -> Iterator[str]:
    """What stands above the figure."""
    yield column.key
    if is_interval:
        yield from (f"{column.key}_{part}" for part in ("low95", "high95", "n"))


def cells_of(value: Any, is_interval: bool) -> Iterator[str]:
    """The figure, and where its column has intervals the ends and the n of its own."""
    if isinstance(value, Interval):
        yield from (cell(each) for each in (value.value, value.low95, value.high95, value.n))
        return
    yield cell(value)
    if is_interval:
        yield from ("", "", "")


def cell(value: Any) -> str:
    """One value."""
    match value:
        case None:
            return ""
        case bool():
            return "true" if value else "false"
        case str():
            return value
        case list() | tuple():
            return " ".join(cell(each) for each in value)
    number = value.item() if hasattr(value, "item") else value
    return "" if isinstance(number, float) and math.isnan(number) else repr(number)
