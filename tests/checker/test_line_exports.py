"""Exports of tables with lines of many shapes agree with them; each way in which one is no export is told."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import pytest

from synth.checker.code_export import c_differences, st_differences
from synth.checker.code_file import LINES
from synth.checker.finding import DamagedError
from synth.checker.line_numbers import due_of_lines
from synth.checker.table_reading import Table, read_table
from tests.controller_code.sample_book import approaching_book, estimating_book, sample_book, surface_book
from tests.st_files import st_files
from tuning_tables import to_json
from tuning_tables.c_source import c_files
from tuning_tables.self_test_size import SMALL
from tuning_tables.st_source import TABLE_FILE
from tuning_tables.table_book import TableBook

NUMBER = r"-?(?:0x[01][0-9a-f.]*p[+-]\d+f|\d[\d.]*(?:E[+-]\d+)?)"


@cache
def exported(tables: int = 3) -> tuple[dict[str, str], tuple[Table, ...]]:
    """The texts of a book with approaches, slopes and estimators, and its tables as the checker reads them."""
    book = TableBook(surface_book(approaching_book()).tables[:tables])
    content = {**c_files(book, self_test=SMALL), TABLE_FILE: st_files(book, self_test=SMALL)[TABLE_FILE]}
    texts = {name: text.decode("utf-8") for name, text in content.items()}
    return texts, tuple(read_table(to_json(table)) for table in book.tables)


def sentences(texts: dict[str, str], tables: tuple[Table, ...]) -> list[str]:
    """All that is found in both languages."""
    found = [
        *c_differences(texts["retarder_table.c"], texts["retarder_table.h"], "RETARDER", LINES, due_of_lines(tables)),
        *st_differences(texts[TABLE_FILE], "RETARDER", LINES, due_of_lines(tables)),
    ]
    return [sentence for _, sentence in found]


def changed(text: str, pattern: str) -> str:
    """The text with the number in the group of the pattern another one."""
    found = re.search(pattern, text)
    assert found is not None, pattern
    old = found[1]
    new = "0x1.8p+7f" if "p" in old else "7.5" if "." in old else "7"
    return text[: found.start(1)] + new + text[found.end(1) :]


@pytest.mark.parametrize("made", [sample_book, estimating_book, approaching_book, surface_book])
def test_exports_of_many_shapes_agree_with_their_tables(made: Callable[[], TableBook]) -> None:
    book = made()
    tables = tuple(read_table(to_json(table)) for table in book.tables)
    files = {**c_files(book, self_test=SMALL), **st_files(book, self_test=SMALL)}
    assert sentences({name: text.decode("utf-8") for name, text in files.items()}, tables) == []


@pytest.mark.parametrize("name", ["MassOf", "TargetOf", "CategoryOf"])
def test_a_column_that_differs_in_another_block_is_found(name: str) -> None:
    texts, tables = exported()
    head, block, tail = texts[TABLE_FILE].partition("FUNCTION_BLOCK RETARDER_CHOOSE")
    text = head + block + changed(tail, rf"\b{name} : ARRAY\S+ OF \w+ := \[\s*({NUMBER})")
    assert any(name in sentence for sentence in sentences({**texts, TABLE_FILE: text}, tables))


@pytest.mark.parametrize(
    ("name", "pattern", "replacement", "words"),
    [
        ("retarder_table.c", r"retarder_table_count = 3", "retarder_table_count = 2", "retarder_table_count is 2"),
        ("retarder_table.c", r"\S+, /\* mass_t", "0x1.zp, /* mass_t", "is no number of a table"),
        ("retarder_table.c", r"\d+, /\* axles", "091, /* axles", "091 is no whole number"),
        ("retarder_table.c", r"(0x1\.\w+p\+\d+f), (0x)", r"\1, 0x1p+0f, \2", "words, but its struct has"),
        ("retarder_table.h", r"    int32_t axles;.*\n", "", "words, but its struct has"),
        ("retarder_table.h", r"    uint32_t crc32;.*\n", "", "does not end with its checksum"),
        ("retarder_table.h", r"\} retarder_table;", "} other;", "has no struct retarder_table"),
        ("retarder_table.h", r"(CATEGORY_\w+) 1 ", r"\1 2 ", "defines the categories"),
        (TABLE_FILE, r"(-?\d\.\d{8})\d(E-\d\d)", r"\g<1>X\2", "something else than REAL"),
        (TABLE_FILE, r"ApproachOf : .*\n", "\n", "approachm of table 0 is missing"),
        (TABLE_FILE, r"Brake_0 : ", "Brake_9 : ", "brake of table 0 is missing"),
        (TABLE_FILE, r"ARRAY\[0\.\.2\] OF INT := \[", "ARRAY[0..3] OF INT := [", "but is declared with 4"),
        (TABLE_FILE, r"RETARDER_TABLE : STRUCT", "OTHER : STRUCT", "has no type RETARDER_TABLE"),
        (TABLE_FILE, r"FUNCTION_BLOCK RETARDER_LOAD", "FUNCTION_BLOCK OTHER", "has no block RETARDER_LOAD"),
    ],
)
def test_a_damaged_export_is_found(name: str, pattern: str, replacement: str, words: str) -> None:
    texts, tables = exported()
    text, count = re.subn(pattern, replacement, texts[name], count=1)
    assert count == 1
    try:
        found = sentences({**texts, name: text}, tables)
    except DamagedError as damage:
        found = [str(damage)]
    assert any(re.search(words, sentence) for sentence in found), found


def test_another_number_of_tables_is_found() -> None:
    texts, tables = exported()
    found = sentences(texts, tables[:2])
    assert found.count("it holds 3 tables, but there are 2") == 2
