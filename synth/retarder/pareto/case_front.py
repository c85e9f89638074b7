"""The tables of several prices of a second, solved together, each simulated on the same passes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from synth.problem.aim import Aim
from synth.retarder.attempted_case import attempted
from synth.retarder.class_setup import ClassSetup
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import FailedCase
from synth.retarder.pareto.pareto_front import PRICES_M2_S3, ParetoFront, ParetoPoint
from synth.retarder.tuned_table import solutions, tuned_table
from synth.simulation.closed_loop import TableController
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.solver.backward_induction import Solution

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
