"""A run of a sweep: what is not there yet is computed, stored one by one, and bound into books at the end."""

from __future__ import annotations

from contextlib import closing
from dataclasses import asdict, dataclass
from importlib.metadata import version

from synth.frame.address_space import address_space_limit_bytes
from synth.frame.creation_time import creation_time
from synth.frame.input_error import InputError
from synth.frame.printed_numbers import counted
from synth.frame.workers.engine import Engine, Watcher
from synth.frame.workers.stored_results import missing_of
from synth.retarder.sweep.bind import bind
from synth.retarder.sweep.book_figures import BookFigures, Failure
from synth.retarder.sweep.ledger import DONE, ENDED, FAILED, PLAN, STARTED, LedgerWriter
from synth.retarder.sweep.plan import Plan, Unit, UnitOrder, plan_of
from synth.retarder.sweep.sweep_directory import LEDGER, HeldSweep
from synth.retarder.sweep.sweep_file import SweepFile
from synth.solver.chain.grid import available_memory_bytes

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
