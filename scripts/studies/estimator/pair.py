"""Two tables of one case: for the measured speed and for the estimated one; and their figures on the same passes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from scripts.studies.cases import rounded
from synth.problem.problem import OVERSPEED_M_S, Problem
from synth.retarder.class_setup import TRIM_PASSES, trim_passes
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.estimation.estimated_lines import estimate_chain, estimated_lines
from synth.retarder.estimation.estimated_table import controller_of
from synth.retarder.estimation.estimator_design import decisions
from synth.retarder.estimation.tuning_days import tuning_days, tuning_row
from synth.simulation.closed_loop import ClosedLoop, Controller, TableController, close_loop, simulate
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import PATH_CELLS, RandomPasses
from synth.simulation.replicates import Interval, share_of
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.switching_lines import PolynomialLines
from synth.solver.tuned_lines import tuned_lines
from tuning_tables import Estimator

FRESH, TUNING = 15485863, 32452843
"""Added to the configured seed: passes for figures, and for the trim of lines without a price on switchings."""

ERROR_PASSES = 100
"""Passes on which the error of the estimate is found."""

Both = tuple[float, float]
"""Without estimator, with it."""


@dataclass(frozen=True)
class Pair:
    """Two controllers for one case and plant, for the measured speed and for the estimated one.

    `estimator` is that of the second; `error_m_s`: std of the error of its speed where it decides, in the closed loop.
    """

    plain: Controller
    estimated: Controller
    estimator: Estimator
    error_m_s: float

    def misled(self, gauge: float) -> Controller:
        """The second, whose pressure gauge shows `gauge` times the overpressure."""
        if gauge == 1.0:
            return self.estimated
        work = tuple(gauge * w for w in self.estimator.brake_m2_s2_per_kpa)
        wrong = replace(self.estimator, brake_m2_s2_per_kpa=work)
        if isinstance(self.estimated, TableController):
            return TableController(replace(self.estimated.table, estimator=wrong))
        return replace(self.estimated, estimator=wrong)


@dataclass(frozen=True)
class Compared:
    """Figures of both on the same passes; `ratio`: rms with estimator / without, paired; shares of all cuts."""

    rms_m_s: Both
    ratio: float
    ratio_ci95: Interval
    bias_m_s: Both
    switchings: Both
    outside: Both
    overspeed: Both
    stalled: Both


def as_tuned(problem: Problem, config: ResolvedConfig, label: str) -> Pair:
    """The tables that `tune` writes for the class `label` of `config`, rounded."""
    tuning = trim_passes(config.validation.seed, problem.plant)
    pair, lines, estimated = designed(problem, config, min(config.targets_of(label)), tuning)

    plant, target = problem.plant, problem.target_speed_m_s
    plain = TableController(rounded(config, plant, lines, target))
    return replace(
        pair, plain=plain, estimated=TableController(rounded(config, plant, estimated, target, pair.estimator))
    )


def without_price(problem: Problem, config: ResolvedConfig) -> Pair:
    """Lines, not rounded, without a price on switchings; the estimator made for this very target."""
    criterion = replace(problem.criterion, switching_tolerance_m2_s2=0.0)
    free = replace(problem, aim=replace(problem.aim, criterion=criterion))
    tuning = tuning_row(problem.plant.friction)(config.validation.seed + TUNING, 0, TRIM_PASSES, PATH_CELLS)
    return designed(free, config, problem.target_speed_m_s, tuning)[0]


def designed(
    problem: Problem, config: ResolvedConfig, lowest_target_m_s: float, tuning: RandomPasses
) -> tuple[Pair, PolynomialLines, PolynomialLines]:
    """(both, lines for the measured speed, lines for the estimated one)."""
    design = persistent_chain(problem.plant, config.resolution)
    lines = tuned_lines(design, problem.aim, config.fit.degree).best
    solution = solve(estimate_chain(problem.plant, config.resolution, lowest_target_m_s), problem.aim)
    days = tuning_days(problem.plant, tuning)
    _, made = estimated_lines(problem.plant, solution, config.fit.degree, tuning, days)
    plain, estimated = controller_of(lines, None), controller_of(made.lines, made.estimator)
    loop = close_loop(problem.plant, estimated.stages)
    error_m_s = speed_error_m_s(loop, estimated, tuning.part(0, min(ERROR_PASSES, len(tuning))))
    return Pair(plain, estimated, made.estimator, error_m_s), lines, made.lines


def speed_error_m_s(loop: ClosedLoop, controller: Controller, passes: RandomPasses) -> float:
    """Root mean square error of the speed that `controller` compares with its lines, where it decides."""
    squares, count = 0.0, 0.0
    for index, trace, decided in decisions(loop, controller, loop.draws(passes)):
        weight = float(passes.weight[index])
        squares += weight * float(((trace.measured_m_s - trace.speed_m_s)[decided] ** 2).sum())
        count += weight * int(decided.sum())
    return math.sqrt(squares / max(count, 1.0))


def compared(target_m_s: float, plain: ExitSample, estimated: ExitSample) -> Compared:
    """Two samples of the same passes, without estimator and with it."""
    samples = (plain, estimated)
    a, b = (exit_statistics(sample, target_m_s) for sample in samples)
    far = [np.abs(sample.exit_speed_m_s - target_m_s) > OVERSPEED_M_S for sample in samples]
    ratio, ci95 = rms_ratio(estimated, plain, target_m_s)
    return Compared(
        (a.rms_m_s, b.rms_m_s), ratio, ci95, (a.bias_m_s, b.bias_m_s), (a.switchings, b.switchings),
        (share_of(far[0], plain.weight)[0], share_of(far[1], plain.weight)[0]), (a.overspeed, b.overspeed),
        (a.stalled, b.stalled),
    )  # fmt: skip


def nominal(plant: Plant, target_m_s: float, pair: Pair, passes: RandomPasses) -> Compared:
    """Figures of both on the plant that they were designed for."""
    plain, estimated = (simulate(plant, each, passes) for each in (pair.plain, pair.estimated))
    return compared(target_m_s, plain, estimated)
