"""The loop of one exported table as a control engineer looks at it: response, phase portrait, limit cycle."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from plant_models import Plant
from synth.retarder.command_forecast import CommandForecast, command_forecast
from synth.retarder.comparison.limit_cycle import Hunting, hunting_report
from synth.retarder.comparison.pressure_cycle import PressureCycle, pressure_hunting
from synth.simulation.closed_loop import TableController
from synth.simulation.nominal_pass import nominal_entry_m_s, nominal_pass
from synth.simulation.nominal_response import NominalResponse, nominal_response
from synth.simulation.passes import PassTrace
from synth.simulation.response_difference import ResponseDifference, commands_of, response_difference
from synth.solver.tabulate import lines_of
from tuning_tables import ControllerTable

MEDIAN_ENTRY, HALF_A_PERIOD = 0.5, 0.5
"""The nominal pass enters at the median speed, and its first sample comes in the middle of a period."""

ENTRIES = 6
"""Passes of the phase portrait."""

LINE_NODES = 301

TOLERANCE_M_S = 0.001
"""Python-control and the simulator agree if they are nowhere farther apart, as long as their commands are the same."""


@dataclass(frozen=True)
class ControlLoop:
    """A table in the loop with its plant, no chance in it but in `forecast`.

    `response` is python-control's, `trace` the simulator's, of the same pass; `portrait`: responses from other entry
    speeds; `hunting`: where a pair of stages can hunt, and how; `pressure`: (stage, limit cycle) of every stage around
    which the pressure regulator itself hunts; `forecast`: commands of real passes, with the radar's noise and without,
    None for a table with an estimator.
    """

    table: ControllerTable
    label: str
    plant: Plant
    entry_m_s: float
    response: NominalResponse
    trace: PassTrace
    portrait: tuple[NominalResponse, ...]
    hunting: tuple[Hunting, ...]
    pressure: tuple[tuple[int, PressureCycle], ...]
    forecast: CommandForecast | None

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return len(self.table.stages)

    @property
    def difference(self) -> ResponseDifference:
        """How far the response and the trace are apart."""
        return response_difference(self.response, self.trace)

    @property
    def agrees(self) -> bool:
        """Whether response and trace are within the tolerance, as long as their commands are the same."""
        return abs(self.difference.largest_m_s) <= TOLERANCE_M_S


def control_loop(table: ControllerTable, label: str, plant: Plant) -> ControlLoop:
    """The loop of `table` around `plant`, the class `label` that it is for."""
    controller, period = TableController(table), plant.sensor.sample_period_s
    entry, phase_s = nominal_entry_m_s(plant, MEDIAN_ENTRY), HALF_A_PERIOD * period
    slowest = min(table.target_speed_m_s, entry)
    speeds = np.linspace(slowest, nominal_entry_m_s(plant, 0.999), ENTRIES)
    return ControlLoop(
        table=table,
        label=label,
        plant=plant,
        entry_m_s=entry,
        response=nominal_response(plant, controller, entry, phase_s),
        trace=nominal_pass(plant, controller, MEDIAN_ENTRY, HALF_A_PERIOD),
        portrait=tuple(nominal_response(plant, controller, float(speed), phase_s) for speed in speeds),
        hunting=hunting_report(plant, lines_of(table, np.linspace(plant.start_m, plant.exit_m, LINE_NODES))),
        pressure=pressure_hunting(plant),
        forecast=command_forecast(table, plant),
    )


def loop_document(loop: ControlLoop) -> dict[str, Any]:
    """A loop for programs; NaN where the first harmonic balances nowhere."""
    response, trace = loop.response, loop.trace
    return {
        "id": loop.table.id,
        "label": loop.label,
        "target_speed_m_s": loop.table.target_speed_m_s,
        "entry_speed_m_s": loop.entry_m_s,
        "first_sample_s": HALF_A_PERIOD * loop.plant.sensor.sample_period_s,
        "python_control": {
            "exit_speed_m_s": response.exit_speed_m_s,
            "time_s": float(response.time_s[-1]),
            "commands": response.commands,
        },
        "simulator": {
            "exit_speed_m_s": trace.exit_speed_m_s,
            "time_s": float(trace.time_s[-1]),
            "commands": commands_of(trace),
        },
        "difference": {**asdict(loop.difference), "tolerance_m_s": TOLERANCE_M_S, "agrees": loop.agrees},
        "command_forecast": None if loop.forecast is None else asdict(loop.forecast),
        "limit_cycles": [asdict(each) for each in loop.hunting],
        "pressure_limit_cycles": [{"stage": stage, **asdict(cycle)} for stage, cycle in loop.pressure],
    }
