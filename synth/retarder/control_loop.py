"""The loop of one exported table as a control engineer looks at it: the nominal pass, computed twice."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from plant_models import Plant
from synth.simulation.nominal_response import NominalResponse, ResponseDifference, commands_of, response_difference
from synth.simulation.passes import PassTrace
from tuning_tables.table_kinds import StageTable

MEDIAN_ENTRY = 0.5
"""The nominal pass enters at the median speed."""

TOLERANCE_M_S = 0.001
"""Python-control and the simulator agree if they are nowhere farther apart, as long as their commands are the same."""


@dataclass(frozen=True)
class ControlLoop:
    """A table in the loop with its plant, no chance in it.

    `response` is python-control's, `trace` the simulator's, of the same pass: mean friction and resistance, median
    entry speed. `stages`: their number K + 1. Commands of the two that are nearer to each other than `same_s` are one.
    """

    table: StageTable
    label: str
    plant: Plant
    stages: int
    entry_m_s: float
    response: NominalResponse
    trace: PassTrace
    same_s: float

    @property
    def difference(self) -> ResponseDifference:
        """How far the response and the trace are apart."""
        return response_difference(self.response, self.trace, self.same_s)

    @property
    def agrees(self) -> bool:
        """Whether response and trace are within the tolerance, as long as their commands are the same."""
        return abs(self.difference.largest_m_s) <= TOLERANCE_M_S

    @property
    def document(self) -> dict[str, Any]:
        """The loop for programs."""
        response, trace = self.response, self.trace
        return {
            "id": self.table.id,
            "label": self.label,
            "target_speed_m_s": self.table.target_speed_m_s,
            "entry_speed_m_s": self.entry_m_s,
            "python_control": {
                "exit_speed_m_s": response.exit_speed_m_s,
                "time_s": float(response.time_s[-1]),
                "commands": commands_of(response),
            },
            "simulator": {
                "exit_speed_m_s": trace.exit_speed_m_s,
                "time_s": float(trace.time_s[-1]),
                "commands": commands_of(trace),
            },
            "difference": {**asdict(self.difference), "tolerance_m_s": TOLERANCE_M_S, "agrees": self.agrees},
        }
