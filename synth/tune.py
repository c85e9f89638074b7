"""The main job: a whole table book from a resolved configuration."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from synth.backward_induction import solve_all
from synth.case_result import CaseResult, DegreeStudy
from synth.closed_loop import close_loop
from synth.friction_bound import friction_known_bounds
from synth.grid import finer_for_check, require_memory
from synth.problem import Plant, Problem
from synth.random_passes import RandomPasses, random_passes
from synth.resolved_config import ResolvedConfig
from synth.transitions import as_published, check_transitions, persistent_transitions
from synth.tune_case import CaseOrder, degree_study, tune_case
from tuning_tables import ControllerTable, Generator, read_json, write_json

DEGREES = (1, 2, 3, 4, 5, 6)
TUNING_PASSES = 800
MOST_COMPARED_PASSES = 50_000
"""Passes kept in memory for the comparison of controllers; more are for `validate`."""

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Book:
    """Result of a tune: all cases and the degree studies, classes in the order of the configuration."""

    config: ResolvedConfig
    created: str
    cases: tuple[CaseResult, ...]
    degree_studies: tuple[DegreeStudy, ...]


def tune(config: ResolvedConfig, tables: Path, progress: Progress, workers: int = 2) -> Book:
    """Tune every cut class and target of `config`; the tables are written into the directory `tables`.

    Classes run on `workers` threads (the kernels release the interpreter); the result does not depend on how
    many. `progress` is told a sentence whenever a case is done.
    """
    plants = config.plants()
    for label, plant in plants:
        require_memory(label, plant, config.resolution, workers)
    created = creation_time()
    passes = random_passes(config.validation.seed, 0, min(config.validation.passes, MOST_COMPARED_PASSES))
    tuning = random_passes(config.validation.seed + 1, 0, TUNING_PASSES)
    generator = Generator("retarder-synth", version("retarder-synth"), config.sha256)
    heaviest_first = sorted(range(len(plants)), key=lambda i: -plants[i][1].top_stage * plants[i][1].cut.mass_t)

    def one_class(index: int) -> tuple[tuple[CaseResult, ...], tuple[DegreeStudy, ...]]:
        label, plant = plants[index]
        studied = index == len(plants) // 2
        return tune_class(config, label, plant, studied, passes, tuning, generator, created, tables, progress)

    with ThreadPoolExecutor(max_workers=workers) as pool:
        done = dict(zip(heaviest_first, pool.map(one_class, heaviest_first), strict=True))
    cases = tuple(case for i in range(len(plants)) for case in done[i][0])
    return Book(config, created, cases, tuple(study for i in range(len(plants)) for study in done[i][1]))


def tune_class(
    config: ResolvedConfig, label: str, plant: Plant, studied: bool, passes: RandomPasses, tuning: RandomPasses,
    generator: Generator, created: str, tables: Path, progress: Progress,
) -> tuple[tuple[CaseResult, ...], tuple[DegreeStudy, ...]]:  # fmt: skip
    """All targets of one cut class; with `studied` also the degree study of its middle target."""
    targets, criterion = config.targets_m_s, config.criterion
    design = persistent_transitions(plant, config.resolution)
    check = check_transitions(plant, finer_for_check(config.resolution))
    priced = [(target, criterion) for target in targets]
    free = [(target, replace(criterion, switching_tolerance_m2_s2=0.0)) for target in targets]
    both = solve_all(design, priced + free)
    solutions, plain = both[: len(targets)], both[len(targets) :]
    published = solve_all(as_published(design), priced)
    bounds = friction_known_bounds(design, targets, criterion, passes, config.acceptance.rms_m_s)
    draws = close_loop(plant, plant.top_stage + 1).draws(passes)
    results = []
    for i, target in enumerate(targets):
        order = CaseOrder(
            label=label,
            problem=Problem(plant, target, criterion),
            solution=solutions[i],
            plain=plain[i],
            published=published[i],
            known=bounds[i][0],
            feasibility=bounds[i][1],
            check=check,
            degree=config.fit.degree,
            passes=passes,
            draws=draws,
            tuning=tuning,
            generator=generator,
            created=created,
            store=lambda table: write_and_read_back(table, tables),
        )
        results.append(tune_case(order))
        figures = results[-1].comparison[0].statistics
        progress(f"{label} to {target:g} m/s: rms {figures.rms_m_s:.3f} m/s in {figures.passes} simulated passes")
    studies: tuple[DegreeStudy, ...] = ()
    if studied:
        studies = (degree_study(solutions[len(targets) // 2], label, DEGREES),)
        progress(f"{label} to {targets[len(targets) // 2]:g} m/s: degree study done")
    return tuple(results), studies


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
