"""The command `sweep run`: books over a grid of classes, targets and conditions; units are stored as they come.

The solver is imported when a worker needs it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from synth.frame.command import Asked, Command, Head, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.machine import available
from synth.frame.workers.engine import Answer, answered, require_software
from synth.retarder.configured import sensors_left_aside
from synth.retarder.exit_figures import CHANCE_ONLY, MODEL_ONLY, NOT_CERTIFIED
from synth.retarder.options import SweepOptions
from synth.retarder.sweep.plan import UnitOrder
from synth.retarder.sweep.sweep_directory import SWEEP, HeldSweep
from synth.retarder.sweep.sweep_file import SweepFile, parse_sweep
from synth.retarder.sweep.unit_result import UnitResult

if TYPE_CHECKING:
    from synth.frame.workers.engine import Engine
    from synth.retarder.sweep.book_figures import BookFigures
    from synth.retarder.sweep.run import Task


def answer(order: UnitOrder) -> Answer:
    """Compute a unit."""
    return answered(order, computed)


def computed(order: UnitOrder) -> UnitResult:
    """The result of `order`, computed in this process by this very software; raises what its steps raise."""
    require_software(order.software)
    from synth.kernels.cache import guarded
    from synth.retarder.sweep.tune_unit import tune_unit

    return guarded(tune_unit, order)


LIMITS_OF_USE = (
    MODEL_ONLY,
    CHANCE_ONLY,
    "A sweep judges no table: which cases are feasible is not worked out. 'tune' and 'validate' judge them.",
    NOT_CERTIFIED,
)

AskedSweep: TypeAlias = Asked[SweepFile, SweepOptions]


def resolve(asked: AskedSweep) -> AskedSweep:
    """Refuse two kinds of workers at once."""
    asked.options.require_one(SWEEP)
    return asked


def head(asked: AskedSweep) -> Head:
    """What is said of it."""
    file = asked.settings
    return Head(
        title=file.base.title,
        canonical_json=file.canonical_json,
        parameters=tuple(file.parameters()),
        output=file.base.output,
        warnings=tuple(
            condition.said(warning)
            for condition in file.conditions
            for warning in (*condition.config.warnings, *sensors_left_aside(condition.config))
        ),
        reads=tuple(Path(each.place) for condition in file.conditions for each in condition.library.own),
    )


def steps(asked: AskedSweep) -> Steps:
    """A step for each unit: a class under a condition."""
    return Steps(sum(len(each.config.cuts) for each in asked.settings.conditions), "sweeping", "units")


def compute(asked: AskedSweep, work: Work) -> tuple[BookFigures, ...]:
    """The figures of each condition, its book written. `InputError` where units fit into no memory, and where a file
    is in the way of a book."""
    from synth.retarder.sweep.run import run_sweep, task_of

    directory = HeldSweep(work.directory.path, work.directory)
    task = task_of(asked.settings, directory, work.progress)
    work.progress.begin(len(task.plan.units) - len(task.missing))
    return run_sweep(task, directory, engine_for(task, asked.options, work.progress.note), work.progress)


def engine_for(task: Task, options: SweepOptions, tell: Callable[[str], None]) -> Engine:
    """The cluster that was named, or processes on this machine as far as memory allows, which `tell` is told."""
    from synth.retarder.sweep.run import fitting_workers

    if options.scheduler is not None:
        from synth.frame.workers.dask_cluster import connect

        return connect(options.scheduler, answer, tell)
    from synth.frame.workers.local_workers import LocalWorkers

    asked = options.workers or available()
    fit = fitting_workers(task, asked)
    if fit < min(asked, len(task.missing)):
        tell(f"warning: memory allows for {fit} of {asked} workers")
    return LocalWorkers(fit, answer)


def limits(books: tuple[BookFigures, ...]) -> Iterable[Limit]:
    """One where a table is missing."""
    from synth.retarder.sweep.shown import limits_of

    return limits_of(books)


def show(books: tuple[BookFigures, ...]) -> Iterator[Chapter]:
    """All conditions side by side, and a picture of each."""
    from synth.retarder.sweep.shown import chapters, pictures

    yield from chapters(books)
    yield Chapter("Pictures", tuple(pictures(books)))


COMMAND = Command(
    name=SWEEP,
    read=parse_sweep,
    options=SweepOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
