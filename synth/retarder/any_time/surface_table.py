"""Surfaces of one case for commands at any time, polished from its lines for commands at rest, and their prediction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.any_time_resolution import design_resolution
from synth.problem.resolution import Resolution
from synth.solver.any_time.estimate_error import EstimateError
from synth.solver.any_time.polynomial_surfaces import CUBIC_AND_SLOPE, PolynomialSurfaces, surfaces_of_lines
from synth.solver.any_time.sampled_chain import check_sampled_chain, sampled_chain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation
from synth.solver.any_time.surface_polish import NEGLIGIBLE_MASS, polish_surfaces
from synth.solver.descent import Descent
from synth.solver.exit_density import ExitDensity, without_negative
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED, surfaces_of, tabulate
from tuning_tables import ControllerTable, Estimator, Generator

NOBODYS = Generator("none", "0", "0" * 64), "trial", "2000-01-01T00:00:00Z"
"""Origin of tables that are only tried."""


def surface_degrees(lines: PolynomialLines, has_gauge: bool) -> tuple[int, ...]:
    """Degrees in the path for the powers of the pressure: that of `lines`, and with a gauge one slope."""
    return (lines.degree, *CUBIC_AND_SLOPE[1:]) if has_gauge else (lines.degree,)


def starting_surfaces(plant: Plant, lines: PolynomialLines, has_gauge: bool) -> PolynomialSurfaces:
    """Lines for commands at rest, taken at every pressure."""
    stages = np.asarray(plant.position.stage_pressures_kpa[: plant.top_stage + 1])
    return surfaces_of_lines(lines, stages, surface_degrees(lines, has_gauge))


def polished_surfaces(
    plant: Plant, aim: Aim, start: PolynomialSurfaces, steps: Resolution, estimate: EstimateError | None = None
) -> Descent[PolynomialSurfaces]:
    """The surfaces of least cost near `start`, on the grid `steps`, for the measured or an estimated speed."""
    chain = replace(sampled_chain(plant, steps), estimate=estimate)
    return polish_surfaces(start, SurfaceEvaluation(chain, negligible_mass=NEGLIGIBLE_MASS), aim)


def surface_density(plant: Plant, table: ControllerTable) -> ExitDensity:
    """Exact exit-speed density of a table that decides at any time, by the measured speed."""
    check = check_sampled_chain(plant, design_resolution(plant, table.target_speed_m_s))
    lines = surfaces_of(table, check.grid.path_m[:-1], check.modes)
    return without_negative(SurfaceEvaluation(check).density(lines))


def trial_table(
    plant: Plant, surfaces: PolynomialSurfaces, target_m_s: float, estimator: Estimator | None = None
) -> ControllerTable:
    """The rounded table of surfaces that are only tried: of no origin, and not predicted."""
    return tabulate(plant, surfaces, target_m_s, UNPREDICTED, *NOBODYS, estimator)
