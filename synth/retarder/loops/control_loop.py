"""The loop of one exported table as a control engineer looks at it: the nominal pass, computed twice; of a table with
lines also its phase portrait, its limit cycles, and its commands forecast; of one for point sensors its parts.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from plant_models import Plant
from synth.problem.resolution import finer_for_check
from synth.retarder.comparison.limit_cycle import Hunting, hunting_report
from synth.retarder.comparison.pressure_cycle import PressureCycle, pressure_hunting
from synth.retarder.configuration.settings import GridSettings
from synth.retarder.served_class import PassageClass, ServedClass
from synth.retarder.tuned_table import predict
from synth.simulation.closed_loop import TableController
from synth.simulation.nominal_response import (
    SAME_PASSAGE_S,
    SAME_SAMPLE_S,
    NominalResponse,
    ResponseDifference,
    commands_of,
    nominal_entry_m_s,
    nominal_pass,
    nominal_plant,
    nominal_response,
    one_pass,
    response_difference,
)
from synth.simulation.passage_controller import PassageController, PassageTrace, of_table
from synth.simulation.passage_loop import PassageLoop, close_passage_loop, filled_trace
from synth.simulation.passage_response import passage_response
from synth.simulation.passes import PassTrace
from synth.solver.chain.chain import check_chain
from synth.solver.chain.speed_measurement import quantised_measurement
from synth.solver.tabulate import lines_of
from tuning_tables import ControllerTable
from tuning_tables.document import StageTable
from tuning_tables.passages.passage_table import PassageTable

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


HALF_A_PERIOD = 0.5
"""The first sample of the nominal pass comes in the middle of a period."""

ENTRIES = 6
"""Passes of the phase portrait."""

LINE_NODES = 301


@dataclass(frozen=True)
class LineControlLoop(ControlLoop):
    """See `ControlLoop`; there is no chance in it but in `forecast`.

    `portrait`: responses from other entry speeds; `hunting`: where a pair of stages can hunt, and how; `pressure`:
    (stage, limit cycle) of every stage around which the pressure regulator itself hunts; `forecast`: commands of real
    passes, with the radar's noise and without, None for a table with an estimator.
    """

    table: ControllerTable
    portrait: tuple[NominalResponse, ...]
    hunting: tuple[Hunting, ...]
    pressure: tuple[tuple[int, PressureCycle], ...]
    forecast: CommandForecast | None

    @property
    def document(self) -> dict[str, Any]:
        """The loop for programs; NaN where the first harmonic balances nowhere."""
        return {
            **super().document,
            "first_sample_s": HALF_A_PERIOD * self.plant.sensor.sample_period_s,
            "command_forecast": None if self.forecast is None else asdict(self.forecast),
            "limit_cycles": [asdict(each) for each in self.hunting],
            "pressure_limit_cycles": [{"stage": stage, **asdict(cycle)} for stage, cycle in self.pressure],
        }


def line_control_loop(table: ControllerTable, served: ServedClass) -> LineControlLoop:
    """The loop of `table` around the plant that it is for."""
    plant = served.plant
    controller, period = TableController(table), plant.sensor.sample_period_s
    entry, phase_s = nominal_entry_m_s(plant, MEDIAN_ENTRY), HALF_A_PERIOD * period
    slowest = min(table.target_speed_m_s, entry)
    speeds = np.linspace(slowest, nominal_entry_m_s(plant, 0.999), ENTRIES)
    return LineControlLoop(
        table=table,
        label=served.label,
        plant=plant,
        stages=controller.stages,
        entry_m_s=entry,
        response=nominal_response(plant, controller, entry, phase_s),
        trace=nominal_pass(plant, controller, MEDIAN_ENTRY, HALF_A_PERIOD),
        same_s=SAME_SAMPLE_S,
        portrait=tuple(nominal_response(plant, controller, float(speed), phase_s) for speed in speeds),
        hunting=hunting_report(plant, lines_of(table, np.linspace(plant.start_m, plant.exit_m, LINE_NODES))),
        pressure=pressure_hunting(plant),
        forecast=command_forecast(table, plant),
    )


QUIET_M_S = 1e-3
"""Noise of a radar that has none: far less than a step of the grid."""


@dataclass(frozen=True)
class CommandForecast:
    """Mean commands of a pass, `without_noise` if the radar had none; both with all that is random of the cuts."""

    commands: float
    without_noise: float

    @property
    def by_noise(self) -> float:
        """How many the noise makes."""
        return self.commands - self.without_noise


def command_forecast(table: ControllerTable, plant: Plant) -> CommandForecast | None:
    """That of a table for the measured speed; None where it has an estimator, of which the recursion knows nothing."""
    if table.estimator is not None:
        return None
    check = check_chain(plant, finer_for_check(GridSettings().resolution_for(plant)))
    radar = replace(plant.sensor, noise_m_s=min(QUIET_M_S, plant.sensor.noise_m_s))
    quiet = replace(check, measurement=quantised_measurement(radar))
    return CommandForecast(predict(check, table).switchings, predict(quiet, table).switchings)


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
