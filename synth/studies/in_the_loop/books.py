"""Books to prove controllers with: tables as a tune makes them, without and with estimators."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

from plant_models import Plant
from synth.book.tune import tune
from synth.configuration.config_file import parse_config
from synth.studies.cases import of_masses
from synth.studies.study import Tell
from tuning_tables import read_book
from tuning_tables.table_book import TableBook


@dataclass(frozen=True)
class Tuned:
    """A book, the plant that each of its tables was made for, and the digest of its configuration."""

    book: TableBook
    plants: tuple[Plant, ...]
    config_sha256: str


def default_book(estimator: bool, masses_t: tuple[float, ...], tell: Tell) -> Tuned:
    """The default book, of all its cuts or of those of these masses."""
    text = f"[regulator]\nestimator = {str(estimator).lower()}\n"
    config = of_masses(parse_config(text, "study"), masses_t)
    with tempfile.TemporaryDirectory() as tables:
        cases = tune(config, Path(tables), tell).cases
    return Tuned(TableBook(tuple(case.table for case in cases)), tuple(case.plant for case in cases), config.sha256)


def book_or_default(path: Path | None, estimator: bool, masses_t: tuple[float, ...], tell: Tell) -> TableBook:
    """The book in a file, or the default one."""
    return default_book(estimator, masses_t, tell).book if path is None else TableBook(read_book(path))


def with_estimators(book: TableBook) -> int:
    """How many tables have one."""
    return sum(table.estimator is not None for table in book.tables)
