"""Books to export: many shapes, a real one, and one for each extreme."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tests.controller_code.sample_book import FOUR_AXLES, sample_book, table_of
from tests.controller_code.sample_book import estimating_book as book_with_estimators
from tuning_tables import read_json
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
