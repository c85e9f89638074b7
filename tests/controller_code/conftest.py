"""Compilers where they are installed, and a book to compile."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from functools import cache

import pytest

from scripts.studies.in_the_loop.controller_process import Controller, build_controller
from tests.controller_code.building import ChangedExport, changed_export
from tests.controller_code.sample_book import estimating_book, sample_book, surface_book
from tuning_tables.table_book import TableBook

Tool = Callable[[str], str]
ToChange = Callable[[Sequence[Mapping[str, bytes]], str], ChangedExport]
Built = Callable[[TableBook], Controller]

BOOKS: dict[str, Callable[[], TableBook]] = {
    "measured": sample_book,
    "estimated": estimating_book,
    "gauged": lambda: surface_book(sample_book()),
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
    """Tables of many shapes, without and with estimators, approaches and slopes: all parts that an export may lack."""
    made: TableBook = request.param()
    return made


@pytest.fixture(scope="session")
def to_change(tool: Tool, tmp_path_factory: pytest.TempPathFactory) -> ToChange:
    """An export with each of its self-tests and the name of the file that is to be changed.

    All other files are compiled once, however often asked.
    """

    @cache
    def compiled(exports: tuple[tuple[tuple[str, bytes], ...], ...], name: str) -> ChangedExport:
        tool("gcc")
        return changed_export([dict(files) for files in exports], name, tmp_path_factory.mktemp("to-change"))

    return lambda exports, name: compiled(tuple(tuple(files.items()) for files in exports), name)


@pytest.fixture(scope="session")
def built(tool: Tool, tmp_path_factory: pytest.TempPathFactory) -> Built:
    """The controller of a book, built by gcc with the usual switches, once however often asked: it keeps nothing."""

    @cache
    def controller(book: TableBook) -> Controller:
        return build_controller(book, tmp_path_factory.mktemp("built"), tool("gcc"))

    return controller
