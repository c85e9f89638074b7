"""A CSV export against the table that it is of."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from synth.checker.book_layout import SWITCHING, with_infinities
from synth.checker.content import canonical_form, crc32
from synth.checker.finding import DamagedError, shown

Rows = dict[tuple[str, str], tuple[str, ...]]
Same = Callable[[str, tuple[str, ...], list[Any]], bool]
"""Whether the cells of a row, of a kind of record, hold values."""


def read_rows(content: bytes) -> Rows:
    """The values of each (record, key); `DamagedError` unless the file is a rectangle as documented."""
    try:
        rows = list(csv.reader(io.StringIO(content.decode("utf-8"), newline=""), strict=True))
    except UnicodeDecodeError as fault:
        raise DamagedError(f"byte {fault.start} is not UTF-8 text") from None
    except csv.Error as fault:
        raise DamagedError(f"it is no CSV: {fault}") from None
    width = len(rows[0]) if rows else 0
    if width < 3 or rows[0] != ["record", "key", *(f"value{i}" for i in range(width - 2))]:
        raise DamagedError("its first line is not record,key,value0,…")
    found: Rows = {}
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != width:
            raise DamagedError(f"row {number} has {len(row)} fields, but the first has {width}")
        values = list(row[2:])
        while values and values[-1] == "":
            values.pop()
        if (row[0], row[1]) in found:
            raise DamagedError(f"the row {row[0]},{shown(row[1])} stands twice")
        found[row[0], row[1]] = tuple(values)
    return found


def sheet_differences(rows: Rows, document: Mapping[str, Any]) -> Iterator[str]:
    """Each row that is not what the document of a table, less its checksum, says."""
    told = with_exporter(document, rows)
    wanted = dict(rows_of(told, ""))
    wanted["text", "crc32"] = [checksum_of(told)]
    yield from row_differences(rows, wanted, same)


def row_differences(rows: Rows, wanted: Mapping[tuple[str, str], list[Any]], is_same: Same) -> Iterator[str]:
    """Each row that is not what is `wanted`."""
    for key in sorted(wanted.keys() | rows.keys()):
        name = ",".join(key)
        if key not in rows:
            yield f"the row {name} is missing"
        elif key not in wanted:
            yield f"the row {name} is in no table"
        elif not is_same(key[0], rows[key], wanted[key]):
            yield f"the row {name} holds {shown(rows[key])}, but the table says {shown(wanted[key])}"


def with_exporter(document: Mapping[str, Any], rows: Rows) -> dict[str, Any]:
    """The document as the program that wrote the rows would write it: that may be another than wrote the table."""
    return {**document, "exported_by": (rows.get(("text", "exported_by")) or ("",))[0]}


def checksum_of(document: dict[str, Any]) -> str:
    """What stands at crc32 of a document less it."""
    return f"{crc32(canonical_form(document).encode('utf-8')):08x}"


def rows_of(value: Any, key: str) -> Iterator[tuple[tuple[str, str], list[Any]]]:
    """The rows that a part of a document should have."""
    if isinstance(value, str):
        yield ("text", key), [value]
    elif isinstance(value, dict):
        for name, member in value.items():
            known = with_infinities(member) if name == SWITCHING else member
            yield from rows_of(known, f"{key}.{name}".lstrip("."))
    elif isinstance(value, list) and isinstance(value[0], dict | list):
        for index, item in enumerate(value):
            yield from rows_of(item, f"{key}.{index}")
    elif value is not None:
        yield ("number", key), value if isinstance(value, list) else [value]


def same(record: str, cells: tuple[str, ...], values: list[Any]) -> bool:
    """Whether the cells hold these values, numbers to the last bit."""
    if record == "text":
        return list(cells) == values
    try:
        return [float(cell) for cell in cells] == [float(value) for value in values]
    except ValueError:
        return False
