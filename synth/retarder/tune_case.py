"""One case of a tune: its table, and beside it everything that the table is compared with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from plant_models import Plant
from synth.problem.problem import Aim
from synth.retarder.case_result import PRICES_M2_S3, CaseResult, ParetoFront, ParetoPoint
from synth.retarder.class_setup import TUNING_PASSES, ClassSetup, class_setup
from synth.retarder.comparison.baselines import beside_table, best_law, compared_laws, permitted
from synth.retarder.comparison.friction_bound import friction_bound
from synth.retarder.comparison.measured import Comparison, Measured
from synth.retarder.comparison.served_entry import EntrySweep, entry_sweep, feasibility_of
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.epochs import Ground, Store
from synth.retarder.estimation.estimated_table import controller_of
from synth.retarder.failed_case import FailedCase, attempted
from synth.retarder.off_nominal_trials import Trials, trials
from synth.retarder.tuned_table import TunedTable, ValidatedLines, solutions, tuned_table, validated_table
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import CommonPasses
from synth.simulation.exit_statistics import exit_statistics, rms_ratio, unavoidable_error
from synth.simulation.passes import TRACE_FACTORS, ExitSample
from synth.simulation.random_passes import random_passes
from synth.solver.backward_induction import Solution, share_of_ties
from tuning_tables import ControllerTable

Front = Callable[[], ParetoFront]
"""Makes the front of a case."""


def pareto_front(config: ResolvedConfig, setup: ClassSetup, aim: Aim) -> ParetoFront:
    """The front of one case; each table is tuned, predicted and simulated as any."""
    aims = [replace(aim, criterion=replace(aim.criterion, time_price_m2_s3=price)) for price in PRICES_M2_S3]
    points: list[ParetoPoint] = []
    base = None
    for solution in solutions(setup.design, aims):
        made = attempted(partial(tuned_table, setup, solution), setup.label, aim.target_speed_m_s, config)
        if isinstance(made, FailedCase):
            continue
        sample = setup.passes.run(TableController(made.table))
        base = sample if base is None else base
        points.append(
            ParetoPoint(
                price_of(solution), exit_statistics(sample, aim.target_speed_m_s), made.table.predicted.rms_m_s,
                *rms_ratio(sample, base, aim.target_speed_m_s),
            )
        )  # fmt: skip
    return ParetoFront(setup.label, aim.target_speed_m_s, tuple(points))


def price_of(solution: Solution) -> float:
    """What a second costs in it."""
    return solution.aim.criterion.time_price_m2_s3


@dataclass(frozen=True)
class CaseOrder:
    """What to do for one case, and with what.

    `solution` on the design chain; `entries`: what the position can do by entry speed; `limit_m_s`: the rms that makes
    a case feasible; `tuning`: passes that baselines are tuned on; `trials`: those off nominal; `front`: where it is
    wanted, what makes the curve of accuracy against time.
    """

    setup: ClassSetup
    solution: Solution
    entries: EntrySweep
    limit_m_s: float
    tuning: CommonPasses
    trials: Trials
    store: Store[ControllerTable]
    front: Front | None


def case_orders(ground: Ground[ControllerTable], label: str, plant: Plant, pareto: bool) -> list[CaseOrder]:
    """All targets of one cut class solved, and what is to be done with each; `pareto`: front of each case too."""
    config = ground.config
    setup = class_setup(config, label, plant, ground.passes, ground.origin)
    aims = config.aims_of(label)
    rehearsal = setup.passes.of_others(random_passes(config.validation.seed + 1, 0, TUNING_PASSES))
    entries, off_nominal = entry_sweep(setup.passes), trials(setup.passes)
    fronts = [partial(pareto_front, config, setup, aim) if pareto else None for aim in aims]
    return [
        CaseOrder(setup, solution, entries, config.acceptance.rms_m_s, rehearsal, off_nominal, ground.store, front)
        for solution, front in zip(solutions(setup.design, aims), fronts, strict=True)
    ]


def tune_case(order: CaseOrder) -> CaseResult:
    """Tune one case; the table is validated as read back from where it is stored."""
    setup, solution, target = order.setup, order.solution, order.solution.aim.target_speed_m_s
    passes, exits = setup.passes, setup.passes.exit_range
    tuned = tuned_table(setup, solution)
    validated = validated_table(setup, tuned.table, order.store)
    controller, told = TableController(validated.table), friction_bound(setup, tuned, validated)
    return CaseResult(
        label=setup.label,
        plant=setup.plant,
        table=validated.table,
        predicted=tuned.predicted,
        polish=tuned.designed.polish,
        exit_speeds_m_s=validated.sample.exit_speed_m_s.astype(np.float32),
        exit_weight=validated.sample.weight,
        statistics=validated.statistics,
        brake_power=validated.brake_power,
        unavoidable=unavoidable_error(exits.slowest, exits.fastest, target),
        traces=tuple(passes.trace(controller, i, factor) for i, factor in enumerate(TRACE_FACTORS)),
        grid=tuned.design.grid,
        finding=tuned.design.kept.finding,
        estimate=tuned.designed.estimate,
        comparison=comparison(order, tuned, validated, told),
        feasibility=feasibility_of(order.entries, target, order.limit_m_s),
        ties=share_of_ties(solution),
        front=None if order.front is None else order.front(),
        off_nominal=order.trials.of(validated.table, validated.sample),
    )


def comparison(order: CaseOrder, tuned: TunedTable, validated: ValidatedLines, told: ExitSample) -> Comparison:
    """The closed loops of all controllers on the common passes; `told`: that of the reference."""
    passes, target, sample = order.setup.passes, order.solution.aim.target_speed_m_s, validated.sample
    laws = compared_laws(order.tuning, passes, sample, target, permitted(validated.table))

    def at_rest() -> Measured:
        controller = controller_of(tuned.at_rest.lines, validated.table.estimator)
        return beside_table("commands at rest", passes.run(controller), sample, target)

    return Comparison(
        friction_known=beside_table("friction known", told, sample, target),
        baselines=tuple(each.measured for each in laws),
        baseline_ratio_ci95=beside_table("", best_law(laws).sample, told, target).table_ratio_ci95,
        at_rest=None if tuned.at_any_time is None else at_rest(),
    )
