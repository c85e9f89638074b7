"""Surfaces for a regulator that may command at every sample and compares the estimated speed with them.

They are designed as lines are (`estimated_table`), for the friction of any day, and trimmed in the closed loop on the
tuning days. But the error of the estimate is not taken for white: a regulator that is asked at every sample would count
on the next sample to take it away. What hidden friction and resistance shift of the estimate is known to the design.
"""

from __future__ import annotations

from dataclasses import replace

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.any_time_resolution import design_resolution
from synth.problem.resolution import Resolution
from synth.retarder.any_time.surface_table import polished_surfaces, starting_surfaces, trial_table
from synth.retarder.estimation.estimate_chain import RESERVE_NODES, on_any_day
from synth.retarder.estimation.estimated_table import EstimatedTable, Trim, Untrimmed
from synth.retarder.estimation.estimator_design import error_of_estimate
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.random_passes import RandomPasses
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.surface_polish import opened
from synth.solver.descent import Descent
from synth.solver.polynomial_lines import PolynomialLines
from tuning_tables.estimator import Estimator

ERROR_PASSES = 300
"""Passes on which the error of the estimate is found."""

LEAST_NOISE = 0.5
"""The noise is taken for no less than this share of the whole error: a smaller one would ask for a finer grid. With
0.5, and a grid for it, the rms of 22, 36 and 52 t to 3 m/s is the same within 2 %."""

TRIM_TERMS, TRIM_EVALUATIONS = 3, 100
"""Surfaces are asked far oftener than lines, so what is not white in the error moves them more, and not everywhere
alike: with two shifts 22 t to 2 m/s has 0.89 of the rms of the default table, with parabolas of the path 0.77."""

RESISTANCES = 2
"""Values of the running resistance, at least."""


def estimated_surfaces(
    plant: Plant, aim: Aim, made: EstimatedTable[PolynomialLines], has_gauge: bool, tuning: RandomPasses
) -> tuple[Descent[PolynomialSurfaces], Untrimmed[PolynomialSurfaces]]:
    """How surfaces were polished from the lines that were `made` for the estimator and commands at rest; and these, to
    be trimmed. `tuning`: passes on which the error of the estimate is found.
    """
    target_m_s = aim.target_speed_m_s
    start = starting_surfaces(plant, made.lines, has_gauge)

    def controller(surfaces: PolynomialSurfaces, estimator: Estimator) -> TableController:
        return TableController(trial_table(plant, surfaces, target_m_s, estimator))

    first = controller(start, made.estimator)
    loop = close_loop(plant, first.stages)
    draws = loop.draws(tuning.part(0, min(ERROR_PASSES, len(tuning))))
    error = error_of_estimate(loop, first, draws, LEAST_NOISE * made.error_m_s)
    steps = estimate_resolution(plant, target_m_s, made.error_m_s)
    polish = polished_surfaces(on_any_day(plant), aim, start, steps, error)
    criterion = aim.criterion
    prices = criterion.switching_tolerance_m2_s2, criterion.time_price_m2_s3, criterion.terminal
    trim = Trim(TRIM_TERMS, TRIM_EVALUATIONS, *prices)
    return polish, Untrimmed(polish.best, made.estimator, made.error_m_s, controller, opened, trim)


def estimate_resolution(plant: Plant, target_m_s: float, error_m_s: float) -> Resolution:
    """The grid to design surfaces for a speed with an error of `error_m_s` on, for the friction of any day."""
    steps = design_resolution(plant, target_m_s, error_m_s=error_m_s)
    more = RESERVE_NODES if plant.friction.mean_cv > 0.0 else 0
    resistances = max(RESISTANCES, steps.resistance_nodes)
    return replace(steps, friction_nodes=steps.friction_nodes + more, resistance_nodes=resistances)
