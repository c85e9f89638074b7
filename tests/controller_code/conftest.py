"""Compilers where they are installed, and a book to compile."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable

import pytest

from tests.controller_code.sample_book import approaching_book, estimating_book, sample_book, surface_book
from tuning_tables.table_book import TableBook

Tool = Callable[[str], str]

BOOKS: dict[str, Callable[[], TableBook]] = {
    "measured": sample_book,
    "estimated": estimating_book,
    "approached": approaching_book,
    "surfaces": surface_book,
}


@pytest.fixture(scope="session")
def tool() -> Tool:
    """The path of a program; the test is skipped where it is missing, but fails where all are said to be there."""

    def find(name: str) -> str:
        path = shutil.which(name)
        if path is None:
            if os.environ.get("RETARDER_SYNTH_TOOLCHAIN") == "complete":
                pytest.fail(f"{name} is missing, though scripts/setup_toolchain has succeeded")
            pytest.skip(f"{name} is not installed (scripts/setup_toolchain)")
        return path

    return find


@pytest.fixture(scope="session", params=list(BOOKS.values()), ids=list(BOOKS))
def book(request: pytest.FixtureRequest) -> TableBook:
    """Tables of many shapes, without and with estimators, approaches and slopes."""
    made: TableBook = request.param()
    return made
