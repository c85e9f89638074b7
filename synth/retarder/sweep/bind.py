"""Books out of stored results: read one by one, stamped with date and configuration, bound a condition each."""

from __future__ import annotations

from dataclasses import replace
from importlib.metadata import version

from synth.frame.command import Verdict
from synth.frame.exhibits import Row
from synth.frame.results_directory import SUMMARY, ResultsDirectory
from synth.frame.settings.toml_text import toml_text
from synth.frame.summary import summary_of
from synth.frame.told import Told
from synth.retarder.configured import head_of
from synth.retarder.sweep.book_figures import BookFigures, Failure, case_row, gap_row
from synth.retarder.sweep.plan import Plan, Unit
from synth.retarder.sweep.shown import chapters, limits_of
from synth.retarder.sweep.sweep_directory import SWEEP, HeldSweep, SweepDirectory
from synth.retarder.sweep.sweep_file import Condition, SweepFile
from synth.retarder.sweep.unit_result import UnitResult
from tuning_tables import ControllerTable, Generator, InvalidTable, TableBook, TableError, to_json, write_book

BOOK, CONFIG = "book.h5", "config.toml"

TYPES = "types"
"""Folder of the user's types beside the configuration of a swept book."""


def bind(
    file: SweepFile, plan: Plan, created: str, directory: HeldSweep, failed: dict[str, Failure]
) -> tuple[BookFigures, ...]:
    """Write the book of every condition, and last of all a summary into the folder of each.

    `failed`: units without a result, by their keys; those whose results cannot be read are added.
    """
    results = directory.results
    for condition in plan.conditions:
        results.remove(condition.file(SUMMARY))
    books = tuple(bound(file, plan, condition, created, directory, failed) for condition in plan.conditions)
    results.remove_others()
    for book in books:
        if book.condition.name:
            results.write(book.condition.file(SUMMARY), book_summary(book, created, results))
    return books


def bound(
    file: SweepFile, plan: Plan, condition: Condition, created: str, directory: HeldSweep, failed: dict[str, Failure]
) -> BookFigures:
    """The figures of one condition, its files written but for the summary; no file where no unit has a result."""
    tables: list[ControllerTable] = []
    cases: list[Row] = []
    gaps: list[Row] = []
    failures: list[Failure] = []
    for unit in plan.of(condition):
        result = found(unit, directory, failed)
        if result is None:
            failures.append(failed[unit.order.key])
            continue
        stamped = [stamp(row.table, condition, created) for row in result.rows]
        cases += [
            case_row(condition, result.label, row, table) for row, table in zip(result.rows, stamped, strict=True)
        ]
        gaps += [gap_row(condition, result.label, gap) for gap in result.gaps]
        failures += [Failure(condition.name, each.label, each.reason, each.target_m_s) for each in result.refused]
        tables += stamped
    if tables:
        write_condition(file, condition, tables, directory.results)
    choice = choice_of(tables) if tables else (0, "")
    return BookFigures(condition, tuple(cases), tuple(gaps), tuple(failures), *choice)


def book_summary(book: BookFigures, created: str, results: ResultsDirectory) -> bytes:
    """The summary of one condition, in the form of that of the whole sweep: its folder may be taken elsewhere."""
    told = Told(
        SWEEP, head_of(book.condition.config), created, Verdict(tuple(limits_of([book]))), tuple(chapters([book])), ()
    )
    return summary_of(told, results.written_below(book.condition.name))


def found(unit: Unit, directory: SweepDirectory, failed: dict[str, Failure]) -> UnitResult | None:
    """The stored result of a unit; None, noted in `failed`, where there is none or it is none of ours."""
    order = unit.order
    if order.key in failed:
        return None
    try:
        return directory.stored(order.key)
    except (FileNotFoundError, TableError) as fault:
        reason = f"its result was lost or damaged while the sweep ran ({fault}); run the sweep again"
        failed[order.key] = Failure(order.condition, order.label, reason)
        return None


def stamp(table: ControllerTable, condition: Condition, created: str) -> ControllerTable:
    """The table with date and configuration of this run; a result may come from an earlier one with other classes."""
    generator = Generator("retarder-synth", version("retarder-synth"), condition.config.sha256)
    if (table.created, table.generator) == (created, generator):
        return table
    return replace(table, created=created, generator=generator)


def write_condition(
    file: SweepFile, condition: Condition, tables: list[ControllerTable], results: ResultsDirectory
) -> None:
    """Book, configuration and tables of one condition."""
    with results.writing(condition.file(BOOK)) as part:
        write_book(tables, part)
    results.write_all(configuration_files(condition))
    if file.settings.tables:
        results.write_all({condition.file(f"tables/{table.id}.json"): to_json(table) for table in tables})


def configuration_files(condition: Condition) -> dict[str, bytes]:
    """The configuration of a condition, and beside it the user's types that it names."""
    own = condition.library.own
    tree = {**condition.tree, "library": [f"{TYPES}/"]} if own else condition.tree
    texts = {f"{TYPES}/{each.kind.folder}/{each.name}.toml": each.text for each in own} | {CONFIG: toml_text(tree)}
    return {condition.file(name): text.encode("utf-8") for name, text in texts.items()}


def choice_of(tables: list[ControllerTable]) -> tuple[int, str]:
    """How many tables no choice by category and axles can reach, and why the book makes no controller code, if so."""
    try:
        return len(TableBook(tuple(tables)).shadowed()), ""
    except InvalidTable as fault:
        return 0, str(fault)
