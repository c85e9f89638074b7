"""Two controllers that are made by hand."""

from __future__ import annotations

import numpy as np

from plant_models import Plant
from synth.retarder.comparison.baselines import energy_rule
from synth.simulation.closed_loop import (
    LineController,
    close_loop,
)
from synth.solver.switching_lines import SwitchingLines


def energy_controller(plant: Plant, target_m_s: float) -> LineController:
    loop = close_loop(plant, plant.top_stage + 1)
    return energy_rule(loop, target_m_s, plant.top_stage, 0.8, 0.15, 0.0, 0.15)


def constant_lines(plant: Plant, lower: list[float], upper: list[float]) -> LineController:
    nodes = np.linspace(0.0, plant.exit_m, 2)
    return LineController(SwitchingLines(nodes, np.outer(lower, [1.0, 1.0]), np.outer(upper, [1.0, 1.0])))
