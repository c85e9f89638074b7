"""What a tune finds out about one case (cut class × target speed), and about the whole book."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from synth.book.comparison.measured import Feasibility, Measured
from synth.problem.criterion import SQUARED_ERROR_CRITERION, Criterion
from synth.problem.requirement_found import Finding
from synth.simulation.exit_statistics import BrakePower
from synth.simulation.passes import PassTrace
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import SwitchingLines
from tuning_tables import ControllerTable

if TYPE_CHECKING:  # who draws or reports a case needs no kernels
    from synth.book.estimation.estimated_table import EstimatedTable

WITHOUT_ESTIMATOR = "without estimator"
"""Name of the polished lines for the measured speed, where the table has an estimator."""


@dataclass(frozen=True)
class PolicyMap:
    """Best command and indifferent region on the solver's grid, by stage.

    `path_m` (N,), `speed_m_s` (E,); `command` (K + 1, N, E) int8: −1 down, 0 hold, +1 up; `indifferent`
    (K + 1, N, E): several commands cost the same within the tolerance.
    """

    path_m: NDArray[np.float64]
    speed_m_s: NDArray[np.float64]
    command: NDArray[np.int8]
    indifferent: NDArray[np.bool_]


@dataclass(frozen=True)
class Indifference:
    """What using the indifferent region saves: the solver's lines with and without the tolerance."""

    tolerance_m2_s2: float
    switchings_without: float
    switchings_with: float
    rms_without_m_s: float
    rms_with_m_s: float


@dataclass(frozen=True)
class DegreeStudy:
    """Exit error against the degree of the polynomials; arrays by `degrees`, rms in m/s.

    Predicted on the grid of the tables' own predictions: `fitted_rms_m_s` of tables of lines fitted by weighted least
    squares, `polished_rms_m_s` after the polish (NaN where no table could be rounded), `lines_rms_m_s` of the
    solver's lines.
    """

    label: str
    degrees: tuple[int, ...]
    fitted_rms_m_s: NDArray[np.float64]
    polished_rms_m_s: NDArray[np.float64]
    lines_rms_m_s: float


@dataclass(frozen=True)
class CaseResult:
    """One cut class and target: table, prediction, closed loop, comparison.

    `table`, `table_lines` the exported polynomial lines (sampled densely), `solver_lines` the raw matrices;
    `predicted` exact density of the exported table; `exit_speeds_m_s` simulated, stalls as 0, and `exit_weight`: how
    many cuts each pass stands for; `brake_power`: what of their error is for want of it; `comparison` by controller:
    first our table, then full lines, as published, friction known, baselines; `traces` a few passes of the table (low,
    nominal and high friction) with `trace_factors` their ξ_cut; `criterion` in force and, where it requires something,
    `finding`: what that took. Where an estimator is asked for, `estimate`: how its lines were designed; then the
    comparison ends with lines for the measured speed, `WITHOUT_ESTIMATOR`, and `predicted` is simulated if the table
    has the estimator (else it is `left_out`).
    """

    label: str
    plant: Plant
    target_speed_m_s: float
    table: ControllerTable
    table_lines: SwitchingLines
    solver_lines: SwitchingLines
    policy_map: PolicyMap
    predicted: ExitDensity
    published_predicted_rms_m_s: float
    exit_speeds_m_s: NDArray[np.float32]
    exit_weight: NDArray[np.float64]
    brake_power: BrakePower
    comparison: tuple[Measured, ...]
    indifference: Indifference
    feasibility: Feasibility
    traces: tuple[PassTrace, ...]
    trace_factors: tuple[float, ...]
    criterion: Criterion = SQUARED_ERROR_CRITERION
    finding: Finding | None = None
    estimate: EstimatedTable | None = None

    @property
    def left_out(self) -> str:
        """Why the table has no estimator though one was asked for, as a sentence's end; empty otherwise."""
        made = self.estimate
        if made is None or self.table.estimator is not None:
            return ""
        return (
            f"no estimator: it gained nothing on the tuning passes (rms {made.rms_after_m_s:.4f} m/s with it, "
            f"{made.plain_rms_m_s:.4f} without), so the table is of version 1"
        )

    def by_name(self, name: str) -> Measured:
        """The controller called `name` in the comparison."""
        return next(entry for entry in self.comparison if entry.name == name)
