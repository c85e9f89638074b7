"""Commands that the noise of a radar makes, forecast without sampling, against passes with and without the noise."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from plant_models import Plant
from synth.retarder.line_control_loop import command_forecast
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.random_passes import random_passes
from tests.synth.test_control_system import table_for
from tuning_tables import ControllerTable

PASSES = 4000


def narrowed(table: ControllerTable, gap_m_s: float) -> ControllerTable:
    """The table with its raising lines `gap_m_s` above the lowering ones of the same stage, where it has both."""
    stages = []
    for each in table.stages:
        down, up = each.lower, each.upper
        if down is not None and up is not None:
            up = (down[0] + gap_m_s, *down[1:])
        stages.append(replace(each, upper=up))
    return replace(table, stages=tuple(stages))


@pytest.mark.parametrize("noise_m_s", [0.03, 0.12])
def test_the_forecast_is_what_passes_find(plant_52t: Plant, noise_m_s: float) -> None:
    """Within 3.5 standard errors and 3 % for the grid; the noise makes the more commands the larger it is."""
    plant = replace(plant_52t, sensor=replace(plant_52t.sensor, noise_m_s=noise_m_s))
    table = narrowed(table_for(plant), 0.25)
    forecast = command_forecast(table, plant)
    assert forecast is not None
    for sensor, expected in (
        (plant.sensor, forecast.commands),
        (replace(plant.sensor, noise_m_s=0.0), forecast.without_noise),
    ):
        loop = close_loop(replace(plant, sensor=sensor), len(table.stages))
        commands = loop.run(TableController(table), loop.draws(random_passes(5, 0, PASSES))).switchings
        error = float(commands.std()) / math.sqrt(PASSES)
        print(f"noise {sensor.noise_m_s}: forecast {expected:.3f} simulated {commands.mean():.3f} ± {error:.3f}")
        assert expected == pytest.approx(float(commands.mean()), abs=3.5 * error + 0.03 * float(commands.mean()))
    assert forecast.by_noise > (1.0 if noise_m_s > 0.1 else -0.1)
