"""Every export is plain text in Structured Text, in the small subset that it promises, whatever its kind and shape."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from itertools import chain
from typing import Final

import pytest

from tests.controller_code.passage_tables import passage_table
from tests.st_files import aim_st_files, correction_st_files, passage_st_files, st_files
from tests.tuning_tables.aim.made_tables import category_table, measured_table
from tests.tuning_tables.st.conftest import oddly_named_book, shaped_book
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.exported_forms import FORMS
from tests.tuning_tables.st.syntax import faults, parse, walk
from tuning_tables import InvalidTable
from tuning_tables.aim import AimTables
from tuning_tables.correction import Correction
from tuning_tables.export_prefix import ExportPrefix
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.st_source import passage_export
from tuning_tables.self_test_size import SMALL
from tuning_tables.st_source import line_export
from tuning_tables.table_book import TableBook

# Keywords, operators of instruction lists, standard functions and blocks, and words that single systems reserve.
KEYWORDS = """
    ABS ACOS ACTION ADD AND ANDN ANY ARRAY ASIN AT ATAN BEGIN BOOL BY BYTE CAL CALC CALCN CASE CD CDT CLK CONCAT
    CONFIGURATION CONSTANT CONTINUE COS CTD CTU CTUD CU D DATE DELETE DINT DIV DO DS DT DWORD ELSE ELSIF EN END_IF ENO
    EQ ET EXIT EXP EXPT FALSE FIND FOR FROM FUNCTION FUNCTION_BLOCK F_TRIG GE GOTO GT IF IN INSERT INT INTERFACE JMP
    JMPC L LABEL LD LDN LE LEFT LEN LIMIT LINT LN LOG LREAL LT LWORD MAX METHOD MID MIN MOD MOVE MUL MUX N NE NOT OF ON
    OR ORGANIZATION_BLOCK ORN P PROGRAM PROPERTY PT PV Q Q1 QD QU R R1 READ REAL REF RELEASE REPEAT REPLACE REGION
    RESOURCE RET RETAIN RETURN RIGHT ROL ROR RS R_TRIG S S1 SD SEL SEMA SHL SHR SIN SINGLE SINT SL SQRT SR ST STEP STN
    STRING STRUCT SUB SUPER TAN TASK THEN THIS TIME TO TOD TOF TON TP TRANSITION TRUE TRUNC TYPE UDINT UINT ULINT UNTIL
    USINT VAR VOID WHILE WITH WORD WRITE XOR XORN
"""

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


@EACH
def test_names_are_no_keywords_anywhere(name: str) -> None:
    names = {each.upper() for each in names_in(text_of(name))}
    assert names & set(KEYWORDS.split()) == set()
    assert all(len(each) <= 32 and "__" not in each and not each.endswith("_") for each in names)


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
    lines, of_sensors = "tuning_tables.st_source.MOST_TABLES", "tuning_tables.passages.st_source.MOST_TABLES"
    for most, tables, export in ((lines, 2, of_lines), (of_sensors, 1, of_passages)):
        monkeypatch.setattr(most, tables)
        assert export(self_test=SMALL)
        monkeypatch.setattr(most, tables - 1)
        with pytest.raises(InvalidTable, match=f"{tables} tables, .*at most {tables - 1}"):
            export(self_test=SMALL)
