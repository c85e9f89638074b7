"""Lines for commands at rest and the estimated speed: polished on the chain of the estimate, and trimmed."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models import Plant
from synth.problem.estimator_resolution import design_error_m_s
from synth.retarder.checked_design import CheckedDesign, checked_design
from synth.retarder.estimation.estimate_chain import rms_with_white_error
from synth.retarder.estimation.estimated_table import EstimatedTable, lines_for_estimate, trimmed_on
from synth.retarder.estimation.estimator_design import estimator_of
from synth.retarder.estimation.tuning_days import TuningDays
from synth.simulation.random_passes import RandomPasses
from synth.solver.backward_induction import Solution
from synth.solver.polynomial_lines import PolynomialLines


@dataclass(frozen=True)
class SimulatedRms:
    """The rms of lines on simulated passes, m/s; `most_off`: a grid is not believed where it differs by more.

    More than for an exact figure: the rare cuts that saturate the brake make up to a fifth of it, by chance.
    """

    rms_m_s: float
    most_off: float = 1.5


def estimated_lines(
    plant: Plant, solution: Solution, degree: int, tuning: RandomPasses, days: TuningDays
) -> tuple[CheckedDesign[SimulatedRms], EstimatedTable[PolynomialLines]]:
    """How the lines of a solution on `estimate_chain` were designed, and how they were trimmed on `days`.

    `tuning`: passes of `plant` on any day, on which the grid of the design is judged.
    """
    aim = solution.aim

    def judge(lines: PolynomialLines) -> SimulatedRms:
        return SimulatedRms(rms_with_white_error(plant, lines, aim.target_speed_m_s, tuning))

    design = checked_design(solution, solution.chain, degree, judge)
    estimator, error_m_s = estimator_of(plant), design_error_m_s(plant.sensor)
    untrimmed = lines_for_estimate(design.kept.lines, estimator, error_m_s, aim.criterion)
    return design, trimmed_on(days, aim.target_speed_m_s, untrimmed)
