"""What an estimator, or its lines, may be wrong about: another plant, a wrong gauge, a lost sensor."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats
from scripts.studies.plant_changes import friction, times
from scripts.studies.sensor_fault import LostForGood, SensorFault, at_random, no_fault
from synth.simulation.closed_loop import Controller, simulate
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses

LOST = "sensor lost for good"

TOGETHER = 5000
"""Passes simulated at a time: those of a lost sensor have 3000 readings."""


@dataclass(frozen=True)
class Wrong:
    """What is wrong: the plant as it is, how many times the brake work the gauge shows, the sensor's fault."""

    name: str
    plant: Plant
    gauge: float = 1.0
    fault: SensorFault = no_fault


def wrongs(plant: Plant, seed: int) -> tuple[Wrong, ...]:
    """All that is tried, the plant that the tables were made for first; `seed` draws when the sensor is lost."""
    law, sensor = plant.friction, plant.sensor
    rough = replace(law, path_std=2.0 * law.path_std)
    noisy = replace(sensor, noise_m_s=2.0 * sensor.noise_m_s)
    return (
        *braking_otherwise(plant),
        Wrong("path noise × 2", replace(plant, friction=rough)),
        Wrong("sensor noise × 2", replace(plant, sensor=noisy)),
        Wrong("gauge + 15 %", plant, 1.15),
        Wrong("gauge − 15 %", plant, 0.85),
        Wrong(LOST, plant, fault=LostForGood(at_random(seed))),
    )


def braking_otherwise(plant: Plant) -> tuple[Wrong, ...]:
    """The plant that the tables were made for, and plants that brake their cuts more or less than it."""
    spread = replace(plant.friction, common_cv=1.7 * plant.friction.common_cv)
    return (
        Wrong("as it is", plant),
        *(Wrong(f"friction × {share:g}", braking(plant, share)) for share in (0.7, 0.8, 0.9, 1.1, 1.2, 1.3)),
        Wrong("friction CV × 1.7", replace(plant, friction=spread)),
        Wrong("mass + 15 %", weighing(plant, 1.15)),
        Wrong("mass − 15 %", weighing(plant, 0.85)),
    )


def weighing(plant: Plant, share: float) -> Plant:
    """`plant` whose cut has `share` of its mass."""
    return times("cut.mass_t", share)(plant)


def braking(plant: Plant, share: float) -> Plant:
    """`plant` whose retarders brake with `share` of their force."""
    return friction(share, 1.0)(plant)


def simulated(wrong: Wrong, controller: Controller, passes: RandomPasses, transit_s: Floats) -> ExitSample:
    """All passes with the fault, some at a time; `transit_s` (n,): how long each takes where nothing is wrong."""
    parts = []
    for start in range(0, len(passes), TOGETHER):
        stop = min(start + TOGETHER, len(passes))
        faulty = wrong.fault(passes.part(start, stop), wrong.plant, transit_s[start:stop])
        parts.append(simulate(wrong.plant, controller, faulty))
    return ExitSample(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in vars(parts[0])})
