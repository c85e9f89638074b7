"""A plant's chain on a finer speed grid, for criteria that live in the tails of the exit speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats
from synth.solver.chain.chain import Chain, chain_of
from synth.solver.chain.scenarios import Scenarios, resistance_scenarios


def finer_in_speed(chain: Chain, times: float, scenarios: Scenarios) -> Chain:
    """The same plant, path step and measurement with a speed step `times` as fine, and with `scenarios`."""
    resolution = replace(chain.resolution, speed_step_m_s=chain.resolution.speed_step_m_s / times)
    return replace(chain_of(chain.plant, resolution, scenarios), measurement=chain.measurement)


def known_factors(plant: Plant, factors: Floats, resistance_nodes: int) -> Scenarios:
    """Every friction factor (F,) with each of W values of the running resistance, which is innermost; the factors are
    weighted equally, the resistance by its law."""
    extra, weight = resistance_scenarios(plant, resistance_nodes)
    count = len(factors)
    return Scenarios(np.repeat(factors, len(extra)), np.tile(extra, count), np.tile(weight / count, count))
