"""The main job: a whole table book from a resolved configuration."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import partial
from importlib.metadata import version
from pathlib import Path

from plant_models import Plant, PlantError
from synth.book.case_result import CaseResult, DegreeStudy
from synth.book.comparison.friction_bound import friction_known_bounds
from synth.book.degree_study import degree_study, tables_by_degree
from synth.book.estimation.estimated_table import estimator_design
from synth.book.estimation.simulated_prediction import prediction_passes
from synth.book.tune_case import CaseOrder, EstimatorOrder, tune_case
from synth.book.work_queue import run_nested
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.problem import Problem
from synth.problem.resolution import finer_for_check
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import solve_all
from synth.solver.chain.grid import require_memory
from synth.solver.chain.transitions import as_published, check_transitions, persistent_transitions
from synth.solver.one_blas_thread import one_blas_thread
from tuning_tables import ControllerTable, Generator, read_json, write_json

DEGREES = (1, 2, 3, 4, 5, 6)
TUNING_PASSES = 600
PUBLISHED_LEVELS = 3

VALUES_KEPT = 1
"""Path nodes at which a case needs the values of its solution: the entrance."""

TRIM_PASSES = 3000

Progress = Callable[[str], None]
CaseDone = Callable[[CaseResult], None]


def no_notice(case: CaseResult) -> None:
    """Nobody wants to know of a finished case."""


class CaseError(Exception):
    """One case of a book cannot be computed; `case`: its class and target. The message says why."""

    def __init__(self, case: str, reason: str) -> None:
        super().__init__(reason)
        self.case = case


@contextmanager
def naming(label: str, target_m_s: float) -> Iterator[None]:
    """Within, a `PlantError` becomes a `CaseError` that names the case."""
    try:
        yield
    except PlantError as fault:
        raise CaseError(f"{label} to {target_m_s:g} m/s", str(fault)) from None


@dataclass(frozen=True)
class Book:
    """Result of a tune: all cases and the degree studies, classes in the order of the configuration."""

    config: ResolvedConfig
    created: str
    cases: tuple[CaseResult, ...]
    degree_studies: tuple[DegreeStudy, ...]


@one_blas_thread()
def tune(
    config: ResolvedConfig, tables: Path, progress: Progress, workers: int = 2, case_done: CaseDone = no_notice
) -> Book:
    """Tune every cut class and target of `config`; the tables are written into the directory `tables`.

    Work runs on `workers` threads (the kernels release the interpreter); the result does not depend on how
    many. `progress` is told a sentence whenever a case is done, `case_done` given its result.
    """
    plants = config.plants()
    for label, plant in plants:
        require_memory(label, plant, config.resolution, workers)
    created = creation_time()
    passes = stratified_passes(config.validation.seed, 0, config.validation.passes)
    tuning = random_passes(config.validation.seed + 1, 0, TUNING_PASSES)
    generator = Generator("retarder-synth", version("retarder-synth"), config.sha256)
    heaviest_first = sorted(range(len(plants)), key=lambda i: -plants[i][1].top_stage * plants[i][1].cut.mass_t)

    def start(index: int) -> Callable[[], list[Callable[[], CaseResult | DegreeStudy]]]:
        label, plant = plants[index]
        studied = index == heaviest_first[-1]
        return lambda: class_tasks(
            config, label, plant, studied, passes, tuning, generator, created, tables, progress, case_done
        )  # fmt: skip

    found = run_nested([start(index) for index in heaviest_first], workers)
    by_class = dict(zip(heaviest_first, found, strict=True))
    results = [result for index in range(len(plants)) for result in by_class[index]]
    return Book(
        config,
        created,
        tuple(result for result in results if isinstance(result, CaseResult)),
        tuple(result for result in results if isinstance(result, DegreeStudy)),
    )


def class_tasks(
    config: ResolvedConfig, label: str, plant: Plant, studied: bool, passes: RandomPasses, tuning: RandomPasses,
    generator: Generator, created: str, tables: Path, progress: Progress, case_done: CaseDone,
) -> list[Callable[[], CaseResult | DegreeStudy]]:  # fmt: skip
    """Solve all targets of one cut class together; returns what is left to do for each, as tasks.

    With `studied` the degree study of the first target comes first, because it takes longest.
    """
    targets, criterion = config.targets_m_s, config.criterion
    design = persistent_transitions(plant, config.resolution)
    check = check_transitions(plant, finer_for_check(config.resolution))
    priced = [(target, criterion) for target in targets]
    free = [(target, replace(criterion, switching_tolerance_m2_s2=0.0)) for target in targets]
    both = solve_all(design, priced + free, nodes_kept=VALUES_KEPT)
    solutions, plain = both[: len(targets)], both[len(targets) :]
    published = solve_all(as_published(design, PUBLISHED_LEVELS), priced, nodes_kept=VALUES_KEPT)
    bounds = friction_known_bounds(design, targets, criterion.squared(), passes, config.acceptance.rms_m_s)
    compared = common_passes(plant, passes)
    rehearsal = compared.of_others(tuning)
    estimator = estimator_order(config, label, compared) if config.regulator.estimator else None

    def case(i: int) -> CaseResult:
        order = CaseOrder(
            label=label,
            problem=Problem(plant, targets[i], criterion),
            solution=solutions[i],
            plain=plain[i],
            published=published[i],
            known=bounds[i][0],
            feasibility=bounds[i][1],
            check=check,
            degree=config.fit.degree,
            passes=compared,
            tuning=rehearsal,
            generator=generator,
            created=created,
            store=lambda table: write_and_read_back(table, tables),
            estimator=estimator,
        )
        with naming(label, targets[i]):
            result = tune_case(order)
        case_done(result)
        figures = result.comparison[0].statistics
        low, high = figures.rms_ci95_m_s
        rms = f"rms {figures.rms_m_s:.4f} [{low:.4f}, {high:.4f}] m/s in {figures.passes} passes"
        told = f"{label} to {targets[i]:g} m/s: {rms}"
        progress(f"{told}; {result.left_out}" if result.left_out else told)
        if result.finding is not None:
            progress(f"{label} to {targets[i]:g} m/s: {result.finding.sentence}")
        return result

    def study() -> DegreeStudy:
        with naming(label, targets[0]):
            tables = tuple(tables_by_degree(solutions[0], DEGREES, generator, created))
            result = degree_study(solutions[0], check, label, tables)
        progress(f"{label} to {targets[0]:g} m/s: degree study done")
        return result

    tasks: list[Callable[[], CaseResult | DegreeStudy]] = [study] if studied else []
    return tasks + [partial(case, i) for i in range(len(targets))]


def estimator_order(config: ResolvedConfig, label: str, compared: CommonPasses) -> EstimatorOrder:
    """Grid and passes to design for the estimator of a plant; the passes are not those `compared`, nor anybody's."""
    seed = config.validation.seed
    return EstimatorOrder(
        design=estimator_design(compared.plant, config.resolution, min(config.targets_m_s)),
        tuning=random_passes(seed + 1, TUNING_PASSES, TUNING_PASSES + TRIM_PASSES),
        prediction=compared.of_others(prediction_passes(seed + 2, label)),
    )


def write_and_read_back(table: ControllerTable, directory: Path) -> ControllerTable:
    """The table as a controller will load it."""
    path = directory / f"{table.id}.json"
    write_json(table, path)
    return read_json(path)


def creation_time() -> str:
    """Now in UTC, or the time of SOURCE_DATE_EPOCH (which makes a run's files reproducible to the byte)."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    moment = datetime.fromtimestamp(int(epoch), UTC) if epoch else datetime.now(UTC)
    return moment.strftime("%Y-%m-%dT%H:%M:%SZ")
