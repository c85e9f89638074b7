"""The table that a tune would make, without its prediction and validation."""

from __future__ import annotations

from plant_models import Plant
from synth.problem.aim import Aim
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.backward_induction import Solution
from synth.solver.chain.chain import persistent_chain
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from synth.solver.tuned_lines import fitted, polished, tuned_lines
from tuning_tables import ControllerTable, Estimator, Generator

CREATED = "2000-01-01T00:00:00Z"


def tuned_table(config: ResolvedConfig, plant: Plant, target_m_s: float) -> ControllerTable:
    """Solved, fitted, polished and rounded as in a tune of `plant`, which need not be one of the configuration."""
    resolution = config.grid.resolution(plant.sensor.sample_period_s).for_pass(plant.pass_m)
    design = persistent_chain(plant, resolution)
    lines = tuned_lines(design, Aim(target_m_s, config.criterion), config.fit.degree).best
    return rounded(config, plant, lines, target_m_s)


def lines_of_solution(solution: Solution, degree: int) -> PolynomialLines:
    """Lines of `degree` fitted to a solution, and polished."""
    return polished(solution, fitted(solution, degree)).best


def rounded(
    config: ResolvedConfig,
    plant: Plant,
    lines: PolynomialLines | PolynomialSurfaces,
    target_m_s: float,
    estimator: Estimator | None = None,
) -> ControllerTable:
    """The table of `lines`, or of surfaces."""
    maker = Generator("retarder-synth study", "0", config.sha256)
    return tabulate(plant, lines, target_m_s, UNPREDICTED, maker, f"to-{target_m_s:g}", CREATED, estimator)
