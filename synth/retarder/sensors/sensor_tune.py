"""Tables for point sensors from a resolved configuration: every cut class and target, simulated as read back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from plant_models import Plant
from synth.frame.creation_time import creation_time
from synth.problem.aim import Aim
from synth.retarder.attempted_case import attempted
from synth.retarder.class_setup import Origin, origin_of, validation_passes
from synth.retarder.configuration.point_sensors.resolved_sensors import ResolvedSensors
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import FailedCase, parted
from synth.retarder.sensors.passage_table import passage_table
from synth.retarder.sensors.sensor_case import HeardShares, SensorCase
from synth.retarder.sensors.sensor_class import SensorClass, SensorPasses, sensor_class
from synth.retarder.sensors.tuned_passages import tuned_passages
from synth.retarder.watcher import Watcher
from synth.retarder.work_queue import run_nested
from synth.simulation.exit_statistics import brake_power, exit_statistics
from synth.simulation.passage_controller import of_table
from synth.simulation.passage_sample import (
    DECIDED,
    NO_DECISION,
    NOT_BELIEVED,
    NOT_HEARD,
    UNFINISHED,
    PassageSample,
    unfinished_shares,
)
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import share_of
from synth.simulation.unavoidable_error import UnavoidableError, unavoidable_error
from synth.solver.one_blas_thread import one_blas_thread
from tuning_tables import Validated
from tuning_tables.passages.passage_table import PassageTable

TRACE_FACTORS = (0.8, 1.0, 1.2)

Store = Callable[[PassageTable], PassageTable]
"""Keeps a table, and gives it back as a controller will read it."""


@dataclass(frozen=True)
class SensorBook:
    """Result of a tune for point sensors: all cases, classes in the order of the configuration.

    `failed`: cases without a table, which are not among `cases`.
    """

    config: ResolvedConfig
    sensors: ResolvedSensors
    created: str
    cases: tuple[SensorCase, ...]
    failed: tuple[FailedCase, ...] = ()


@dataclass(frozen=True)
class SensorRun:
    """What all classes share; `watcher` is told a sentence whenever a case has ended."""

    config: ResolvedConfig
    sensors: ResolvedSensors
    origin: Origin
    passes: RandomPasses
    store: Store
    watcher: Watcher


@one_blas_thread()
def tune_sensors(
    config: ResolvedConfig, sensors: ResolvedSensors, store: Store, watcher: Watcher, workers: int = 2
) -> SensorBook:
    """Tune every cut class and target of `config` for `sensors`; each table is handed to `store` when it is made.

    Work runs on `workers` threads; the result does not depend on how many. A case that no table can be made for is told
    of in the book, and the others are made.
    """
    run = SensorRun(
        config=config,
        sensors=sensors,
        origin=origin_of(config.sha256, creation_time()),
        passes=validation_passes(config),
        store=store,
        watcher=watcher,
    )
    starts = [partial(class_tasks, run, label, plant) for label, plant in config.plants()]
    results = run_nested(starts, workers)
    cases, failed = parted(case for cases in results for case in cases)
    return SensorBook(config, sensors, run.origin.created, cases, failed)


def class_tasks(run: SensorRun, label: str, plant: Plant) -> list[Callable[[], SensorCase | FailedCase]]:
    """Prepare a class; a task for each of its targets."""
    config, targets = run.config, run.config.targets_of(label)
    prepare = partial(sensor_class, label, plant, run.sensors, config.resolution, run.passes, run.origin)
    setup = attempted(prepare, label, targets[0], config)
    if isinstance(setup, FailedCase):
        return [partial(case_failed, run, replace(setup, target_m_s=target)) for target in targets]
    return [partial(case_task, run, setup, Aim(target, config.criterion)) for target in targets]


def case_task(run: SensorRun, setup: SensorClass, aim: Aim) -> SensorCase | FailedCase:
    """One case tuned, and told of."""
    make = partial(sensor_case, setup, aim, run.store)
    case = attempted(make, setup.label, aim.target_speed_m_s, run.config)
    if isinstance(case, FailedCase):
        return case_failed(run, case)
    found = case.statistics
    low, high = found.rms_ci95_m_s
    told = f"{setup.label} to {aim.target_speed_m_s:g} m/s"
    run.watcher.done(f"{told}: rms {found.rms_m_s:.4f} [{low:.4f}, {high:.4f}] m/s in {found.passes} passes")
    for warning in case.warnings:
        run.watcher.note(f"warning: {told}: {warning}")
    return case


def case_failed(run: SensorRun, case: FailedCase) -> FailedCase:
    """A case without a table, told of."""
    run.watcher.done(case.sentence)
    return case


def sensor_case(setup: SensorClass, aim: Aim, store: Store) -> SensorCase:
    """Tune one case; the table is simulated as read back from where it is stored, and stored with the figures."""
    tuned = tuned_passages(setup.chains, aim)
    table = passage_table(tuned, setup.origin.generator, setup.table_id(aim.target_speed_m_s), setup.origin.created)
    kept, target = store(table), aim.target_speed_m_s
    controller = of_table(kept, tracking=True)
    sample = setup.passes.run(controller)
    found = exit_statistics(sample, target)
    return SensorCase(
        label=setup.label,
        plant=setup.plant,
        sensors=setup.sensors,
        table=store(kept.with_validated(Validated(found.passes, found.rms_m_s, found.rms_ci95_m_s))),
        predicted=tuned.predicted,
        polish=tuned.polish,
        exit_speeds_m_s=sample.exit_speed_m_s.astype(np.float32),
        exit_weight=sample.weight,
        statistics=found,
        brake_power=brake_power(sample, setup.passes.at_full_brake, target),
        unavoidable=unavoidable(setup.passes, sample, target),
        heard=heard_shares(sample),
        traces=tuple(setup.passes.trace(controller, i, factor) for i, factor in enumerate(TRACE_FACTORS)),
        trace_factors=TRACE_FACTORS,
    )


def unavoidable(passes: SensorPasses, sample: ExitSample, target_m_s: float) -> UnavoidableError:
    """The error that no rule with these sensors avoids; `sample`: the passes under a table."""
    slowest = np.minimum(sample.exit_speed_m_s, passes.at_full_brake.exit_speed_m_s)
    return unavoidable_error(replace(sample, exit_speed_m_s=slowest), passes.released, target_m_s)


def heard_shares(sample: PassageSample) -> HeardShares:
    """Passages that found a change of stage unfinished, or were mistaken."""
    mistaken = []
    for outcome in sample.outcome.T:
        weight = np.where(outcome != NOT_HEARD, sample.weight, 0.0)
        nothing = (float("nan"), (float("nan"), float("nan")))
        lost = np.isin(outcome, (NOT_BELIEVED, NO_DECISION))
        mistaken.append(share_of(lost, weight) if weight.any() else nothing)
    outcomes = sample.outcome.T
    return HeardShares(
        tuple(unfinished_shares(sample)),
        tuple(mistaken),
        tuple(int(np.isin(outcome, (DECIDED, UNFINISHED)).sum()) for outcome in outcomes),
        tuple(int((outcome != NOT_HEARD).sum()) for outcome in outcomes),
    )
