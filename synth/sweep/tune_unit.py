"""The work of one unit: all targets of one cut class under one condition, from the problem to validated tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from typing import Any

import numpy as np

from plant_models import Plant, PlantError
from synth.book.judgement import judgement
from synth.book.tune_case import predict, required, with_prediction
from synth.configuration.resolved_config import ResolvedConfig, resolve
from synth.configuration.settings import Settings
from synth.problem.resolution import finer_for_check
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.exit_statistics import brake_power, exit_statistics, overspeed_of
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.transitions import Transitions, check_transitions, persistent_transitions
from synth.solver.one_blas_thread import one_blas_thread
from synth.solver.tabulate import UNPREDICTED, tabulate
from synth.solver.tuned_lines import fitted
from synth.sweep.plan import TARGETS_AT_ONCE, Refinement, UnitOrder
from synth.sweep.refinement import Bench, Gap, refined
from synth.sweep.unit_result import Refused, Row, UnitResult
from tuning_tables import ControllerTable, Generator, InvalidTable, Validated, from_json, to_json
from tuning_tables.active_table import between


@dataclass(frozen=True)
class Workshop:
    """What all targets of a unit share: grids, landings, passes and what the tables are stamped with."""

    order: UnitOrder
    config: ResolvedConfig
    plant: Plant
    design: Transitions
    check: Transitions
    passes: CommonPasses
    generator: Generator


@one_blas_thread()
def tune_unit(order: UnitOrder) -> UnitResult:
    """Tune a unit. A target that no table can be made for is refused and loses none but itself.

    Raises `PlantError` and others where nothing can be tuned, or where targets are to be refined and one of them is
    refused: its gaps could not be measured.
    """
    shop = workshop(order)
    refused: tuple[Refused, ...] = ()
    gaps: tuple[Gap, ...] = ()
    if order.refinement is None:
        tables, refused = tried(shop, shop.config.targets_m_s)
        if not tables:
            raise PlantError(refused[0].reason)
    else:
        tables, gaps = refined_tables(shop, order.refinement)
    rows = tuple(validated(shop, table) for table in tables)
    return UnitResult(order.key, order.condition, order.label, rows, gaps, refused)


def workshop(order: UnitOrder) -> Workshop:
    """Everything that does not depend on the target."""
    config = resolve(Settings.model_validate(order.tree), order.name)
    ((_, plant),) = config.plants()
    return Workshop(
        order=order,
        config=config,
        plant=plant,
        design=persistent_transitions(plant, config.resolution),
        check=check_transitions(plant, finer_for_check(config.resolution)),
        passes=common_passes(plant, stratified_passes(config.validation.seed, 0, config.validation.passes)),
        generator=Generator("retarder-synth", version("retarder-synth"), order.config_sha256),
    )


def refined_tables(shop: Workshop, wanted: Refinement) -> tuple[list[ControllerTable], tuple[Gap, ...]]:
    """The fewest tables that bisection finds for the loss that is wanted."""
    bench = Bench(
        tune=lambda targets: tables_for(shop, targets),
        own_rms_m_s=lambda table: table.predicted.rms_m_s,
        between_rms_m_s=lambda slower, faster, target: between_rms_m_s(shop.check, slower, faster, target),
    )
    return refined(shop.config.targets_m_s, bench, wanted)


def tables_for(shop: Workshop, targets_m_s: Sequence[float]) -> list[ControllerTable]:
    """Predicted tables for some targets, in their order; `PlantError` where one of them is refused."""
    tables, refused = tried(shop, targets_m_s)
    if refused:
        raise PlantError(refused[0].reason)
    return tables


def tried(shop: Workshop, targets_m_s: Sequence[float]) -> tuple[list[ControllerTable], tuple[Refused, ...]]:
    """Predicted tables for some targets, and those for which there is none, both in the order of the targets.

    A few are solved together, and then given up.
    """
    tables, refused = [], []
    for first in range(0, len(targets_m_s), TARGETS_AT_ONCE):
        aims = [(target, shop.config.criterion) for target in targets_m_s[first : first + TARGETS_AT_ONCE]]
        for solution in solve_all(shop.design, aims, nodes_kept=1):
            try:
                tables.append(predicted_table(shop, solution))
            except (PlantError, InvalidTable) as fault:
                refused.append(Refused(solution.target_speed_m_s, " ".join(str(fault).split())))
    return tables, tuple(refused)


def predicted_table(shop: Workshop, solution: Solution) -> ControllerTable:
    """The table of one solution: fitted, polished, rounded, and exactly predicted."""
    target, config = solution.target_speed_m_s, shop.config
    fit = fitted(solution, config.fit.degree)
    lines, _ = required(shop.design, shop.check, fit, target, config.criterion)
    label = f"{shop.order.condition}-{shop.order.label}" if shop.order.condition else shop.order.label
    name = f"{label}-to-{target:g}-m-s"
    table = tabulate(shop.plant, lines, target, UNPREDICTED, shop.generator, name, shop.order.created)
    return with_prediction(shop.check, table)[0]


def between_rms_m_s(check: Transitions, slower: ControllerTable, faster: ControllerTable, target_m_s: float) -> float:
    """Exactly predicted rms of the lines that a controller takes between two tables."""
    lines = between(slower, faster, np.float32(target_m_s))
    stages: list[Any] = []
    for stage, pair, present in zip(slower.stages, lines.coefficients, lines.has_line, strict=True):
        lower, upper = (tuple(map(float, line)) if here else None for line, here in zip(pair, present, strict=True))
        stages.append(replace(stage, lower=lower, upper=upper))
    table = replace(slower, target_speed_m_s=target_m_s, stages=tuple(stages))
    return predict(check, table).rms_m_s(target_m_s)


def validated(shop: Workshop, table: ControllerTable) -> Row:
    """The table as a controller reads it, simulated on the common passes."""
    read, target, limits = from_json(to_json(table)), table.target_speed_m_s, shop.config.acceptance
    sample = shop.passes.run(TableController(read))
    found = exit_statistics(sample, target)
    # In single precision, as a tune keeps them: both count the same passes.
    speeds = sample.exit_speed_m_s.astype(np.float32).astype(np.float64)
    over = overspeed_of(replace(sample, exit_speed_m_s=speeds), target, limits.overspeed_margin_m_s)
    power = brake_power(sample, shop.passes.at_full_brake, target)
    return Row(
        table=read.with_validated(Validated(found.passes, found.rms_m_s, found.rms_ci95_m_s)),
        simulated={**asdict(found), **asdict(power)},
        judgement=judgement(found, over, table.predicted, limits),
    )
