"""The loop of a table for point sensors: its nominal response, and its parts."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from synth.retarder.control_loop import MEDIAN_ENTRY, ControlLoop
from synth.retarder.served_class import PassageClass
from synth.simulation.nominal_pass import nominal_entry_m_s, nominal_plant, one_pass
from synth.simulation.nominal_response import SAME_PASSAGE_S
from synth.simulation.passage_controller import PassageController, of_table
from synth.simulation.passage_loop import PassageLoop, close_passage_loop, filled_trace
from synth.simulation.passage_response import passage_response
from synth.simulation.passage_sample import PassageTrace
from tuning_tables.passages.passage_table import PassageTable


@dataclass(frozen=True)
class PassageControlLoop(ControlLoop):
    """See `ControlLoop`; `loop` and `controller` are what the simulator runs.

    Bases have no error and the timer no noise; the regulator has its tracker, and the radar of the plant takes no part.
    """

    table: PassageTable
    trace: PassageTrace
    loop: PassageLoop
    controller: PassageController

    @property
    def document(self) -> dict[str, Any]:
        """The loop for programs, with what the simulator's regulator read at each pulse pair."""
        told, read = super().document, self.trace.readings
        readings = zip(read.time_s.tolist(), read.told_sensor.tolist(), read.reading_m_s.tolist(), strict=True)
        told["simulator"]["readings"] = [{"time_s": t, "sensor": m, "speed_m_s": v} for t, m, v in readings]
        return told


def passage_control_loop(table: PassageTable, served: PassageClass) -> PassageControlLoop:
    """The loop of `table` around the plant and the sensors that it is for."""
    plant = nominal_plant(served.plant)
    exact = replace(served.sensors, timer_noise_s=0.0, base_tolerance=0.0)
    loop, controller = close_passage_loop(plant, exact, len(table.pressure_kpa)), of_table(table, tracking=True)
    entry, draws = nominal_entry_m_s(plant, MEDIAN_ENTRY), loop.draws(one_pass(MEDIAN_ENTRY, 0.0))
    return PassageControlLoop(
        table=table,
        label=served.label,
        plant=plant,
        stages=controller.stages,
        entry_m_s=entry,
        response=passage_response(loop, controller, entry),
        trace=filled_trace(loop, loop.follow(controller, draws), draws),
        same_s=SAME_PASSAGE_S,
        loop=loop,
        controller=controller,
    )
