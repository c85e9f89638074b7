"""Books out of stored results: read one by one, stamped with date and configuration, bound a condition each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.metadata import version

from synth.frame.results_directory import SUMMARY, ResultsDirectory
from synth.frame.settings.toml_text import toml_text
from synth.retarder.sweep.book_summary import BookFigures, Failure, book_summary, case_of, sweep_summary
from synth.retarder.sweep.plan import Plan, Unit
from synth.retarder.sweep.sweep_directory import HeldSweep, SweepDirectory
from synth.retarder.sweep.sweep_file import Condition, SweepFile
from synth.retarder.sweep.unit_result import UnitResult
from tuning_tables import ControllerTable, Generator, InvalidTable, TableBook, TableError, to_json, write_book
from tuning_tables.canonical import canonical_json

BOOK, CONFIG, PICTURE = "book.h5", "config.toml", "rms-by-mass-and-target"

TYPES = "types"
"""Folder of the user's types beside the configuration of a swept book."""

__all__ = ["Failure", "Outcome", "bind"]


@dataclass(frozen=True)
class Outcome:
    """What a run has come to: the summary as written; units without a result and targets without a table."""

    summary: dict[str, object]
    failures: tuple[Failure, ...]


def bind(file: SweepFile, plan: Plan, created: str, directory: HeldSweep, failures: list[Failure]) -> Outcome:
    """Write the book, summary and picture of every condition, and last of all the summary of the sweep."""
    failed, results = {failure.key: failure for failure in failures}, directory.results
    for condition in plan.conditions:
        results.remove(within(condition, SUMMARY))
    books = [bound(file, plan, condition, created, directory, failed) for condition in plan.conditions]
    results.remove_others()
    for book in books:
        results.write(within(book.condition, SUMMARY), book_summary(book, created))
    summary = sweep_summary(books, created)
    results.finish(canonical_json(summary) + b"\n")
    return Outcome(summary, tuple(failure for book in books for failure in book.failures))


def within(condition: Condition, name: str) -> str:
    """The name of a file of a condition in the directory of the sweep."""
    return f"{condition.name}/{name}" if condition.name else name


def bound(
    file: SweepFile, plan: Plan, condition: Condition, created: str, directory: HeldSweep, failed: dict[str, Failure]
) -> BookFigures:
    """The figures of one condition, its files written but for the summary; no file where no unit has a result."""
    tables, figures = [], BookFigures(condition)
    for unit in plan.of(condition):
        result = found(unit, directory, failed)
        if result is None:
            figures.failures.append(failed[unit.order.key])
            continue
        stamped = [stamp(row.table, condition, created) for row in result.rows]
        figures.cases += [case_of(result.label, row, table) for row, table in zip(result.rows, stamped, strict=True)]
        figures.gaps += [(result.label, gap) for gap in result.gaps]
        figures.failures += [
            Failure(result.key, result.condition, result.label, each.reason, each.target_m_s) for each in result.refused
        ]
        tables += stamped
    if tables:
        write_condition(file, condition, tables, figures, directory.results)
        figures.shadowed, figures.no_code = choice_of(tables)
        figures.files |= directory.results.written_below(condition.name)
    return figures


def found(unit: Unit, directory: SweepDirectory, failed: dict[str, Failure]) -> UnitResult | None:
    """The stored result of a unit; None, noted in `failed`, where there is none or it is none of ours."""
    order = unit.order
    if order.key in failed:
        return None
    try:
        return directory.stored(order.key)
    except (FileNotFoundError, TableError) as fault:
        reason = f"its result was lost or damaged while the sweep ran ({fault}); run the sweep again"
        failed[order.key] = Failure(order.key, order.condition, order.label, reason)
        return None


def stamp(table: ControllerTable, condition: Condition, created: str) -> ControllerTable:
    """The table with date and configuration of this run; a result may come from an earlier one with other classes."""
    generator = Generator("retarder-synth", version("retarder-synth"), condition.config.sha256)
    if (table.created, table.generator) == (created, generator):
        return table
    return replace(table, created=created, generator=generator)


def write_condition(
    file: SweepFile, condition: Condition, tables: list[ControllerTable], figures: BookFigures,
    results: ResultsDirectory,
) -> None:  # fmt: skip
    """Book, configuration, tables and picture of one condition."""
    with results.writing(within(condition, BOOK)) as part:
        write_book(tables, part)
    results.write_all(configuration_files(condition))
    if file.settings.tables:
        results.write_all({within(condition, f"tables/{table.id}.json"): to_json(table) for table in tables})
    if condition.config.output.plots:
        from synth.frame.picture.figure_file import figure_files
        from synth.retarder.sweep.heat_map import heat_map

        refused = {(each.label, each.target_m_s) for each in figures.failures if each.target_m_s is not None}
        drawn = figure_files(heat_map(figures.cases, refused, condition), PICTURE, within(condition, "plots"))
        results.write_all(drawn)


def configuration_files(condition: Condition) -> dict[str, bytes]:
    """The configuration of a condition, and beside it the user's types that it names."""
    own = condition.library.own
    tree = {**condition.tree, "library": [f"{TYPES}/"]} if own else condition.tree
    texts = {f"{TYPES}/{each.kind.folder}/{each.name}.toml": each.text for each in own} | {CONFIG: toml_text(tree)}
    return {within(condition, name): text.encode("utf-8") for name, text in texts.items()}


def choice_of(tables: list[ControllerTable]) -> tuple[int, str]:
    """How many tables no choice by category and axles can reach, and why the book makes no controller code, if so."""
    try:
        return len(TableBook(tuple(tables)).shadowed()), ""
    except InvalidTable as fault:
        return 0, str(fault)
