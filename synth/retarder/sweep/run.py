"""A run of a sweep: what is not there yet is computed, stored one by one, and bound into books at the end."""

from __future__ import annotations

import resource
from contextlib import closing
from dataclasses import asdict, dataclass
from importlib.metadata import version
from typing import Protocol

from synth.frame.creation_time import creation_time
from synth.frame.input_error import InputError
from synth.frame.workers.engine import Engine
from synth.retarder.sweep.bind import Failure, Outcome, bind
from synth.retarder.sweep.ledger import DONE, ENDED, FAILED, FOUND_DAMAGED, PLAN, STARTED, Ledger, LedgerWriter
from synth.retarder.sweep.plan import Plan, Unit, UnitOrder, plan_of
from synth.retarder.sweep.sweep_directory import LEDGER, HeldSweep
from synth.retarder.sweep.sweep_file import SweepFile
from synth.solver.chain.grid import available_memory_bytes
from tuning_tables import DamagedTable

USABLE = 0.8
"""Share of the free memory that workers may take."""

MAPPED_BYTES = 350 * 2**20
"""Address space of a worker beside its memory: libraries, stacks, arenas; 240 MB were measured on two cores."""


class Watcher(Protocol):
    """Is told how far a run is."""

    def note(self, sentence: str) -> None:
        """Something besides the units."""
        ...

    def done(self, unit: Unit, sentence: str) -> None:
        """A unit is computed, or has failed."""
        ...


@dataclass(frozen=True)
class Task:
    """What a run has before it: the plan, the units not yet there, heaviest first, and those found damaged."""

    file: SweepFile
    plan: Plan
    created: str
    missing: tuple[Unit, ...]
    damaged: tuple[str, ...]


def task_of(file: SweepFile, directory: HeldSweep) -> Task:
    """What is to be done in `directory`; `InputError` where it holds books that would become stale."""
    ledger = directory.ledger()
    require_same_layout(file, ledger, directory)
    created = ledger.created or creation_time()
    plan = plan_of(file, created)
    missing, damaged = [], []
    for unit in plan.units:
        try:
            if directory.has(unit.order.key):
                continue
        except DamagedTable:
            damaged.append(unit.order.key)
        missing.append(unit)
    heaviest_first = sorted(missing, key=lambda unit: -unit.work)  # stable: equal ones in the order of the plan
    return Task(file, plan, created, tuple(heaviest_first), tuple(damaged))


def require_same_layout(file: SweepFile, ledger: Ledger, directory: HeldSweep) -> None:
    """`InputError` if an earlier run has bound books for conditions that `file` does not list, or a
    stranger's file lies in the folder of a condition."""
    earlier = {str(name) for event in ledger.of(PLAN) for name in event["conditions"]}
    lost = sorted(earlier - {condition.name for condition in file.conditions})
    if lost:
        named = ", ".join(name or "no conditions" for name in lost)
        raise InputError(
            f"{directory.path}: an earlier sweep there had {named}; its books would be stale: give another directory "
            "by -o, or delete this one"
        )
    for condition in file.conditions:
        if condition.name:
            directory.results.require_own_below(condition.name)


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
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    needed = largest.memory_bytes + MAPPED_BYTES
    if limit != resource.RLIM_INFINITY and limit < needed:
        raise InputError(
            f"ulimit -v is {limit // 1024} kB, but the worker for {largest.order.name} may map "
            f"{needed // 1024} kB: raise that limit"
        )


def run_sweep(task: Task, directory: HeldSweep, engine: Engine, watcher: Watcher) -> Outcome:
    """Compute what is missing and bind everything that is there; a unit that fails does not stop the others.

    Raises `OSError` where the directory cannot be written. What was stored before stays.
    """
    with LedgerWriter(directory.results.growing(LEDGER)) as ledger:
        ledger.write(PLAN, plan_event(task))
        for key in task.damaged:
            ledger.write(FOUND_DAMAGED, {"unit": key})
            watcher.note(f"the result in {directory.unit_file(key)} is damaged and is computed again")
        failures = computed(task, directory, engine, watcher, ledger)
        outcome = bind(task.file, task.plan, task.created, directory, failures)
        failed = sum(failure.target_m_s is None for failure in outcome.failures)
        ledger.write(ENDED, {"units": len(task.plan.units), "failed": failed})
    return outcome


def computed(task: Task, directory: HeldSweep, engine: Engine, watcher: Watcher, ledger: LedgerWriter) -> list[Failure]:
    """Have the missing units computed and store each as it comes; those that failed."""
    units = {unit.order.key: unit for unit in task.missing}
    failures = []

    def begun(order: UnitOrder) -> None:
        ledger.write(STARTED, {"unit": order.key})

    with closing(engine.answers([unit.order for unit in task.missing], begun)) as answers:
        for answer in answers:
            unit = units[answer.key]
            facts = {"unit": answer.key, "seconds": round(answer.seconds, 3), "worker": answer.worker}
            if answer.result is None:
                failures.append(Failure(answer.key, unit.order.condition, unit.order.label, answer.reason))
                ledger.write(FAILED, {**facts, "name": unit.order.name, "reason": answer.reason})
                watcher.done(unit, f"{unit.order.name} failed: {answer.reason}")
                continue
            directory.store(answer.result)
            rows = answer.result.rows
            refused = [asdict(each) for each in answer.result.refused]
            ledger.write(DONE, {**facts, "tables": len(rows), "refused": refused})
            worst = max(rows, key=lambda row: row.table.predicted.rms_m_s).table
            watcher.done(
                unit,
                f"{unit.order.name}: {len(rows)} tables, highest rms {worst.predicted.rms_m_s:.3f} m/s to "
                f"{worst.target_speed_m_s:g} m/s{f'; targets without a table: {len(refused)}' if refused else ''}",
            )
    return failures


def plan_event(task: Task) -> dict[str, object]:
    """The plan as the ledger keeps it, so that `sweep status` needs nothing else."""
    return {
        "created": task.created,
        "tool": version("retarder-synth"),
        "title": task.plan.conditions[0].config.title,
        "conditions": [each.name for each in task.plan.conditions],
        "units": [[unit.order.key, unit.order.name] for unit in task.plan.units],
        "missing": [unit.order.key for unit in task.missing],
    }
