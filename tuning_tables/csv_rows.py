"""Rows of a CSV export (RFC 4180): one rectangle under `record,key,value0,...`."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence

from tuning_tables.errors import InvalidTable
from tuning_tables.excerpt import excerpt
from tuning_tables.sheet import FORMULA_MARKS


def rectangle(rows: Sequence[Sequence[str]]) -> bytes:
    """The text of `rows`, each of a record, a key and values, under one header; UTF-8, CR LF line ends."""
    width = max(len(row) for row in rows)
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(["record", "key", *(f"value{index}" for index in range(width - 2))])
    writer.writerows([*row, *[""] * (width - len(row))] for row in rows)
    return text.getvalue().encode("utf-8")


def property_rows(value: object, key: str, left_out: tuple[str, ...]) -> Iterator[list[str]]:
    """A row for each leaf of the document `value` found at `key`: a string, a number, or an array of numbers.

    Members called as one of `left_out`, and whatever is null, have no row. Raises `InvalidTable` for a text that a
    spreadsheet would take for a formula and compute.
    """
    if isinstance(value, dict):
        for name, member in value.items():
            if name not in left_out:
                yield from property_rows(member, f"{key}.{name}" if key else name, left_out)
    elif isinstance(value, list) and isinstance(value[0], dict | list):
        for index, item in enumerate(value):
            yield from property_rows(item, f"{key}.{index}", left_out)
    elif isinstance(value, list):
        yield ["number", key, *map(repr, value)]
    elif isinstance(value, str):
        if value.startswith(FORMULA_MARKS):
            raise InvalidTable(
                f"{key} is {excerpt(value)!r}, which a spreadsheet would compute; give it a name that does not begin "
                f"with {value[0]!r}, or export another form."
            )
        yield ["text", key, value]
    elif value is not None:
        yield ["number", key, repr(value)]
