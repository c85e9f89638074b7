"""The loop of one table for point sensors as a control engineer looks at it: the nominal response, and its parts."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

from plant_models import Plant
from synth.retarder.control_loop import MEDIAN_ENTRY, TOLERANCE_M_S
from synth.retarder.passage_class import PassageClass
from synth.simulation.filled_trace import filled_trace
from synth.simulation.nominal_pass import nominal_entry_m_s, nominal_plant, one_pass
from synth.simulation.nominal_response import NominalResponse
from synth.simulation.passage_controller import PassageController, of_table
from synth.simulation.passage_loop import PassageLoop, close_passage_loop
from synth.simulation.passage_response import passage_response
from synth.simulation.passage_sample import PassageTrace
from synth.simulation.response_difference import SAME_PASSAGE_S, ResponseDifference, commands_of, response_difference
from tuning_tables.passages.passage_table import PassageTable

TRACE_STEP_S = 0.05
"""Between points of the simulator's pass, which has events of its own only at coils and changes of pressure."""


@dataclass(frozen=True)
class PassageControlLoop:
    """A table in the loop with its plant and sensors, no chance in it.

    `response` is python-control's, `trace` the simulator's, of the same pass: mean friction and resistance, median
    entry speed, bases without error and a timer without noise, with the tracker.
    """

    table: PassageTable
    label: str
    loop: PassageLoop
    controller: PassageController
    entry_m_s: float
    response: NominalResponse
    trace: PassageTrace

    @property
    def plant(self) -> Plant:
        """The plant without chance; its radar takes no part."""
        return self.loop.plant

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return self.controller.stages

    @property
    def difference(self) -> ResponseDifference:
        """How far the response and the trace are apart."""
        return response_difference(self.response, self.trace, SAME_PASSAGE_S)

    @property
    def agrees(self) -> bool:
        """Whether response and trace are within the tolerance, as long as their commands are the same."""
        return abs(self.difference.largest_m_s) <= TOLERANCE_M_S


def passage_control_loop(table: PassageTable, made_for: PassageClass) -> PassageControlLoop:
    """The loop of `table` around the plant and the sensors that it is for."""
    plant = nominal_plant(made_for.plant)
    sensors = replace(made_for.sensors, timer_noise_s=0.0, base_tolerance=0.0)
    loop, controller = close_passage_loop(plant, sensors, len(table.pressure_kpa)), of_table(table, tracking=True)
    entry, draws = nominal_entry_m_s(plant, MEDIAN_ENTRY), loop.draws(one_pass(MEDIAN_ENTRY, 0.0))
    return PassageControlLoop(
        table=table,
        label=made_for.label,
        loop=loop,
        controller=controller,
        entry_m_s=entry,
        response=passage_response(loop, controller, entry),
        trace=filled_trace(loop, loop.follow(controller, draws), draws, TRACE_STEP_S),
    )


def passage_loop_document(loop: PassageControlLoop) -> dict[str, Any]:
    """A loop for programs, with what the simulator's regulator read at each pulse pair."""
    response, trace, read = loop.response, loop.trace, loop.trace.readings
    return {
        "id": loop.table.id,
        "label": loop.label,
        "target_speed_m_s": loop.table.target_speed_m_s,
        "entry_speed_m_s": loop.entry_m_s,
        "python_control": {
            "exit_speed_m_s": response.exit_speed_m_s,
            "time_s": float(response.time_s[-1]),
            "commands": response.commands,
        },
        "simulator": {
            "exit_speed_m_s": trace.exit_speed_m_s,
            "time_s": float(trace.time_s[-1]),
            "commands": commands_of(trace),
            "readings": [
                {"time_s": t, "sensor": m, "speed_m_s": v}
                for t, m, v in zip(
                    read.time_s.tolist(), read.told_sensor.tolist(), read.reading_m_s.tolist(), strict=True
                )
            ],
        },
        "difference": {**asdict(loop.difference), "tolerance_m_s": TOLERANCE_M_S, "agrees": loop.agrees},
    }
