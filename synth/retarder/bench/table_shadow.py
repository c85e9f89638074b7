"""What the table would command in the place of the controller, asked with the same numbers."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from synth.simulation.sampled_pass import Reading
from tuning_tables import ControllerTable, begin, decide_for, speed_for
from tuning_tables.decisions import Decisions


@dataclass
class TableShadow:
    """One cut under `table`; an estimator learns of each sample."""

    table: ControllerTable
    _state: NDArray[np.float32] = field(default_factory=begin)

    def stage_at(self, reading: Reading) -> int:
        """The stage of the table at this sample; to be asked once at each."""
        speed = speed_for(self.table, self._state, reading.path_m, reading.measured_m_s, reading.mean_overpressure_kpa)
        if not reading.at_rest and self.table.decisions is Decisions.AT_REST:
            return reading.stage
        return decide_for(self.table, reading.stage, reading.path_m, speed, reading.pressure_kpa)
