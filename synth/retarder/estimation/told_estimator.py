"""A regulator with an estimator that is told the friction of every cut.

Its lines are the table's: an estimator that knows the friction is all that it has more. Lines polished for each
friction were no better in any case of the default book, as the table's meet a friction that the estimator has learnt.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats
from synth.retarder.any_time.surface_table import trial_table
from synth.retarder.comparison.told_regulator import run_told
from synth.retarder.estimation.estimated_table import EstimatedTable, controller_of, moved
from synth.simulation.closed_loop import Controller, TableController
from synth.simulation.common_passes import CommonPasses
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.polynomial_lines import PolynomialLines
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

    def and_of(self, factor: Floats, error_m_s: Floats) -> Bias:
        """With the mean of what is left, by passes with these factors and errors, (n,) each."""
        degree = BIAS_DEGREE if self.high - self.low > LEAST_SPREAD else 0
        left = np.polyfit(np.clip(factor, self.low, self.high), error_m_s, degree)
        return replace(self, series=tuple(np.polyadd(self.series, left).tolist()))


@dataclass(frozen=True)
class ToldWithEstimator:
    """The table's lines and an estimator that knows the friction; all lines are moved by the mean error at the exit.

    `controller`: (what the lines are moved by, m/s; the estimator) → the regulator.
    """

    estimator: Estimator
    controller: Callable[[float, Estimator], Controller]
    bias: Bias

    def __call__(self, factor: float) -> Controller:
        return self.controller(-self.bias.at(factor), knowing(self.estimator, factor))


def told_with_estimator(
    made: EstimatedTable[PolynomialLines], tuning: CommonPasses, target_m_s: float
) -> ToldWithEstimator:
    """The regulator of a table at rest, told the friction; `tuning`: passes on which its lines are levelled."""

    def controller(shift: float, estimator: Estimator) -> Controller:
        return controller_of(moved(made.lines, ((shift, shift),)), estimator)

    return levelled(ToldWithEstimator(made.estimator, controller, no_bias(tuning)), tuning, target_m_s)


def told_with_estimator_at_any_time(
    plant: Plant, made: EstimatedTable[PolynomialSurfaces], tuning: CommonPasses, target_m_s: float
) -> ToldWithEstimator:
    """The same with surfaces, for a table that commands at any time."""

    def controller(shift: float, estimator: Estimator) -> Controller:
        surfaces = moved(made.lines, ((shift, shift),))
        return TableController(trial_table(plant, surfaces, target_m_s, estimator))

    return levelled(ToldWithEstimator(made.estimator, controller, no_bias(tuning)), tuning, target_m_s)


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


def levelled(told: ToldWithEstimator, tuning: CommonPasses, target_m_s: float) -> ToldWithEstimator:
    """The regulator with its mean error at each friction taken out on the passes `tuning`."""
    factor = tuning.draws.cut_factor
    for _ in range(LEVELLINGS):
        error = run_told(tuning.loop, tuning.draws, told).exit_speed_m_s - target_m_s
        near = np.abs(error) < BIAS_WITHIN_M_S
        if near.sum() >= LEAST_PASSES:
            told = replace(told, bias=told.bias.and_of(factor[near], error[near]))
    return told
