"""The main job: a whole table book from a resolved configuration, for regulators with any decision epochs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Generic

from plant_models import Plant
from synth.frame.creation_time import creation_time
from synth.retarder.attempted_case import attempted
from synth.retarder.class_setup import origin_of, validation_passes
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.epochs import Epochs, Ground, Store, Table
from synth.retarder.failed_case import FailedCase, parted, require_none
from synth.retarder.tuned_case import Case, TunedCase
from synth.retarder.watcher import Watcher
from synth.retarder.work_queue import run_nested
from synth.solver.chain.grid import require_memory
from synth.solver.one_blas_thread import one_blas_thread

CaseDone = Callable[[Case], None]


def no_notice(case: TunedCase) -> None:
    """Nobody wants to know of a finished case."""


@dataclass(frozen=True)
class Book(Generic[Case]):
    """Result of a tune: all cases, classes in the order of the configuration.

    `failed`: cases without a table, which are not among `cases`.
    """

    config: ResolvedConfig
    created: str
    cases: tuple[Case, ...]
    failed: tuple[FailedCase, ...] = ()

    @property
    def whole(self) -> tuple[Case, ...]:
        """All cases, for who needs every one; `PlantError` where one has no table."""
        require_none(self.failed)
        return self.cases


@dataclass(frozen=True)
class TuneRun(Generic[Case]):
    """What all classes of a tune share, and who is told.

    `watcher` is told a sentence whenever a case has ended, `case_done` given its result if it has a table.
    """

    epochs: Epochs[Case, Any]
    ground: Ground[Any]
    watcher: Watcher
    case_done: CaseDone[Case]


@one_blas_thread()
def tune(
    config: ResolvedConfig,
    epochs: Epochs[Case, Table],
    store: Store[Table],
    watcher: Watcher,
    workers: int = 2,
    case_done: CaseDone[Case] = no_notice,
) -> Book[Case]:
    """Tune every cut class and target of `config`; each table is handed to `store` as soon as it is made.

    Work runs on `workers` threads (the kernels release the interpreter); the result does not depend on how
    many. `watcher` is told a sentence whenever a case has ended, `case_done` given its result. A case that no table can
    be made for is told of in the book, and the others are made.
    """
    plants = config.plants()
    for label, plant in plants:
        require_memory(label, *epochs.grids(config, plant), workers)
    ground = Ground(config, origin_of(config.sha256, creation_time()), validation_passes(config), store)
    run = TuneRun(epochs, ground, watcher, case_done)
    heaviest_first = sorted(range(len(plants)), key=lambda i: -plants[i][1].top_stage * plants[i][1].cut.mass_t)
    starts = [partial(class_tasks, run, *plants[i]) for i in heaviest_first]
    by_class = dict(zip(heaviest_first, run_nested(starts, workers), strict=True))
    cases, failed = parted(result for index in range(len(plants)) for result in by_class[index])
    return Book(config, ground.origin.created, cases, failed)


def class_tasks(run: TuneRun[Case], label: str, plant: Plant) -> list[Callable[[], Case | FailedCase]]:
    """Prepare a cut class for all its targets; returns what is left to do for each, as tasks."""
    config, targets = run.ground.config, run.ground.config.targets_of(label)
    makers = attempted(partial(run.epochs.cases, run.ground, label, plant), label, targets[0], config)
    if isinstance(makers, FailedCase):
        return [partial(case_failed, run, replace(makers, target_m_s=target)) for target in targets]
    return [partial(case_task, run, label, target, make) for target, make in zip(targets, makers, strict=True)]


def case_task(run: TuneRun[Case], label: str, target_m_s: float, make: Callable[[], Case]) -> Case | FailedCase:
    """One case made, and told of."""
    case = attempted(make, label, target_m_s, run.ground.config)
    if isinstance(case, FailedCase):
        return case_failed(run, case)
    run.case_done(case)
    name, found = f"{label} to {target_m_s:g} m/s", case.statistics
    low, high = found.rms_ci95_m_s
    run.watcher.done(f"{name}: rms {found.rms_m_s:.4f} [{low:.4f}, {high:.4f}] m/s in {found.passes} passes")
    for warning in case.warnings:
        run.watcher.note(f"warning: {name}: {warning}")
    for remark in case.remarks:
        run.watcher.note(f"{name}: {remark}")
    return case


def case_failed(run: TuneRun[Case], case: FailedCase) -> FailedCase:
    """A case without a table, told of."""
    run.watcher.done(case.sentence)
    return case
