"""Every export is plain text in the small subset of Structured Text that it promises; names fit into controller
code.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from itertools import chain
from typing import Final

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.controller_code.passage_tables import passage_table
from tests.st_files import aim_st_files, correction_st_files, passage_st_files, st_files
from tests.tuning_tables.aim.made_tables import category_table, measured_table
from tests.tuning_tables.st.conftest import oddly_named_book, shaped_book
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.exported_forms import FORMS
from tests.tuning_tables.st.syntax import faults, parse, walk
from tuning_tables import InvalidTable
from tuning_tables.aim import AimTables
from tuning_tables.category_number import KNOWN_NUMBERS, category_macros, comment_text
from tuning_tables.correction import Correction
from tuning_tables.export_names import ExportPrefix
from tuning_tables.exports import line_export
from tuning_tables.passages.exports import passage_export
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.self_test_size import SMALL
from tuning_tables.table_book import TableBook

SHAPES: Final = {
    f"{stages} stages of degree {degree}": lambda stages=stages, degree=degree: joined(
        st_files(shaped_book(stages, degree)).values()
    )
    for stages, degree in ((2, 9), (32, 0), (32, 9))
}
TEXTS: Final[dict[str, Callable[[], bytes]]] = {
    **{form.name: form.text for form in FORMS},
    **SHAPES,
    "odd names": lambda: joined(st_files(oddly_named_book()).values()),
}
EACH = pytest.mark.parametrize("name", TEXTS)


def joined(texts: object) -> bytes:
    """The files one after the other."""
    return b"\n".join(texts)  # type: ignore[arg-type]  # values of a mapping


@cache
def text_of(name: str) -> bytes:
    return TEXTS[name]()


def names_in(text: bytes) -> set[str]:
    return {node.text.decode("ascii") for node in walk(parse(text)) if node.type == "identifier"}


@EACH
def test_it_is_structured_text_whose_names_and_types_are_declared(name: str) -> None:
    """The evaluator resolves all names and types, which the grammar does not."""
    assert faults(parse(text_of(name))) == []
    assert any(block.endswith("_SELF_TEST") for block in Program(text_of(name)).blocks)


@EACH
def test_the_text_is_plain(name: str) -> None:
    text = text_of(name)
    lines = text.decode("ascii").split("\n")
    assert lines[-1] == ""
    assert all(line == line.rstrip() and line.isprintable() and not {*"$`"} & {*line} for line in lines)
    # A name may be long, above all in code points.
    assert all(len(line) <= 120 for line in lines if "<U+" not in line)
    # No comment is inside another, and none ends early: else the text would not parse.
    comments = re.findall(rb"\(\*.*?\*\)", text, re.DOTALL)
    assert all(comment.count(b"(*") == comment.count(b"*)") == 1 for comment in comments)
    assert max(int(end) for end in re.findall(rb"ARRAY\[0\.\.(\d+)\]", text)) < 999


def test_all_kinds_fit_into_one_project_and_keep_short_names_under_a_long_prefix() -> None:
    points, aims = PassageBook((passage_table(stages=2),)), AimTables((category_table(), measured_table()))
    for prefix in (ExportPrefix(), ExportPrefix("TENLETTERS")):
        kinds = (
            st_files(shaped_book(3, 1), prefix), passage_st_files(points, prefix), aim_st_files(aims, prefix),
            correction_st_files(Correction(0.15, 0.06), prefix),
        )  # fmt: skip
        text = joined(chain.from_iterable(files.values() for files in kinds))
        assert faults(parse(text)) == []
        assert len(Program(text).blocks) > 40
        names = names_in(text)
        assert all(len(each) <= 32 for each in names), sorted(names, key=len)[-1]
    assert b"retarder_" not in text.lower()


def test_equal_books_give_equal_bytes(book: TableBook, small_book: TableBook) -> None:
    assert st_files(book) == st_files(TableBook(tuple(replace(table) for table in book.tables)))
    assert st_files(book) != st_files(small_book)


def test_as_many_tables_as_are_allowed_are_exported_and_no_more(
    small_book: TableBook, monkeypatch: pytest.MonkeyPatch
) -> None:
    passages = PassageBook((passage_table(stages=2),))
    of_lines, of_passages = (partial(line_export, small_book), partial(passage_export, passages))
    lines, of_sensors = "tuning_tables.exports.MOST_TABLES", "tuning_tables.passages.exports.MOST_TABLES"
    for most, tables, export in ((lines, 2, of_lines), (of_sensors, 1, of_passages)):
        monkeypatch.setattr(most, tables)
        assert export(self_test=SMALL)
        monkeypatch.setattr(most, tables - 1)
        with pytest.raises(InvalidTable, match=f"{tables} tables, .*at most {tables - 1}"):
            export(self_test=SMALL)


def test_the_categories_of_the_field() -> None:
    assert category_macros(KNOWN_NUMBERS) == ("L", "LS", "S", "ST", "T")


@pytest.mark.parametrize(
    ("categories", "names"),
    [
        ({"light": 16, "Heavy 2": 17}, ("LIGHT", "HEAVY_2")),
        ({"Т": 5, "T": 16}, ("T", "T_16")),
        ({"T": 16, "Т": 5}, ("T_16", "T")),
        ({"??": 16, "x": 17, "!": 18}, ("16", "X", "18")),
        ({"a": 16, "A": 17, "a_16": 18}, ("A_16", "A_17", "A_16_18")),
        ({"": 16, "16": 17}, ("16", "16_17")),
        ({"__a -- b__": 16}, ("A_B",)),
        ({"Щит": 16}, ("SHHIT",)),
        ({"x" * 40: 16}, ("X" * 8,)),
    ],
)
def test_names_differ_and_are_plain(categories: dict[str, int], names: tuple[str, ...]) -> None:
    assert category_macros(categories) == names


@given(st.lists(st.text(st.sampled_from("aAАтТ126_ -?"), max_size=5), unique=True, max_size=12))
def test_names_always_differ(categories: list[str]) -> None:
    names = category_macros({**KNOWN_NUMBERS, **{name: 16 + place for place, name in enumerate(categories)}})
    assert len(set(names)) == len({*KNOWN_NUMBERS, *categories})
    assert names[:5] == ("L", "LS", "S", "ST", "T")
    assert all(re.fullmatch(r"[A-Z0-9]+(_[A-Z0-9]+)*", name) for name in names)


def test_comments_show_what_they_cannot_hold() -> None:
    assert comment_text("gondola-4 22 t, (a+b).c_d") == "gondola-4 22 t, (a+b).c_d"
    assert comment_text("Л*/\n😀") == "<U+041B><U+002A><U+002F><U+000A><U+1F600>"
    assert comment_text("RETARDER_LOAD retarder_ _") == "RETARDER<U+005F>LOAD retarder<U+005F> _"


@given(st.text())
def test_no_comment_ends_early(text: str) -> None:
    shown = comment_text(text)
    assert shown.isascii()
    assert not set("*/\\?\n\r{}'\"$") & set(shown)
