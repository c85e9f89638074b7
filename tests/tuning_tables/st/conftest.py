"""Books to export: many shapes, a real one, and one for each extreme."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache, lru_cache
from pathlib import Path
from types import MappingProxyType

import pytest

from tests.controller_code.sample_book import FOUR_AXLES, sample_book, table_of
from tests.controller_code.sample_book import estimating_book as book_with_estimators
from tests.st_files import st_files
from tests.tuning_tables.st.evaluator import Program
from tuning_tables import read_json
from tuning_tables.export_names import RETARDER
from tuning_tables.exports import TABLE_FILE
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.table_book import TableBook


@pytest.fixture(scope="session")
def book() -> TableBook:
    """Tables of many shapes, with numbers as hard as numbers can be."""
    return sample_book()


@pytest.fixture(scope="session")
def estimating_book() -> TableBook:
    """The same tables with estimators, a few without."""
    return book_with_estimators()


@pytest.fixture(scope="session")
def default_book() -> TableBook:
    """Two classes of the book that `tune` makes without a configuration."""
    files = sorted((Path(__file__).parent / "default_book").glob("*.json"))
    return TableBook(tuple(read_json(file) for file in files))


@pytest.fixture(scope="session")
def small_book() -> TableBook:
    """Two tables of one class, quick to test."""
    return TableBook(tuple(table_of(f"to {speed}", "Л", 23.0, FOUR_AXLES, speed, 3, 1) for speed in (2.0, 3.0)))


@cache
def texts_of(book: TableBook, self_test: SelfTestSize = FULL) -> Mapping[str, bytes]:
    """The exported texts of a book, made once for all tests that change or run them."""
    return MappingProxyType(dict(st_files(book, RETARDER, self_test)))


@lru_cache(maxsize=8)
def program_of(book: TableBook) -> Program:
    """The exported tables of a book as a program, made once; it keeps nothing but the count of what it has done."""
    return Program(texts_of(book)[TABLE_FILE])


def shaped_book(stages: int, degree: int) -> TableBook:
    """One table of the given size."""
    return TableBook((table_of("one", "Т", 85.0, FOUR_AXLES, 3.0, stages, degree),))


def oddly_named_book() -> TableBook:
    """Names that would end a comment, fill a blank, or leave ASCII, if they could."""
    names = ("*) IF (*", "@TABLES@", "$LAST_TABLE", "// {pragma} 'text'", "№ 7 «ЛС»", "END_FUNCTION_BLOCK", " (* ")
    tables = []
    for number, name in enumerate(names, start=16):
        table = table_of(name, name, 23.0, FOUR_AXLES, 2.0)
        tables.append(replace(table, cut=replace(table.cut, category_number=number)))
    return TableBook(tuple(tables))
