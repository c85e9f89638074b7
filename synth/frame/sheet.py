"""Tables as sheets: CSV with a column for each figure, and for an interval its ends and its n beside it; and
workbooks of spreadsheet programs (Office Open XML).
"""

from __future__ import annotations

import csv
import io
import math
import re
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from synth.frame.exhibits import Column, Row, Table
from synth.frame.faults import InputError
from synth.frame.interval import Interval
from tuning_tables.csv_file import sheet


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


LONGEST_NAME: Final = 31
"""Of a sheet: no program takes a longer one."""

MOST_ROWS: Final = 1_048_576
MOST_BYTES: Final = 50_000_000
"""Of a workbook that is read, unpacked."""

MADE: Final = (1980, 1, 1, 0, 0, 0)
"""The date of all parts of a workbook, so that the same tables give the same bytes."""

WHEN: Final = re.compile(rb"<dcterms:(created|modified)[^>]*>[^<]*</dcterms:\1>")
"""What the library notes of the time."""


def to_workbook(tables: Mapping[str, Sequence[Sequence[Any]]]) -> bytes:
    """A sheet for each of `tables` by name: rows of numbers, words, truth values, and None for an empty cell.

    Numbers keep 16 digits, of which spreadsheet programs show 15. Rows beyond what a sheet can hold are left out.
    """
    from openpyxl import Workbook

    book = Workbook(write_only=True)
    for name, rows in tables.items():
        sheet = book.create_sheet(name[:LONGEST_NAME])
        for row in rows[:MOST_ROWS]:
            sheet.append([cell_of(sheet, value) for value in row])
    made = io.BytesIO()
    book.save(made)
    return undated(made.getvalue())


def cell_of(sheet: Any, value: Any) -> Any:
    """A value as a cell of `sheet` holds it: nothing for what is no finite number; words are never a formula."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, str):
        from openpyxl.cell import WriteOnlyCell

        words = WriteOnlyCell(sheet, value)
        words.data_type = "s"
        return words
    return value


def undated(content: bytes) -> bytes:
    """The same workbook without the time at which it was made."""
    found = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as parts, zipfile.ZipFile(found, "w", zipfile.ZIP_DEFLATED) as undated:
        for name in sorted(parts.namelist()):
            part = zipfile.ZipInfo(name, MADE)
            part.compress_type = zipfile.ZIP_DEFLATED
            undated.writestr(part, WHEN.sub(b"", parts.read(name)))
    return found.getvalue()


def first_sheet_csv(content: bytes, place: str) -> str:
    """The first sheet as CSV; `place`: what messages call the file. `InputError` for what is no workbook."""
    from openpyxl import load_workbook

    try:
        with zipfile.ZipFile(io.BytesIO(content)) as parts:
            large = sum(part.file_size for part in parts.infolist()) > MOST_BYTES
        if large:
            raise InputError(f"{place}: it holds more than {MOST_BYTES} bytes when it is unpacked; no such table has")
        sheet = load_workbook(io.BytesIO(content), read_only=True, data_only=True).worksheets[0]
        sheet.reset_dimensions()  # what the file says of its size may be wrong
        rows = [[words_of(cell) for cell in row] for row in sheet.iter_rows(values_only=True)]
    except InputError:
        raise
    except Exception as fault:  # the library raises whatever it meets in a damaged file
        raise InputError(
            f"{place}: this is no workbook of a spreadsheet program ({type(fault).__name__}); save it anew as .xlsx"
        ) from None
    written, columns = io.StringIO(), len(rows[0]) if rows else 0
    full = (row + [""] * (columns - len(row)) for row in rows)  # a row ends with its last cell that is not empty
    csv.writer(written, lineterminator="\n").writerows(full)
    return written.getvalue()


def words_of(cell: Any) -> str:
    """A cell in words; whole numbers without a point."""
    if cell is None:
        return ""
    if isinstance(cell, bool):
        return "true" if cell else "false"
    if isinstance(cell, float) and cell.is_integer() and abs(cell) < 2**53:
        return str(int(cell))
    return str(cell)
