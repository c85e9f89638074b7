"""One case from problem to validated table: solve, fit, polish, export, predict, simulate, compare."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from synth.book.case_result import WITHOUT_ESTIMATOR, CaseResult, Indifference
from synth.book.comparison.baselines import tune_baselines
from synth.book.comparison.measured import Feasibility, Measured, independent_ratio
from synth.book.estimation.estimated_table import EstimatedTable, estimated_table
from synth.book.estimation.simulated_prediction import density_of, simulated_prediction
from synth.book.policy_map import policy_map
from synth.problem.criterion import Criterion
from synth.problem.problem import Problem
from synth.problem.requirement import FrictionRange, OverspeedLimit
from synth.problem.requirement_found import Finding
from synth.simulation.closed_loop import Controller, LineController, TableController
from synth.simulation.common_passes import CommonPasses
from synth.simulation.exit_statistics import ExitStatistics, brake_power, exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.backward_induction import Solution
from synth.solver.chain.transitions import Transitions
from synth.solver.chance_constraint import keep_overspeed_limit
from synth.solver.exit_density import ExitDensity
from synth.solver.policy_evaluation import commands, exit_density, occupancy_of
from synth.solver.polynomial_fit import Fit, PolynomialLines, fit_lines
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import UNPREDICTED, lines_of, prediction_of, tabulate
from synth.solver.tuned_lines import polished
from synth.solver.worst_case import guard_worst_case
from tuning_tables import ControllerTable, Generator, Validated

TRACE_FACTORS = (0.8, 1.0, 1.2)
INDIFFERENCE_SHOWN_M2_S2 = 1e-4
"""Costs that differ by less than (1 cm/s)² are drawn as equal."""


@dataclass(frozen=True)
class EstimatorOrder:
    """A grid for estimated speeds, passes to find error and trim on, and others to predict from."""

    design: Transitions
    tuning: RandomPasses
    prediction: CommonPasses


@dataclass(frozen=True)
class CaseOrder:
    """What to do for one case, and with what; `store` writes a table and reads it back from its file.

    `solution` on the design grid, `plain` the same without the switching tolerance, `published` in the formulation
    as published; `check` the finer grid to predict on; `passes` that every controller is compared on, `tuning` others
    that baselines are tuned on; `estimator`: what is needed to design for one, None without.
    """

    label: str
    problem: Problem
    solution: Solution
    plain: Solution
    published: Solution
    known: Measured
    feasibility: Feasibility
    check: Transitions
    degree: int
    passes: CommonPasses
    tuning: CommonPasses
    generator: Generator
    created: str
    store: Callable[[ControllerTable], ControllerTable]
    estimator: EstimatorOrder | None = None

    @property
    def table_id(self) -> str:
        """Name of the case's table, also as a file name."""
        return f"{self.label}-to-{self.problem.target_speed_m_s:g}-m-s"


def tune_case(order: CaseOrder) -> CaseResult:
    """Tune one case; the table is validated as read back from its file."""
    problem, solution, target = order.problem, order.solution, order.problem.target_speed_m_s
    design, published = solution.transitions, order.published
    by_lines, occupancy = occupancy_of(design, commands(design, solution.lines, staircase=False))
    fit = fit_lines(solution, occupancy.samples, order.degree)
    lines, finding = required(design, order.check, fit, target, problem.criterion)
    made = None
    if order.estimator is not None:
        made = estimated_table(problem, order.estimator.design, lines, order.estimator.tuning)
    if order.estimator is not None and made is not None and made.gains:
        table, predicted = predicted_by_passes(order, made, order.estimator)
    else:
        table, predicted = predicted_table(order, lines)
    table = order.store(table)
    sample = order.passes.run(TableController(table))
    statistics = exit_statistics(sample, target)
    validated = Validated(statistics.passes, statistics.rms_m_s, statistics.rms_ci95_m_s)
    table = order.store(table.with_validated(validated))
    nodes = np.linspace(0.0, problem.plant.exit_m, 301)
    return CaseResult(
        label=order.label,
        plant=problem.plant,
        target_speed_m_s=target,
        table=table,
        table_lines=lines_of(table, nodes),
        solver_lines=solution.lines,
        policy_map=policy_map(solution, INDIFFERENCE_SHOWN_M2_S2),
        predicted=predicted,
        published_predicted_rms_m_s=rms_of_lines(published.transitions, published.lines, target),
        exit_speeds_m_s=sample.exit_speed_m_s.astype(np.float32),
        exit_weight=sample.weight,
        brake_power=brake_power(sample, order.passes.at_full_brake, target),
        comparison=(
            Measured("table", statistics, table.predicted.rms_m_s, table.predicted.passes),
            run(order, "full lines", LineController(solution.lines), sample),
            run(order, "as published", LineController(published.lines), sample),
            beside(order.known, statistics),
            *(run(order, b.name, b.controller, sample) for b in tune_baselines(order.tuning, target)),
            *(() if made is None else (run(order, WITHOUT_ESTIMATOR, LineController(lines.at(nodes)), sample),)),
        ),
        indifference=indifference(order, by_lines),
        feasibility=order.feasibility,
        traces=tuple(order.passes.trace(TableController(table), i, factor) for i, factor in enumerate(TRACE_FACTORS)),
        trace_factors=TRACE_FACTORS,
        criterion=problem.criterion,
        finding=finding,
        estimate=made,
    )


