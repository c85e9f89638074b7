"""What a tune for point sensors finds out about one case (cut class × target speed)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, PointSensors
from plant_models.frozen_arrays import frozen_arrays
from synth.retarder.case_result import MOST_ESCAPED
from synth.simulation.exit_statistics import BrakePower, ExitStatistics
from synth.simulation.passage_sample import PassageTrace
from synth.simulation.replicates import Interval
from synth.simulation.unavoidable_error import UnavoidableError
from synth.solver.exit_density import ExitDensity
from synth.solver.passage_polish import PassagePolish
from tuning_tables.passages.passage_table import PassageTable


@dataclass(frozen=True)
class HeardShares:
    """Of the cuts heard at every passage at which is decided, in its order, the shares with 95 % intervals.

    `unfinished`: found a change of stage unfinished, so that nothing was decided; `mistaken`: the tracker took the
    pulses for no passage, or for one at which nothing is decided. NaN where no cut came. `taken`: passes whose pulses
    were taken for the passage, of which `unfinished` is told; `heard`: all heard there, of which `mistaken` is.
    """

    unfinished: tuple[tuple[float, Interval], ...]
    mistaken: tuple[tuple[float, Interval], ...]
    taken: tuple[int, ...]
    heard: tuple[int, ...]


@frozen_arrays
@dataclass(frozen=True, eq=False)
class SensorCase:
    """One case: the table as read back, its prediction, and what the closed loop says of it.

    `exit_speeds_m_s` simulated, stalls as 0, `exit_weight`: how many cuts each pass stands for. `unavoidable`: the
    error that no rule with these sensors avoids; slowest are cuts under the harder braking of two, the table and full
    brake at every passage. `traces`: passes with the friction factors `trace_factors`.
    """

    label: str
    plant: Plant
    sensors: PointSensors
    table: PassageTable
    predicted: ExitDensity
    polish: PassagePolish
    exit_speeds_m_s: NDArray[np.float32]
    exit_weight: NDArray[np.float64]
    statistics: ExitStatistics
    brake_power: BrakePower
    unavoidable: UnavoidableError
    heard: HeardShares
    traces: tuple[PassageTrace, ...]
    trace_factors: tuple[float, ...]

    @property
    def target_speed_m_s(self) -> float:
        """The commanded exit speed."""
        return self.table.target_speed_m_s

    @property
    def name(self) -> str:
        """Cut class and target in one line."""
        return f"{self.label}, target {self.target_speed_m_s:g} m/s"

    @property
    def cut_name(self) -> str:
        """Cut class with what matters of the cut: category, mass, axles."""
        cut = self.plant.cut
        return f"{self.label} (category {cut.category}, {cut.mass_t:g} t, {cut.axles} axles)"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What throws doubt on the figures of the case, a sentence each."""
        found = []
        if not self.polish.converged:
            found.append(
                f"the polish ended before it converged ({self.polish.status}): its switching speeds are the best of "
                f"{self.polish.evaluations} evaluations"
            )
        if self.predicted.escaped > MOST_ESCAPED:
            found.append(
                f"a probability of {self.predicted.escaped:.1e} left the top of the speed grid in the prediction, "
                f"where {MOST_ESCAPED:g} is allowed: lower grid.speed_step_m_s"
            )
        return tuple(found)
