"""Workbooks: what is written is read again, the same tables give the same bytes, and no file breaks the reader."""

from __future__ import annotations

import contextlib
import io
import random
import time
import zipfile
from typing import Any

import openpyxl
import pytest

from synth.frame.exhibits import Column, Table
from synth.frame.input_error import InputError
from synth.frame.interval import Interval
from synth.frame.sheet import sheet_rows
from synth.frame.workbook import MOST_BYTES, first_sheet_csv, to_workbook

COLUMNS = (Column("name", "name", words=True), Column("share", "share", "%"), Column("kept", "kept"))
TABLE = Table(
    "shares",
    "Shares",
    COLUMNS,
    [
        {"name": "=1+1", "share": Interval(0.5, 0.25, 0.75, 40), "kept": True},
        {"name": 'a, "b"\nc', "share": None, "kept": False},
        {"name": ["x", 2], "share": float("nan"), "kept": None},
    ],
)


def cells(content: bytes, name: str) -> list[tuple[Any, ...]]:
    """What another program finds in a sheet."""
    return list(openpyxl.load_workbook(io.BytesIO(content))[name].iter_rows(values_only=True))


def test_a_table_is_a_sheet_of_numbers_and_words() -> None:
    content = to_workbook({TABLE.name: sheet_rows(TABLE), "n" * 40: [(1.5, 2)]})
    head, first, second, third = cells(content, "shares")
    assert head == ("name", "share", "share_low95", "share_high95", "share_n", "kept")
    assert first == ("=1+1", 0.5, 0.25, 0.75, 40, True)
    assert second == ('a, "b"\nc', None, None, None, None, False)
    assert third == ("x 2", None, None, None, None, None)
    assert cells(content, "n" * 31) == [(1.5, 2)]
    assert b"<f>" not in zipfile.ZipFile(io.BytesIO(content)).read("xl/worksheets/sheet1.xml")


def test_the_same_tables_give_the_same_bytes() -> None:
    first = to_workbook({"a": [("x", 1.0)]})
    time.sleep(2.1)  # a ZIP file counts in steps of two seconds
    assert to_workbook({"a": [("x", 1.0)]}) == first


def test_the_first_sheet_is_read_as_csv() -> None:
    rows = [("cut", "mass_t", None, "marks"), (1, 22.0, 0.25, "a, b"), (2, 80.5, True, None)]
    said = first_sheet_csv(to_workbook({"a": rows, "b": [(9,)]}), "list.xlsx")
    assert said == 'cut,mass_t,,marks\n1,22,0.25,"a, b"\n2,80.5,true,\n'


def test_a_damaged_file_is_refused() -> None:
    content = to_workbook({"a": [("x", 1.0), ("y", 2.0)]})
    drawn = random.Random(1)
    for _ in range(300):
        broken = bytearray(content[: drawn.choice((len(content), drawn.randrange(len(content))))])
        for _ in range(drawn.randrange(4)):
            if broken:
                broken[drawn.randrange(len(broken))] = drawn.randrange(256)
        with contextlib.suppress(InputError):  # the one error that a caller tells
            first_sheet_csv(bytes(broken), "x.xlsx")
    with pytest.raises(InputError, match=r"x.xlsx: this is no workbook of a spreadsheet program \(BadZipFile\)"):
        first_sheet_csv(content[:100], "x.xlsx")


def test_a_file_that_unpacks_to_too_much_is_refused() -> None:
    large = io.BytesIO()
    with zipfile.ZipFile(large, "w", zipfile.ZIP_DEFLATED) as parts:
        parts.writestr("xl/workbook.xml", bytes(MOST_BYTES + 1))
    with pytest.raises(InputError, match=r"x.xlsx: it holds more than"):
        first_sheet_csv(large.getvalue(), "x.xlsx")
