"""Whether the exported C controller decides, chooses and estimates as Python does, however it is compiled: on
books as a tune makes them, without and with estimators.

Half of the readings lie within two float32 steps of a line, a quarter are any bit patterns (NaN, infinities, denormals,
stages out of range), the rest is what cuts give. Samples for the estimator come in tracks of 100: one reading in twelve
is any bits, a special number, or beside a break or limit, and one estimate in 200 is any bits; compared are the speed
and all words of the estimate. Ways of compiling that lack a program are named and left out (`scripts/setup_toolchain`).
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from plant_models import Plant
from scripts.studies.cases import of_masses
from scripts.studies.in_the_loop.agreement import Differences, Questions, Tracks, ask, differences, follow
from scripts.studies.in_the_loop.controller_process import BUILDS, Build
from scripts.studies.study import ABSENT, Findings, MarkdownTable, Method, Tell, option, table
from synth.frame.workers.engine import Teller
from synth.retarder.asked_tune import RadarEpochs
from synth.retarder.configuration.config_file import load_config
from synth.retarder.tune import tune
from synth.retarder.tuned_table import read_back
from tuning_tables import read_book
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


@dataclass(frozen=True)
class Options:
    """What is asked, of which book."""

    book: Path | None = option(None, "book.h5; one with estimators, tuned here, without it")
    config: Path | None = option(None, "configuration of the book tuned here; the built-in one without it")
    masses_t: tuple[float, ...] = option((), "of the book tuned here only cuts of these masses, t")
    readings: int = option(1_000_000, "readings, golden ones among them", (100_000, 10**9))
    commands: int = option(20_000, "commands of a speed", (10, 10**8))
    samples: int = option(1_000_000, "samples for the estimator", (100, 10**9))
    seed: int = option(1, "of all these", (0, 2**31))
    builds: int = option(len(BUILDS), "ways of compiling, from the first on", (1, len(BUILDS)))


@dataclass(frozen=True)
class Row:
    """One way of compiling; `missing`: programs that this machine lacks, else `found`: what differed."""

    build: str
    missing: tuple[str, ...]
    found: Differences | None


@dataclass(frozen=True)
class Agreement(Findings):
    """All ways of compiling, all asked the same; the numbers asked are those that were made."""

    tables_in_book: int
    with_estimator: int
    readings: int
    commands: int
    samples: int
    seed: int
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`agreement`: how many answers differ, a row a way of compiling."""
        heads = ("compiled by", "decisions", "choices", "estimates", "words of tables", "self-test")
        return {"agreement": table("Answers that differ from Python's", heads, map(cells, self.rows))}

    def sentences(self) -> tuple[str, ...]:
        """What was asked, and of how many."""
        compiled = [row.found for row in self.rows if row.found is not None]
        agreed = sum(found.none for found in compiled)
        return (
            f"{self.tables_in_book} tables, {self.with_estimator} with estimator; {self.readings} readings, "
            f"{self.commands} commands, {self.samples} samples, seed {self.seed}",
            f"{agreed} of {len(compiled)} ways of compiling agree in everything; "
            f"{len(self.rows) - len(compiled)} left out",
        )

    def faults(self) -> tuple[str, ...]:
        """A sentence for every way of compiling that answers otherwise, and one if there was none."""
        wrong = [f"{row.build} answers otherwise" for row in self.rows if row.found is not None and not row.found.none]
        if all(row.found is None for row in self.rows):
            wrong.append("no compiler is installed; scripts/setup_toolchain installs them")
        return tuple(wrong)


def cells(row: Row) -> tuple[str, ...]:
    """The cells of one way of compiling."""
    found = row.found
    if found is None:
        return row.build, *[ABSENT] * 4, f"not run: no {' and no '.join(row.missing)}"
    return (row.build, str(found.decisions), str(found.choices), str(found.estimates), str(found.tables),
            found.self_test)  # fmt: skip


def run(options: Options, tell: Tell) -> Agreement:
    """Ask Python first, then every controller."""
    if options.book is None:
        book = tuned_book(options.config, True, options.masses_t, tell).book
    else:
        book = TableBook(read_book(options.book))
    questions = ask(book, options.readings, options.commands, options.seed)
    tracks = follow(book, options.samples, options.seed + 2)
    rows = []
    for build in BUILDS[: options.builds]:
        rows.append(row_of(build, questions, tracks))
        tell(f"{build}: {'left out' if rows[-1].found is None else 'asked'}")
    return Agreement(
        tables_in_book=len(book.tables),
        with_estimator=with_estimators(book),
        readings=len(questions.readings),
        commands=len(questions.commands),
        samples=len(tracks.samples),
        seed=options.seed,
        rows=tuple(rows),
    )


def row_of(build: Build, questions: Questions, tracks: Tracks) -> Row:
    """Compile and ask, if the compiler is there."""
    if build.missing():
        return Row(str(build), build.missing(), None)
    with tempfile.TemporaryDirectory() as directory:
        controller = build.controller(questions.book, Path(directory))
        return Row(str(build), (), differences(controller, questions, tracks))


METHOD = Method(
    Options, Options(masses_t=(52.0,), readings=100_000, commands=50, samples=500, builds=1), Agreement, run
)
