"""The work of one unit: all targets of one cut class under one condition, from the problem to validated tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from plant_models import PlantError
from synth.problem.problem import Aim
from synth.retarder.class_setup import ClassSetup, class_setup, origin_of, validation_passes
from synth.retarder.comparison.measured import judgement
from synth.retarder.configuration.resolved_config import ResolvedConfig, resolve
from synth.retarder.configuration.settings import Settings
from synth.retarder.failed_case import FailedCase, attempted, parted
from synth.retarder.sweep.plan import TARGETS_AT_ONCE, Bench, Gap, Refinement, UnitOrder, refined
from synth.retarder.sweep.unit_result import Row, UnitResult
from synth.retarder.tuned_table import predict, read_back, solutions, tuned_table, validated_table
from synth.simulation.exit_statistics import overspeed_of
from synth.solver.backward_induction import Solution
from synth.solver.chain.chain import Chain
from synth.solver.descent import one_blas_thread
from tuning_tables import ControllerTable, Stage
from tuning_tables.active_table import between


@one_blas_thread()
def tune_unit(order: UnitOrder) -> UnitResult:
    """Tune a unit. A target that no table can be made for is refused and loses none but itself.

    Raises `PlantError` and others where nothing can be tuned, or where targets are to be refined and one of them is
    refused: its gaps could not be measured.
    """
    config, setup = setup_of(order)
    refused: tuple[FailedCase, ...] = ()
    gaps: tuple[Gap, ...] = ()
    if order.refinement is None:
        made, refused = tuned_tables(config, setup, config.targets_of(order.label))
        if not made:
            raise PlantError(refused[0].reason)
        tables = list(made)
    else:
        tables, gaps = refined_tables(config, setup, order.refinement)
    rows = tuple(row_of(config, setup, table) for table in tables)
    return UnitResult(order.key, order.condition, order.label, rows, gaps, refused)


def setup_of(order: UnitOrder) -> tuple[ResolvedConfig, ClassSetup]:
    """The configuration of a unit, and what its targets share."""
    config = resolve(Settings.model_validate(order.tree), order.name, order.library)
    ((_, plant),) = config.plants()
    stem = f"{order.condition}-{order.label}" if order.condition else order.label
    origin = origin_of(order.config_sha256, order.created)
    return config, class_setup(config, order.label, plant, validation_passes(config), origin, stem)


def refined_tables(
    config: ResolvedConfig, setup: ClassSetup, wanted: Refinement
) -> tuple[list[ControllerTable], tuple[Gap, ...]]:
    """The fewest tables that bisection finds for the loss that is wanted; `PlantError` where one of them is refused."""

    def tune(targets_m_s: Sequence[float]) -> list[ControllerTable]:
        tables, refused = tuned_tables(config, setup, targets_m_s)
        if refused:
            raise PlantError(refused[0].reason)
        return list(tables)

    bench = Bench(
        tune=tune,
        own_rms_m_s=lambda table: table.predicted.rms_m_s,
        between_rms_m_s=lambda slower, faster, target: between_rms_m_s(setup.check, slower, faster, target),
    )
    return refined(config.targets_of(setup.label), bench, wanted)


def tuned_tables(
    config: ResolvedConfig, setup: ClassSetup, targets_m_s: Sequence[float]
) -> tuple[tuple[ControllerTable, ...], tuple[FailedCase, ...]]:
    """Predicted tables for some targets, and those for which there is none, both in the order of the targets.

    A few are solved together, and then given up.
    """
    results = []
    for first in range(0, len(targets_m_s), TARGETS_AT_ONCE):
        aims = [Aim(target, config.criterion) for target in targets_m_s[first : first + TARGETS_AT_ONCE]]
        for solution in solutions(setup.design, aims):
            target = solution.aim.target_speed_m_s
            results.append(attempted(partial(table_of, setup, solution), setup.label, target, config))
    return parted(results)


def table_of(setup: ClassSetup, solution: Solution) -> ControllerTable:
    """The predicted table of one solution."""
    return tuned_table(setup, solution).table


def between_rms_m_s(check: Chain, slower: ControllerTable, faster: ControllerTable, target_m_s: float) -> float:
    """Exactly predicted rms of the lines that a controller takes between two tables."""
    lines = between(slower, faster, np.float32(target_m_s))
    stages: list[Any] = []
    for stage, pair, steep in zip(slower.stages, lines.coefficients, lines.slopes, strict=True):
        lower, upper = (
            None if line is None else tuple(map(float, taken)) for line, taken in zip(stage.lines, pair, strict=True)
        )
        slopes = (None if slope is None else float(taken) for slope, taken in zip(stage.slopes, steep, strict=True))
        stages.append(Stage(stage.k, stage.pressure_kpa, lower, upper, *slopes))
    table = replace(slower, target_speed_m_s=target_m_s, stages=tuple(stages))
    return predict(check, table).rms_m_s(target_m_s)


def row_of(config: ResolvedConfig, setup: ClassSetup, table: ControllerTable) -> Row:
    """The table as a controller reads it, simulated on the common passes, and judged."""
    found, limits = validated_table(setup, table, read_back), config.acceptance
    # In single precision, as a tune keeps them: both count the same passes.
    speeds = found.sample.exit_speed_m_s.astype(np.float32).astype(np.float64)
    counted = replace(found.sample, exit_speed_m_s=speeds)
    over = overspeed_of(counted, table.target_speed_m_s, limits.overspeed_margin_m_s)
    return Row(
        table=found.table,
        statistics=found.statistics,
        brake_power=found.brake_power,
        judgement=judgement(found.statistics, over, table.predicted, limits),
    )
