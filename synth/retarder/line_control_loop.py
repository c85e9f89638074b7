"""The loop of a table with lines: its nominal response, phase portrait, limit cycles, and its commands forecast."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from plant_models import Plant
from synth.problem.resolution import finer_for_check
from synth.retarder.comparison.limit_cycle import Hunting, hunting_report
from synth.retarder.comparison.pressure_cycle import PressureCycle, pressure_hunting
from synth.retarder.configuration.settings import GridSettings
from synth.retarder.control_loop import MEDIAN_ENTRY, ControlLoop
from synth.retarder.rounded_table import predict
from synth.retarder.served_class import ServedClass
from synth.simulation.closed_loop import TableController
from synth.simulation.nominal_pass import nominal_entry_m_s, nominal_pass
from synth.simulation.nominal_response import SAME_SAMPLE_S, NominalResponse, nominal_response
from synth.solver.chain.chain import check_chain
from synth.solver.chain.speed_measurement import quantised_measurement
from synth.solver.tabulate import lines_of
from tuning_tables import ControllerTable

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
