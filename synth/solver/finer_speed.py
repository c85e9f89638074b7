"""A plant's transitions on a finer speed grid, for criteria that live in the tails of the exit speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from synth.problem.resolution import Resolution
from synth.solver.chain.transitions import Scenarios, Transitions, persistent_transitions, resistance_scenarios


def finer_in_speed(transitions: Transitions, times: float, scenarios: Scenarios) -> Transitions:
    """The same plant and path step with a speed step `times` as fine, and with `scenarios`."""
    t = transitions
    resolution = Resolution(
        path_step_m=t.grid.path_step_m,
        speed_step_m_s=t.grid.energy_step_m2_s2 / Resolution().reference_speed_m_s / times,
        transient_substeps=t.actuator.substeps,
        friction_nodes=1,
        path_levels=len(t.chain.levels),
    )
    return replace(persistent_transitions(t.plant, resolution), scenarios=scenarios)


def known_factors(plant: Plant, factors: NDArray[np.float64], resistance_nodes: int) -> Scenarios:
    """Every friction factor (F,) with each of W values of the running resistance, which is innermost; the factors are
    weighted equally, the resistance by its law."""
    extra, weight = resistance_scenarios(plant, resistance_nodes)
    count = len(factors)
    return Scenarios(np.repeat(factors, len(extra)), np.tile(extra, count), np.tile(weight / count, count))
