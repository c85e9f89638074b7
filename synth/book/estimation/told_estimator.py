"""A regulator with an estimator that is told the friction of every cut."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Generic

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.speed_sensor import measured_speed_std
from synth.book.any_time.surface_table import trial_table
from synth.book.comparison.told_regulator import run_told
from synth.book.estimation.estimated_surfaces import ERROR_PASSES, LEAST_NOISE, estimate_resolution
from synth.book.estimation.estimated_table import EstimatedTable, Lines, controller_of, moved
from synth.book.estimation.estimator_design import error_of_estimate
from synth.simulation.closed_loop import Controller, TableController
from synth.simulation.common_passes import CommonPasses
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.sampled_chain import sampled_chain
from synth.solver.any_time.told_surfaces import told_surfaces
from synth.solver.chain.chain import Chain
from synth.solver.chain.speed_measurement import SmoothMeasurement
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.told_lines import told_lines
from tuning_tables.estimator import Estimator

LEVELLINGS = 2

BIAS_DEGREE, BIAS_WITHIN_M_S, BIAS_RANGE = 3, 0.3, (0.02, 0.98)
"""The mean error is taken as a cubic in ξ_cut, of cuts that leave near the target, held beyond these quantiles."""

LEAST_SPREAD, LEAST_PASSES = 0.01, 50
"""Of ξ_cut for a cubic, else a constant; and of passes for either."""


@dataclass(frozen=True)
class Bias:
    """The mean error at the exit, m/s: a polynomial in ξ_cut, highest power first, constant beyond `low` and `high`."""

    low: float
    high: float
    series: tuple[float, ...] = (0.0,)

    def at(self, factor: float) -> float:
        """The error of cuts with this friction factor."""
        return float(np.polyval(self.series, np.clip(factor, self.low, self.high)))

    def and_of(self, factor: NDArray[np.float64], error_m_s: NDArray[np.float64]) -> Bias:
        """With the mean of what is left, by passes with these factors and errors, (n,) each."""
        degree = BIAS_DEGREE if self.high - self.low > LEAST_SPREAD else 0
        left = np.polyfit(np.clip(factor, self.low, self.high), error_m_s, degree)
        return replace(self, series=tuple(np.polyadd(self.series, left).tolist()))


@dataclass(frozen=True)
class ToldWithEstimator(Generic[Lines]):
    """Lines and an estimator for each friction; all lines are moved by the mean error at the exit.

    `controller`: the regulator that compares the speed of an estimator with lines.
    """

    lines: Callable[[float], Lines]
    estimator: Estimator
    controller: Callable[[Lines, Estimator], Controller]
    bias: Bias

    def __call__(self, factor: float) -> Controller:
        shift = -self.bias.at(factor)
        return self.controller(moved(self.lines(factor), ((shift, shift),)), knowing(self.estimator, factor))


def told_with_estimator(
    made: EstimatedTable[PolynomialLines],
    design: Chain,
    curvature: NDArray[np.float64],
    tuning: CommonPasses,
    target_m_s: float,
) -> Sequence[ToldWithEstimator[PolynomialLines]]:
    """Two regulators with the table's estimator, told the friction: with lines polished for it, and with the table's.

    `design`: the grid for estimated speeds; `tuning`: passes on which the lines are levelled.
    """
    seen = replace(design, measurement=SmoothMeasurement(measured_speed_std(made.error_m_s, 0.0)))
    polished = told_lines(seen, target_m_s, made.lines, curvature)
    return [
        levelled(ToldWithEstimator(lines, made.estimator, controller_of, no_bias(tuning)), tuning, target_m_s)
        for lines in (polished.at, lambda _: made.lines)
    ]


def told_with_estimator_at_any_time(
    plant: Plant, made: EstimatedTable[PolynomialSurfaces], tuning: CommonPasses, target_m_s: float
) -> Sequence[ToldWithEstimator[PolynomialSurfaces]]:
    """The same two with surfaces, polished for the error that the estimator has where it knows the friction."""

    def controller(surfaces: PolynomialSurfaces, estimator: Estimator) -> TableController:
        return TableController(trial_table(plant, surfaces, target_m_s, estimator))

    first = controller(made.lines, knowing(made.estimator, 1.0))
    loop, passes = tuning.loop(first.stages), tuning.passes
    draws = loop.draws(passes.part(0, min(ERROR_PASSES, len(passes))), cut_factor=1.0)
    error = error_of_estimate(loop, first, draws, LEAST_NOISE * made.error_m_s)
    design = sampled_chain(plant, estimate_resolution(plant, target_m_s, made.error_m_s))
    polished = told_surfaces(replace(design, estimate=error), target_m_s, made.lines)
    return [
        levelled(ToldWithEstimator(lines, made.estimator, controller, no_bias(tuning)), tuning, target_m_s)
        for lines in (polished.at, lambda _: made.lines)
    ]


def knowing(estimator: Estimator, factor: float) -> Estimator:
    """The same estimator where ξ_cut is known: the brake's work is that of this friction, and nothing is left to learn.

    What friction does along the path stays unknown to it.
    """
    work = tuple(factor * each for each in estimator.brake_m2_s2_per_kpa)
    return replace(estimator, friction_cv=0.0, brake_m2_s2_per_kpa=work)


def no_bias(tuning: CommonPasses) -> Bias:
    """None yet, between quantiles of the friction of these passes."""
    low, high = np.quantile(tuning.draws.cut_factor, BIAS_RANGE).tolist()
    return Bias(low, high)


def levelled(told: ToldWithEstimator[Lines], tuning: CommonPasses, target_m_s: float) -> ToldWithEstimator[Lines]:
    """The regulator with its mean error at each friction taken out on the passes `tuning`."""
    factor = tuning.draws.cut_factor
    for _ in range(LEVELLINGS):
        error = run_told(tuning.loop, tuning.draws, told).exit_speed_m_s - target_m_s
        near = np.abs(error) < BIAS_WITHIN_M_S
        if near.sum() >= LEAST_PASSES:
            told = replace(told, bias=told.bias.and_of(factor[near], error[near]))
    return told
