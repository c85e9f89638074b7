"""Books to prove controllers with: tables as a tune makes them, without and with estimators."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from plant_models import Plant
from scripts.studies.cases import of_masses
from scripts.studies.study import Tell
from synth.frame.workers.engine import Teller
from synth.retarder.configuration.config_file import load_config
from synth.retarder.radar_epochs import RadarEpochs
from synth.retarder.tune import tune
from synth.retarder.tuned_table import read_back
from tuning_tables.table_book import TableBook


@dataclass(frozen=True)
class Tuned:
    """A book, the plant that each of its tables was made for, and the digest of its configuration."""

    book: TableBook
    plants: tuple[Plant, ...]
    config_sha256: str


def tuned_book(config: Path | None, estimator: bool, masses_t: tuple[float, ...], tell: Tell) -> Tuned:
    """The book of a configuration (the built-in one for None), of all its cuts or of those of these masses."""
    loaded = of_masses(load_config(config), masses_t)
    regulated = replace(loaded, regulator=loaded.regulator.model_copy(update={"estimator": estimator}))
    cases = tune(regulated, RadarEpochs(), read_back, Teller(tell)).whole
    book = TableBook(tuple(case.table for case in cases))
    return Tuned(book, tuple(case.plant for case in cases), regulated.sha256)


def with_estimators(book: TableBook) -> int:
    """How many tables have one."""
    return sum(table.estimator is not None for table in book.tables)
