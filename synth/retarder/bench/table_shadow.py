"""What the table would command in the place of the controller, asked with the same numbers."""

from __future__ import annotations

from synth.simulation.sampled_pass import Reading
from tuning_tables import ControllerTable, begin, decide_for, speed_for
from tuning_tables.decisions import Decisions


class TableShadow:
    """One cut under a table; an estimator learns of each sample."""

    def __init__(self, table: ControllerTable) -> None:
        self._table, self._state = table, begin()

    def stage_at(self, reading: Reading) -> int:
        """The stage of the table at this sample; to be asked once at each."""
        speed = speed_for(self._table, self._state, reading.path_m, reading.measured_m_s, reading.mean_overpressure_kpa)
        if not reading.at_rest and self._table.decisions is Decisions.AT_REST:
            return reading.stage
        return decide_for(self._table, reading.stage, reading.path_m, speed, reading.pressure_kpa)
