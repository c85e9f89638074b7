"""What the same plant reaches when the friction of every cut is known: the reference of regret.

The reference has what the table has: the same readings of the speed, made into an estimate where the table has an
estimator, one stage a command, no command before a transient has ended unless the table may give one, the same path. It
is told ξ_cut besides. It is a regulator that could be built, and it passes the cuts that the table passes; so no figure
of it rests on a grid. Its lines begin at the table's and are polished for each friction; with an estimator, which
learns the friction, they are the table's: lines polished for each friction were no better in any case of the default
book, as the table's meet a friction that the estimator has learnt. Where the table does better all the same, the
reference is the table: who is told the friction need not use it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import Floats
from synth.kernels.loop.passes import Draws
from synth.problem.resolution import design_resolution
from synth.retarder.checked_design import trial_table
from synth.retarder.class_setup import ClassSetup
from synth.retarder.estimation.estimated_table import EstimatedTable, controller_of, moved
from synth.retarder.tuned_table import TunedTable, ValidatedLines
from synth.simulation.closed_loop import ClosedLoop, Controller, LineController, TableController, picked
from synth.simulation.common_passes import CommonPasses
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import REPLICATE_PASSES
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.sampled_chain import sampled_chain
from synth.solver.any_time.surface_polish import told_surfaces
from synth.solver.switching_lines import PolynomialLines
from synth.solver.told_lines import ToldLines, told_lines
from tuning_tables.estimator import Estimator

Told = Callable[[float], Controller]
"""The controller for cuts of a friction factor ξ_cut."""

GROUPS = 24
"""Cuts are told their friction in groups: neighbours in ξ_cut get the controller for their mean. With 104 groups the
rms of the default book is the same within 0.7 %."""


LINE_NODES = 301


def by_lines(lines: ToldLines) -> Told:
    """The regulator that compares the measured speed with the lines for the friction."""
    nodes_m = lines.lines[0].nodes_m(LINE_NODES)
    return lambda factor: LineController(lines.at(factor).at(nodes_m))


def run_told(loop_of: Callable[[int], ClosedLoop], draws: Draws, told: Told, groups: int = GROUPS) -> ExitSample:
    """All passes of `draws`, each under the controller for its friction; `loop_of`(stages): the plant's closed loop."""
    order = np.argsort(draws.cut_factor, kind="stable")
    found: dict[str, NDArray[np.generic]] = {}
    for group in np.array_split(order, min(groups, len(order))):
        controller = told(float(draws.cut_factor[group].mean()))
        part = loop_of(controller.stages).run(controller, picked(draws, group))
        for field in fields(ExitSample):
            values = getattr(part, field.name)
            found.setdefault(field.name, np.empty(len(order), values.dtype))[group] = values
    return ExitSample(**found)  # type: ignore[arg-type]  # by name, each of its own type


def best_by_others(samples: Sequence[ExitSample], target_m_s: float) -> ExitSample:
    """The passes under whichever controller is best: what holds for one half of them is decided by the other half.

    `samples` are of the same passes. No pass has a part in the choice that it is judged by, so the choice makes no
    figure better than it is. Of equals, and where there is no other half, the first is taken.
    """
    squares = np.array([each.weight * (each.exit_speed_m_s - target_m_s) ** 2 for each in samples])
    odd = np.arange(squares.shape[1]) // REPLICATE_PASSES % 2 == 1
    by_odd, by_even = (samples[int(squares[:, half].sum(axis=1).argmin())] for half in (odd, ~odd))
    if by_odd is by_even:
        return by_odd
    names = [field.name for field in fields(ExitSample)]
    return ExitSample(**{name: np.where(odd, getattr(by_even, name), getattr(by_odd, name)) for name in names})


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


def friction_bound(setup: ClassSetup, tuned: TunedTable, validated: ValidatedLines) -> ExitSample:
    """The common passes under the reference of a table that was tuned and validated on `setup`."""
    regulators = told_regulators(setup, tuned, validated.table.target_speed_m_s)
    return bound_of(setup.passes, regulators, validated.sample, validated.table.target_speed_m_s)


def bound_of(passes: CommonPasses, regulators: Sequence[Told], sample: ExitSample, target_m_s: float) -> ExitSample:
    """`passes` under the best of `regulators` and of the table, of which their `sample` is there."""
    return best_by_others([*(run_told(passes.loop, passes.draws, each) for each in regulators), sample], target_m_s)


def told_regulators(setup: ClassSetup, tuned: TunedTable, target_m_s: float) -> Sequence[Told]:
    """Regulators of the table's kind that are told the friction; where that commands at any time, and one at rest."""
    told: list[Told] = []
    lines, surfaces = tuned.at_rest, tuned.at_any_time
    if setup.estimator is None or lines.estimate is None:
        if surfaces is not None:
            told.append(by_surfaces(setup.plant, target_m_s, surfaces.lines))
        return [*told, by_lines(told_lines(setup.design, target_m_s, lines.lines, tuned.design.fit.curvature))]
    tuning = setup.passes.of_others(setup.estimator.tuning)
    if surfaces is not None and surfaces.estimate is not None:
        told.append(told_with_estimator_at_any_time(setup.plant, surfaces.estimate, tuning, target_m_s))
    return [*told, told_with_estimator(lines.estimate, tuning, target_m_s)]


def by_surfaces(plant: Plant, target_m_s: float, common: PolynomialSurfaces) -> Told:
    """The regulator that compares the measured speed with surfaces for the friction, from those for all frictions."""
    design = sampled_chain(plant, design_resolution(plant, target_m_s))
    surfaces = told_surfaces(design, target_m_s, common)
    return lambda factor: TableController(trial_table(plant, surfaces.at(factor), target_m_s))
