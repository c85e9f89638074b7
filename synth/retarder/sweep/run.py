"""A run of a sweep: what is not there yet is computed, stored one by one, and bound into books at the end, a condition
each, stamped with date and configuration.
"""

from __future__ import annotations

from contextlib import closing
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version

from synth.frame.command import Verdict
from synth.frame.exhibits import Row
from synth.frame.faults import InputError
from synth.frame.machine import address_space_limit_bytes
from synth.frame.printed_numbers import counted
from synth.frame.results_directory import SUMMARY, ResultsDirectory
from synth.frame.settings.template import toml_text
from synth.frame.told import Told, summary_of
from synth.frame.version import creation_time
from synth.frame.workers.engine import Engine, Watcher, missing_of
from synth.retarder.configured import head_of
from synth.retarder.sweep.book_figures import BookFigures, Failure, case_row, gap_row
from synth.retarder.sweep.plan import Plan, Unit, UnitOrder, plan_of
from synth.retarder.sweep.shown import chapters, limits_of
from synth.retarder.sweep.sweep_directory import (
    DONE,
    ENDED,
    FAILED,
    LEDGER,
    PLAN,
    STARTED,
    SWEEP,
    HeldSweep,
    LedgerWriter,
    SweepDirectory,
)
from synth.retarder.sweep.sweep_file import Condition, SweepFile
from synth.retarder.sweep.unit_result import UnitResult
from synth.solver.chain.grid import available_memory_bytes
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


USABLE = 0.8
"""Share of the free memory that workers may take."""

MAPPED_BYTES = 350 * 2**20
"""Address space of a worker beside its memory: libraries, stacks, arenas; 240 MB were measured on two cores."""


@dataclass(frozen=True)
class Task:
    """What a run has before it: the plan, the date of all tables, and the units not yet there, heaviest first."""

    file: SweepFile
    plan: Plan
    created: str
    missing: tuple[Unit, ...]


def task_of(file: SweepFile, directory: HeldSweep, watcher: Watcher) -> Task:
    """What is to be done in `directory`; `InputError` where a stranger's file lies in the folder of a condition."""
    for condition in file.conditions:
        if condition.name:
            directory.results.require_own_below(condition.name)
    created = directory.ledger().created or creation_time()
    plan = plan_of(file, created)
    orders = [unit.order for unit in plan.units]
    missing = missing_of(orders, directory.unit_file, lambda order: directory.stored(order.key), watcher)
    keys = {order.key for order in missing}
    left = [unit for unit in plan.units if unit.order.key in keys]
    return Task(file, plan, created, tuple(sorted(left, key=lambda unit: -unit.work)))  # equal ones as in the plan


def fitting_workers(task: Task, asked: int) -> int:
    """How many of `asked` workers fit into the free memory, at most one a unit; `InputError` where none does."""
    if not task.missing:
        return 1
    largest = max(task.missing, key=lambda unit: unit.memory_bytes)
    require_address_space(largest)
    available = available_memory_bytes()
    fit = int(USABLE * available // largest.memory_bytes)
    if fit < 1:
        raise InputError(
            f"grid.path_step_m and grid.speed_step_m_s: {largest.order.name} would take about "
            f"{largest.memory_bytes / 1e9:.1f} GB and {available / 1e9:.1f} GB are free; make a step larger"
        )
    return min(asked, fit, len(task.missing))


def require_address_space(largest: Unit) -> None:
    """`InputError` if the limit of a process's address space is too low for a worker: OpenBLAS may hang then."""
    limit = address_space_limit_bytes()
    needed = largest.memory_bytes + MAPPED_BYTES
    if limit is not None and limit < needed:
        raise InputError(
            f"ulimit -v is {limit // 1024} kB, but the worker for {largest.order.name} may map "
            f"{needed // 1024} kB: raise that limit"
        )


def run_sweep(task: Task, directory: HeldSweep, engine: Engine, watcher: Watcher) -> tuple[BookFigures, ...]:
    """Compute what is missing and bind everything that is there; a unit that fails does not stop the others.

    What earlier runs have stored stays, also where this one does not need it. `OSError` where the disk raises it.
    """
    directory.results.retain(*directory.results.names_below("sweep"))
    with LedgerWriter(directory.results.growing(LEDGER)) as ledger:
        ledger.write(PLAN, plan_event(task))
        failed = computed(task, directory, engine, watcher, ledger)
        books = bind(task.file, task.plan, task.created, directory, failed)
        ledger.write(ENDED, {"units": len(task.plan.units), "failed": sum(book.failed_classes for book in books)})
    return books


def computed(
    task: Task, directory: HeldSweep, engine: Engine, watcher: Watcher, ledger: LedgerWriter
) -> dict[str, Failure]:
    """Have the missing units computed and store each as it comes; those that failed, by their keys."""
    orders = {unit.order.key: unit.order for unit in task.missing}
    failed = {}

    def begun(order: UnitOrder) -> None:
        ledger.write(STARTED, {"unit": order.key})

    with closing(engine.answers(tuple(orders.values()), begun)) as answers:
        for answer in answers:
            order = orders[answer.key]
            facts = {"unit": answer.key, "seconds": round(answer.seconds, 3), "worker": answer.worker}
            if answer.result is None:
                failed[order.key] = Failure(order.condition, order.label, answer.reason)
                ledger.write(FAILED, {**facts, "name": order.name, "reason": answer.reason})
                watcher.done(f"{order.name} failed: {answer.reason}")
                continue
            directory.store(answer.result)
            rows = answer.result.rows
            refused = [asdict(each) for each in answer.result.refused]
            ledger.write(DONE, {**facts, "tables": len(rows), "refused": refused})
            worst = max(rows, key=lambda row: row.table.predicted.rms_m_s).table
            left_out = f"; targets without a table: {len(refused)}" if refused else ""
            watcher.done(
                f"{order.name}: {counted(len(rows), 'table')}, highest predicted rms {worst.predicted.rms_m_s:.3f} "
                f"m/s to {worst.target_speed_m_s:g} m/s{left_out}",
            )
    return failed


def plan_event(task: Task) -> dict[str, object]:
    """The plan as the ledger keeps it, so that `sweep status` needs nothing else."""
    return {
        "created": task.created,
        "tool": version("retarder-synth"),
        "title": task.plan.conditions[0].config.title,
        "units": [[unit.order.key, unit.order.name] for unit in task.plan.units],
        "missing": [unit.order.key for unit in task.missing],
    }
