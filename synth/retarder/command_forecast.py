"""How many commands a table gives, and how many of them the noise of its radar makes; nothing is sampled."""

from __future__ import annotations

from dataclasses import dataclass, replace

from plant_models import Plant
from synth.problem.resolution import finer_for_check
from synth.retarder.configuration.settings import GridSettings
from synth.retarder.rounded_table import predict
from synth.solver.chain.chain import check_chain
from synth.solver.chain.speed_measurement import quantised_measurement
from tuning_tables import ControllerTable

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
