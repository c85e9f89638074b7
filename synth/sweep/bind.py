"""Books out of stored results: read one by one, stamped with date and configuration, bound a condition each."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

from synth.book.output_directory import SUMMARY, SWEPT_CONFIG, make_directory, remove_stale
from synth.configuration.toml_text import toml_text
from synth.sweep.book_summary import BookFigures, Failure, book_summary, case_of, sweep_summary
from synth.sweep.plan import Plan, Unit
from synth.sweep.sweep_directory import SweepDirectory
from synth.sweep.sweep_file import Condition, SweepFile
from synth.sweep.unit_result import UnitResult
from tuning_tables import ControllerTable, Generator, InvalidTable, TableBook, TableError, write_atomically, write_book
from tuning_tables.canonical import canonical_json
from tuning_tables.json_file import write_json

BOOK, CONFIG, PICTURE = "book.h5", SWEPT_CONFIG, "rms-by-mass-and-target"

TYPES = "types"
"""Folder of the user's types beside the configuration of a swept book."""

Say = Callable[[str], None]

__all__ = ["Failure", "Outcome", "bind"]


@dataclass(frozen=True)
class Outcome:
    """What a run has come to: the summary as written; units without a result and targets without a table."""

    summary: dict[str, object]
    failures: tuple[Failure, ...]


def bind(
    file: SweepFile, plan: Plan, created: str, directory: SweepDirectory, failures: list[Failure], say: Say
) -> Outcome:
    """Write the book, summary and picture of every condition, and last of all the summary of the sweep."""
    failed = {failure.key: failure for failure in failures}
    books = []
    for condition in plan.conditions:
        folder = directory.book_folder(condition.name)
        make_directory(folder)
        (folder / SUMMARY).unlink(missing_ok=True)
        tables, figures = [], BookFigures(condition)
        for unit in plan.of(condition):
            result = found(unit, directory, failed)
            if result is None:
                figures.failures.append(failed[unit.order.key])
                continue
            stamped = [stamp(row.table, condition, created) for row in result.rows]
            figures.cases += [
                case_of(result.label, row, table) for row, table in zip(result.rows, stamped, strict=True)
            ]
            figures.gaps += [(result.label, gap) for gap in result.gaps]
            figures.failures += [
                Failure(result.key, result.condition, result.label, each.reason, each.target_m_s)
                for each in result.refused
            ]
            tables += stamped
        books.append(bind_one(file, condition, created, folder, tables, figures, say))
    summary = sweep_summary(books, created)
    write_atomically(directory.summary, canonical_json(summary) + b"\n")
    return Outcome(summary, tuple(failure for book in books for failure in book.failures))


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


def bind_one(
    file: SweepFile, condition: Condition, created: str, folder: Path, tables: list[ControllerTable],
    figures: BookFigures, say: Say,
) -> BookFigures:  # fmt: skip
    """Everything in the folder of one condition; nothing but the summary where no unit has a result."""
    files: list[Path] = []
    if tables:
        write_book(tables, folder / BOOK)
        files += [folder / BOOK, *write_configuration(condition, folder)]
        figures.shadowed, figures.no_code = choice_of(tables)
    else:
        (folder / BOOK).unlink(missing_ok=True)
    if file.settings.tables:
        make_directory(folder / "tables")
        for table in tables:
            files.append(folder / "tables" / f"{table.id}.json")
            write_json(table, files[-1])
    if tables and condition.config.output.plots:
        from synth.present.plots.figure_file import save_figure
        from synth.sweep.heat_map import heat_map

        make_directory(folder / "plots")
        refused = {(each.label, each.target_m_s) for each in figures.failures if each.target_m_s is not None}
        files += save_figure(heat_map(figures.cases, refused, condition), folder / "plots", PICTURE)
    for name in remove_stale(folder, {file.relative_to(folder).as_posix() for file in files}):
        say(f"{folder / name} was there before; it is no readable table of this tool and was left alone")
    figures.files |= dict(hashes(folder, files))
    write_atomically(folder / SUMMARY, canonical_json(book_summary(figures, created)) + b"\n")
    return figures


def write_configuration(condition: Condition, folder: Path) -> list[Path]:
    """Write the configuration of a condition, and beside it the user's types that it names; the files."""
    written = [folder / CONFIG]
    tree = {**condition.tree, "library": [f"{TYPES}/"]} if condition.library.own else condition.tree
    for file in condition.library.own:
        make_directory(folder / TYPES / file.kind.folder)
        written.append(folder / TYPES / file.kind.folder / f"{file.name}.toml")
        write_atomically(written[-1], file.text.encode("utf-8"))
    for left in set((folder / TYPES).glob("*/*.toml")).difference(written):
        left.unlink()
    write_atomically(folder / CONFIG, toml_text(tree).encode("utf-8"))
    return written


def choice_of(tables: list[ControllerTable]) -> tuple[int, str]:
    """How many tables no choice by category and axles can reach, and why the book makes no controller code, if so."""
    try:
        return len(TableBook(tuple(tables)).shadowed()), ""
    except InvalidTable as fault:
        return 0, str(fault)


def hashes(folder: Path, files: list[Path]) -> Iterator[tuple[str, str]]:
    """(name relative to `folder`, SHA-256) of every file."""
    for file in files:
        yield file.relative_to(folder).as_posix(), hashlib.sha256(file.read_bytes()).hexdigest()