def required(
    design: Transitions, check: Transitions, fit: Fit, target_speed_m_s: float, criterion: Criterion
) -> tuple[PolynomialLines, Finding | None]:
    """The polished lines that keep what the criterion requires, and what that took."""
    lines = polished(design, fit, target_speed_m_s, criterion)
    match criterion.requirement:
        case OverspeedLimit() as limit:
            return keep_overspeed_limit(design, check, lines, fit, target_speed_m_s, criterion, limit)
        case FrictionRange() as friction:
            return guard_worst_case(design, check, lines, fit, target_speed_m_s, criterion, friction)
        case None:
            return lines, None


def predicted_table(order: CaseOrder, lines: PolynomialLines) -> tuple[ControllerTable, ExitDensity]:
    """The rounded table with the exact prediction of itself, sensor quantisation included."""
    plant, target = order.problem.plant, order.problem.target_speed_m_s
    origin = (order.generator, order.table_id, order.created)
    return with_prediction(order.check, tabulate(plant, lines, target, UNPREDICTED, *origin))


def predicted_by_passes(
    order: CaseOrder, made: EstimatedTable, estimator: EstimatorOrder
) -> tuple[ControllerTable, ExitDensity]:
    """The rounded table for the estimated speed, with what passes that nothing else uses say of it."""
    plant, target = order.problem.plant, order.problem.target_speed_m_s
    origin = (order.generator, order.table_id, order.created)
    table = tabulate(plant, made.lines, target, UNPREDICTED, *origin, made.estimator)
    sample = estimator.prediction.run(TableController(table))
    density = density_of(sample, estimator.design.grid.speed_m_s)
    return replace(table, predicted=simulated_prediction(sample, target)), density


def with_prediction(check: Transitions, table: ControllerTable) -> tuple[ControllerTable, ExitDensity]:
    """`table` with the figures of its exit-speed density on `check`, and the density."""
    density = predict(check, table)
    return replace(table, predicted=prediction_of(density, table.target_speed_m_s)), density


def predict(check: Transitions, table: ControllerTable) -> ExitDensity:
    """Exit-speed density of an exported table on `check`."""
    lines = lines_of(table, check.grid.path_m)
    stages = check.actuator.stages
    used = SwitchingLines(lines.nodes_m, lines.lower_m_s[:stages], lines.upper_m_s[:stages])
    return exit_density(check, commands(check, used, staircase=True))


def run(order: CaseOrder, name: str, controller: Controller, table: ExitSample) -> Measured:
    """Closed loop of `controller` on the common passes, as figures; `table`: how the table fares on them."""
    sample, target = order.passes.run(controller), order.problem.target_speed_m_s
    found = exit_statistics(sample, target)
    if found.rms_m_s == 0.0:
        return Measured(name, found)
    ratio, ci95 = rms_ratio(table, sample, target)
    return Measured(name, found, table_ratio=ratio, table_ratio_ci95=ci95)


def beside(known: Measured, table: ExitStatistics) -> Measured:
    """The friction-known reference with the ratio of the table to it."""
    ratio, ci95 = independent_ratio(table, known.statistics)
    return replace(known, table_ratio=ratio, table_ratio_ci95=ci95)


def rms_of_lines(transitions: Transitions, lines: SwitchingLines, target_speed_m_s: float) -> float:
    """What a formulation itself predicts for its own lines."""
    return exit_density(transitions, commands(transitions, lines, staircase=True)).rms_m_s(target_speed_m_s)


def indifference(order: CaseOrder, with_it: ExitDensity) -> Indifference:
    """Predicted switchings and rms of the solver's lines with the tolerance, and of lines solved without it."""
    design, target = order.solution.transitions, order.problem.target_speed_m_s
    without = exit_density(design, commands(design, order.plain.lines, staircase=False))
    return Indifference(
        tolerance_m2_s2=order.problem.criterion.switching_tolerance_m2_s2,
        switchings_without=without.switchings,
        switchings_with=with_it.switchings,
        rms_without_m_s=without.rms_m_s(target),
        rms_with_m_s=with_it.rms_m_s(target),
    )
