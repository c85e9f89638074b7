"""Surfaces for a regulator that may command at every sample and compares the estimated speed with them.

They are designed as lines are (`estimated_table`): for a sensor with the small, white error that the estimator was
found to have, for the friction of any day, and trimmed in the closed loop on the tuning days.
"""

from __future__ import annotations

from dataclasses import replace

from plant_models.speed_sensor import measured_speed_std
from synth.book.any_time.surface_table import polished_surfaces, starting_surfaces, trial_table
from synth.book.estimation.estimated_table import RESERVE_NODES, Design, EstimatedTable, fitted_to_days
from synth.problem.any_time_resolution import design_resolution
from synth.problem.problem import Problem
from synth.simulation.closed_loop import TableController
from synth.simulation.random_passes import RandomPasses
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.surface_polish import opened
from synth.solver.chain.speed_measurement import SmoothMeasurement
from synth.solver.polynomial_lines import PolynomialLines
from tuning_tables.estimator import Estimator


def estimated_surfaces(
    problem: Problem,
    made: EstimatedTable[PolynomialLines],
    measured: PolynomialSurfaces,
    tuning: RandomPasses,
) -> EstimatedTable[PolynomialSurfaces]:
    """Surfaces from the lines that were `made` for the estimator and commands at rest.

    `measured`: surfaces for the measured speed; kept where the design goes wrong. `tuning`: passes for the trim.
    """
    plant, aim = problem.plant, problem.aim
    of_any_day = replace(plant, friction=plant.friction.of_any_day)
    steps = design_resolution(plant, aim.target_speed_m_s, error_m_s=made.error_m_s)
    if plant.friction.mean_cv > 0.0:
        steps = replace(steps, friction_nodes=steps.friction_nodes + RESERVE_NODES)
    seen = SmoothMeasurement(measured_speed_std(made.error_m_s, 0.0))
    start = starting_surfaces(plant, made.lines, measured.has_slopes)
    designed = polished_surfaces(of_any_day, aim, start, steps, seen).surfaces

    def controller(surfaces: PolynomialSurfaces, estimator: Estimator | None) -> TableController:
        return TableController(trial_table(plant, surfaces, aim.target_speed_m_s, estimator))

    design = Design(designed, measured, made.estimator, made.error_m_s, 1, controller, opened)
    return fitted_to_days(problem, design, tuning)
