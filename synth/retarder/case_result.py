"""What a tune finds out about one case (cut class × target speed), and about the whole book."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import frozen_arrays
from synth.problem.criterion import Criterion
from synth.problem.problem import Problem
from synth.problem.requirement_found import Finding
from synth.retarder.comparison.comparison import Comparison
from synth.retarder.feasibility import Feasibility
from synth.retarder.grid_check import GridCheck
from synth.retarder.off_nominal.outcome import OffNominal
from synth.retarder.pareto.pareto_front import ParetoFront
from synth.simulation.exit_statistics import BrakePower
from synth.simulation.passes import PassTrace
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import SwitchingLines
from tuning_tables import ControllerTable

if TYPE_CHECKING:  # who draws or reports a case needs no kernels
    from synth.retarder.tuned_table import AnyEstimate
    from synth.solver.any_time.surface_polish import SurfacePolish
    from synth.solver.polish import Polish


MOST_ESCAPED = 1e-4
"""Probability that may leave the top of the speed grid before a prediction is called doubtful."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class PolicyMap:
    """Best command and indifferent region on the solver's grid, by stage.

    `path_m` (N,), `speed_m_s` (E,); `command` (K + 1, N, E) int8: −1 down, 0 hold, +1 up; `indifferent`
    (K + 1, N, E): several commands cost the same within the tolerance. `ties`: share of the states with a change at
    hand where hold wins because the best change gains nothing.
    """

    path_m: NDArray[np.float64]
    speed_m_s: NDArray[np.float64]
    command: NDArray[np.int8]
    indifferent: NDArray[np.bool_]
    ties: float


@frozen_arrays
@dataclass(frozen=True, eq=False)
class CaseStudy:
    """What a case shows besides its figures.

    `table_lines` the exported polynomial lines (sampled densely), `solver_lines` the raw matrices; `traces` a few
    passes of the table (low, nominal and high friction) with `trace_factors` their ξ_cut.
    """

    table_lines: SwitchingLines
    solver_lines: SwitchingLines
    policy_map: PolicyMap
    traces: tuple[PassTrace, ...]
    trace_factors: tuple[float, ...]


@frozen_arrays
@dataclass(frozen=True, eq=False)
class CaseResult:
    """One cut class and target: the table with its prediction, its closed loop, and the comparison.

    `predicted`: exact density of the exported table, or a simulated one if the table has an estimator; `polish`: how
    the lines of least cost were found; `grid`: whether the grid of the design for the measured speed and commands at
    rest is to be believed; `finding`: what the criterion's requirement took; `estimate`: where an estimator
    is asked for, how its lines were designed. `exit_speeds_m_s` simulated, stalls as 0, and `exit_weight`: how many
    cuts each pass stands for; `brake_power`: what of their error is for want of it; `front`: where it is asked for,
    what less time in the position costs; `off_nominal`: what the table does on other plants than its own.
    """

    label: str
    problem: Problem
    table: ControllerTable
    predicted: ExitDensity
    polish: Polish | SurfacePolish
    grid: GridCheck
    finding: Finding | None
    estimate: AnyEstimate | None
    exit_speeds_m_s: NDArray[np.float32]
    exit_weight: NDArray[np.float64]
    brake_power: BrakePower
    comparison: Comparison
    feasibility: Feasibility
    study: CaseStudy
    front: ParetoFront | None
    off_nominal: tuple[OffNominal, ...]

    @property
    def plant(self) -> Plant:
        """Everything about a pass but the commanded speed."""
        return self.problem.plant

    @property
    def target_speed_m_s(self) -> float:
        """The commanded exit speed."""
        return self.problem.target_speed_m_s

    @property
    def criterion(self) -> Criterion:
        """What a pass costs."""
        return self.problem.criterion

    @property
    def warnings(self) -> tuple[str, ...]:
        """What throws doubt on the figures of the case, a sentence each."""
        found = []
        if not self.polish.converged:
            found.append(
                f"the polish ended before it converged ({self.polish.status}): its lines are the best of "
                f"{self.polish.evaluations} evaluations"
            )
        if not self.grid.is_believed:
            found.append(
                f"on the grid of its design the rms is {self.grid.design_rms_m_s:.4f} m/s, without it "
                f"{self.grid.independent_rms_m_s:.4f}: there may be better lines; lower grid.speed_step_m_s"
            )
        if self.predicted.escaped > MOST_ESCAPED:
            found.append(
                f"a probability of {self.predicted.escaped:.1e} left the top of the speed grid in the prediction, "
                f"where {MOST_ESCAPED:g} is allowed: lower grid.speed_step_m_s"
            )
        sensor = self.plant.sensor
        if sensor.missed_share > 0.0 and self.table.predicted.passes is None:
            found.append(
                f"the prediction of the table counts on every reading, but {100.0 * sensor.missed_share:g} % are lost "
                "(sensor.missed_share): the simulation knows it, and regulator.estimator = true predicts with it"
            )
        return tuple(found)
