"""The main job: a whole table book from a resolved configuration."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from plant_models import Plant
from synth.frame.creation_time import creation_time
from synth.problem.aim import Aim
from synth.retarder.attempted_case import attempted
from synth.retarder.case_result import CaseResult
from synth.retarder.class_setup import TUNING_PASSES, Origin, class_setup, origin_of, validation_passes
from synth.retarder.comparison.served_entry import entry_sweep
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import FailedCase, require_none
from synth.retarder.off_nominal.trial import trials
from synth.retarder.pareto.case_front import pareto_front
from synth.retarder.pareto.pareto_front import ParetoFront, told
from synth.retarder.tune_case import CaseOrder, tune_case
from synth.retarder.tuned_table import Store, solutions
from synth.retarder.watcher import Watcher
from synth.retarder.work_queue import run_nested
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.solver.chain.grid import require_memory
from synth.solver.one_blas_thread import one_blas_thread

CaseDone = Callable[[CaseResult], None]


def no_notice(case: CaseResult) -> None:
    """Nobody wants to know of a finished case."""


@dataclass(frozen=True)
class Book:
    """Result of a tune: all cases, classes in the order of the configuration.

    `failed`: cases without a table, which are not among `cases`.
    """

    config: ResolvedConfig
    created: str
    cases: tuple[CaseResult, ...]
    failed: tuple[FailedCase, ...] = ()

    @property
    def whole(self) -> tuple[CaseResult, ...]:
        """All cases, for who needs every one; `PlantError` where one has no table."""
        require_none(self.failed)
        return self.cases

    @property
    def fronts(self) -> tuple[ParetoFront, ...]:
        """What less time in the position costs, by case, where that was asked for."""
        return tuple(case.front for case in self.cases if case.front is not None)

    @property
    def pareto_line(self) -> str:
        """The same in one line; nothing where nobody asked."""
        return told(self.fronts) if self.fronts else ""


@dataclass(frozen=True)
class TuneRun:
    """What all classes of a tune share.

    `passes`: that every table is validated on; `tuning`: that baselines are tuned on. `watcher` is told a sentence
    whenever a case has ended, `case_done` given its result if it has a table. With `pareto` each case also tells what
    less time costs.
    """

    config: ResolvedConfig
    origin: Origin
    passes: RandomPasses
    tuning: RandomPasses
    store: Store
    watcher: Watcher
    case_done: CaseDone
    pareto: bool


Task = Callable[[], CaseResult | FailedCase]


@one_blas_thread()
def tune(
    config: ResolvedConfig,
    store: Store,
    watcher: Watcher,
    workers: int = 2,
    case_done: CaseDone = no_notice,
    pareto: bool = False,
) -> Book:
    """Tune every cut class and target of `config`; each table is handed to `store` as soon as it is made.

    Work runs on `workers` threads (the kernels release the interpreter); the result does not depend on how
    many. `watcher` is told a sentence whenever a case has ended, `case_done` given its result. `pareto`: each case also
    tells what less time in the position costs. A case that no table can be made for is told of in the book, and the
    others are made.
    """
    plants = config.plants()
    for label, plant in plants:
        require_memory(label, plant, config.grids(plant), workers)
    run = TuneRun(
        config=config,
        origin=origin_of(config.sha256, creation_time()),
        passes=validation_passes(config),
        tuning=random_passes(config.validation.seed + 1, 0, TUNING_PASSES),
        store=store,
        watcher=watcher,
        case_done=case_done,
        pareto=pareto,
    )
    heaviest_first = sorted(range(len(plants)), key=lambda i: -plants[i][1].top_stage * plants[i][1].cut.mass_t)
    starts = [partial(class_tasks, run, *plants[i]) for i in heaviest_first]
    by_class = dict(zip(heaviest_first, run_nested(starts, workers), strict=True))
    results = [result for index in range(len(plants)) for result in by_class[index]]
    return Book(
        config,
        run.origin.created,
        tuple(result for result in results if isinstance(result, CaseResult)),
        tuple(result for result in results if isinstance(result, FailedCase)),
    )


def class_tasks(run: TuneRun, label: str, plant: Plant) -> list[Task]:
    """Solve all targets of one cut class together; returns what is left to do for each, as tasks."""
    targets = run.config.targets_of(label)
    orders = attempted(partial(case_orders, run, label, plant), label, targets[0], run.config)
    if isinstance(orders, FailedCase):
        return [partial(case_failed, run, replace(orders, target_m_s=target)) for target in targets]
    return [partial(case_task, run, order) for order in orders]


def case_orders(run: TuneRun, label: str, plant: Plant) -> list[CaseOrder]:
    """All targets of one cut class solved, and what is to be done with each."""
    config = run.config
    setup = class_setup(config, label, plant, run.passes, run.origin)
    aims = [Aim(target, config.criterion) for target in config.targets_of(label)]
    entries, rehearsal = entry_sweep(setup.passes), setup.passes.of_others(run.tuning)
    off_nominal = trials(setup.passes)
    fronts = [partial(pareto_front, config, setup, aim) if run.pareto else None for aim in aims]
    return [
        CaseOrder(setup, solution, entries, config.acceptance.rms_m_s, rehearsal, off_nominal, run.store, front)
        for solution, front in zip(solutions(setup.design, aims), fronts, strict=True)
    ]


def case_task(run: TuneRun, order: CaseOrder) -> CaseResult | FailedCase:
    """One case tuned, and told of."""
    label, target = order.setup.label, order.solution.aim.target_speed_m_s
    result = attempted(partial(tune_case, order), label, target, run.config)
    if isinstance(result, FailedCase):
        return case_failed(run, result)
    run.case_done(result)
    figures = result.comparison.table.statistics
    low, high = figures.rms_ci95_m_s
    rms = f"rms {figures.rms_m_s:.4f} [{low:.4f}, {high:.4f}] m/s in {figures.passes} passes"
    run.watcher.done(f"{label} to {target:g} m/s: {rms}")
    for warning in result.warnings:
        run.watcher.note(f"warning: {label} to {target:g} m/s: {warning}")
    if result.finding is not None:
        run.watcher.note(f"{label} to {target:g} m/s: {result.finding.sentence}")
    return result


def case_failed(run: TuneRun, case: FailedCase) -> FailedCase:
    """A case without a table, told of."""
    run.watcher.done(case.sentence)
    return case
