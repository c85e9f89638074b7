"""The parts of a page, and workbooks: what is written is read again."""

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
from synth.frame.faults import InputError
from synth.frame.interval import Interval
from synth.frame.page.markup import Markup, element, inline_svg, shorter
from synth.frame.page.page_table import MOST_COLUMNS, MOST_ROWS, on_screen, table_or_words
from synth.frame.printed_numbers import counted, percent, span
from synth.frame.sheet import MOST_BYTES, first_sheet_csv, sheet_rows, to_workbook

SVG = (
    b'<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    b'width="10pt" height="10pt"><defs><style>*{fill:none}</style><clipPath id="p1"><path d="M 0.123456 1"/></clipPath>'
    b'</defs><g id="figure_1"><g clip-path="url(#p1)"><text>0.123456 &lt;id&gt;</text></g>'
    b'<use xlink:href="#p1"/></g></svg>'
)


def test_markup() -> None:
    assert element("p", "a<b", Markup("<br>"), class_='x"y') == '<p class="x&quot;y">a&lt;b<br></p>'
    assert element("img", alt="", src="s") == '<img src="s">'


def test_figures() -> None:
    assert [percent(share) for share in (0.0, 0.00012, 0.05, 0.25)] == ["0", "0.012", "5", "25.0"]
    assert [span(values) for values in ([1.0, 2.0], [1.0, 1.001])] == ["from 1.00 to 2.00", "1.00"]
    assert [counted(n, "case") for n in (1, 3)] == ["1 case", "3 cases"]


def test_a_drawing_is_a_part_of_the_page_and_meets_no_other() -> None:
    drawing = inline_svg(SVG, "a <name>", "one-")
    assert drawing.width_pt == 10.0
    assert drawing.markup == (
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="10pt" '
        'height="10pt" role="img" aria-label="a &lt;name&gt;"><defs><clipPath id="one-p1"><path d="M 0.12 1" />'
        '</clipPath></defs><g><g clip-path="url(#one-p1)"><text>0.123456 &lt;id&gt;</text></g>'
        '<use xlink:href="#one-p1" /></g></svg>'
    )


def test_places_are_told_to_a_hundredth_and_factors_whole() -> None:
    assert shorter("M 0.123456 1 \nL 12.3 -4.567891\nz") == "M 0.12 1 L 12.3 -4.56 z"
    assert shorter("translate(0 138.246) scale(0.004321 -0.004321)") == "translate(0 138.246) scale(0.004321 -0.004321)"


def test_a_table_shows_nine_columns_and_folds_the_rest() -> None:
    """None is lost; those that a reader can spare most go first, details always; the row's name stands in each part."""
    columns = (
        Column("case", "case", words=True, once=True),
        Column("target", "target"),
        *(Column(f"c{i}", f"figure {i}", spare=i % 3) for i in range(12)),
        Column("detail", "a detail", detail=True),
    )
    first, more = on_screen(columns)
    assert len(first) == MOST_COLUMNS
    assert {column.key for column in more} == {"detail", "c2", "c5", "c8", "c11", "c10"}
    assert [column for column in columns if column in (*first, *more)] == list(columns)
    row = {column.key: i for i, column in enumerate(columns)} | {"case": "A"}
    html = table_or_words(Table("t", "T", columns, [row]))
    assert html.count("<table") == 2
    assert html.count(">A</th>") == 2
    assert all(html.count(f">figure {i}<") == 1 for i in range(12))
    assert "6 more figures of each row" in html
    assert on_screen(columns[:2] + columns[-1:]) == (columns[:2] + columns[-1:], ())
    many = table_or_words(Table("t", "T", columns[:2], [row] * (MOST_ROWS + 1)))
    assert many.startswith("<details><summary>T: 25 rows</summary>")


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
