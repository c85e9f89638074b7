"""Whatever the book, the export is Structured Text, and of the small subset that it promises."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import pytest

from tests.controller_code.passage_tables import passage_table
from tests.tuning_tables.st.conftest import oddly_named_book, shaped_book, texts_of
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.syntax import faults, parse, walk
from tuning_tables import InvalidTable, st_source
from tuning_tables.passages import st_source as passage_st_source
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.st_source import passage_export
from tuning_tables.self_test_size import SMALL
from tuning_tables.st_source import SELF_TEST_FILE, TABLE_FILE, line_export, st_files
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

BOOKS = {
    "2-stages-degree-0": lambda: shaped_book(2, 0),
    "2-stages-degree-9": lambda: shaped_book(2, 9),
    "3-stages-degree-1": lambda: shaped_book(3, 1),
    "32-stages-degree-0": lambda: shaped_book(32, 0),
    "32-stages-degree-9": lambda: shaped_book(32, 9),
    "odd-names": oddly_named_book,
}


def require_structured_text(book: TableBook) -> None:
    files = texts_of(book)
    assert list(files) == [TABLE_FILE, SELF_TEST_FILE]
    for text in files.values():
        assert faults(parse(text)) == []
    # The evaluator resolves all names and types, which the grammar does not.
    program = Program(b"".join(files.values()))
    assert "RETARDER_SELF_TEST" in program.blocks


@pytest.mark.parametrize("make", BOOKS.values(), ids=BOOKS)
def test_every_book_gives_structured_text(make: Callable[[], TableBook]) -> None:
    require_structured_text(make())


def test_the_usual_books_give_structured_text(
    book: TableBook, default_book: TableBook, estimating_book: TableBook
) -> None:
    for each in (book, default_book, estimating_book):
        require_structured_text(each)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("END_IF;", ";"),
        ("END_WHILE;", ""),
        ("END_CASE;", ""),
        ("END_VAR", ""),
        ("END_STRUCT;", ""),
        ("END_TYPE", ""),
        ("END_FUNCTION_BLOCK", ""),
        ("THEN", ""),
        (" DO", ""),
        (" *)", ""),
        ("(* ", ""),
        ("Answer := 0;", "Answer := 0"),
        ("Answer := 0;", "Answer = 0;"),
        ("];", ";"),
        ("[", ""),
        (" := [", " [ "),
        ("(0 <= Stage)", "(0 <= Stage"),
        ("Line * Path", "Line * * Path"),
    ],
)
def test_a_broken_text_is_found(small_book: TableBook, right: str, wrong: str) -> None:
    text = texts_of(small_book)[TABLE_FILE].decode("ascii")
    before, found, after = text.rpartition(right)
    assert found, right
    assert faults(parse((before + wrong + after).encode("ascii"))) != []


@pytest.mark.parametrize(
    ("right", "wrong"),
    [("Table.Powers - 1;", "Table.Power - 1;"), ("Path : REAL;", "Path : INT;"), ("Stages[Index]", "Stage_9[Index]")],
)
def test_a_wrong_name_or_type_is_found(small_book: TableBook, right: str, wrong: str) -> None:
    text = b"".join(texts_of(small_book).values()).decode("ascii")
    with pytest.raises(Exception, match=r"Power|INT|STAGE_9"):
        Program(text.replace(right, wrong, 1).encode("ascii"))


def test_the_text_is_plain(book: TableBook, default_book: TableBook, estimating_book: TableBook) -> None:
    for files in map(texts_of, (book, default_book, oddly_named_book(), estimating_book)):
        for text in files.values():
            lines = text.decode("ascii").split("\n")
            assert lines[-1] == ""
            assert all(line == line.rstrip() and line.isprintable() for line in lines)
            # A name may be long, above all in code points.
            assert all(len(line) <= 120 for line in lines if "<U+" not in line)
            # No comment is inside another, and none ends early: else the text would not parse.
            comments = re.findall(rb"\(\*.*?\*\)", text, re.DOTALL)
            assert all(comment.count(b"(*") == comment.count(b"*)") == 1 for comment in comments)


def test_names_are_no_keywords_anywhere(default_book: TableBook, estimating_book: TableBook) -> None:
    text = b"".join([*texts_of(default_book).values(), *texts_of(estimating_book).values()])
    names = {node.text.decode("ascii").upper() for node in walk(parse(text)) if node.type == "identifier"}
    assert {"STAGE", "PATH_M", "SPEED_M_S", "TABLE"} < names
    assert names & set(KEYWORDS.split()) == set()
    assert all(len(name) <= 32 and "__" not in name and not name.endswith("_") for name in names)


def test_no_array_is_long(default_book: TableBook, estimating_book: TableBook) -> None:
    for book in (default_book, shaped_book(32, 9), estimating_book):
        for text in texts_of(book).values():
            lengths = [int(end) + 1 for end in re.findall(rb"ARRAY\[0\.\.(\d+)\]", text)]
            assert max(lengths) <= 999


def test_equal_books_give_equal_bytes(book: TableBook, small_book: TableBook) -> None:
    assert st_files(book) == st_files(TableBook(tuple(replace(table) for table in book.tables)))
    assert st_files(book) != st_files(small_book)


def test_as_many_tables_as_are_allowed_are_exported_and_no_more(
    small_book: TableBook, monkeypatch: pytest.MonkeyPatch
) -> None:
    passages = PassageBook((passage_table(stages=2),))
    of_lines, of_passages = (partial(line_export, small_book), partial(passage_export, passages))
    for module, tables, export in ((st_source, 2, of_lines), (passage_st_source, 1, of_passages)):
        monkeypatch.setattr(module, "MOST_TABLES", tables)
        assert export(self_test=SMALL)
        monkeypatch.setattr(module, "MOST_TABLES", tables - 1)
        with pytest.raises(InvalidTable, match=f"{tables} tables, .*at most {tables - 1}"):
            export(self_test=SMALL)
