"""Plants with point sensors and rules by hand, for the tests of the loop of passages."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import Approach, Plant, PointSensors
from plant_models.point_sensors import deciding_passages
from synth.retarder.sensors.passage_table import plausible_motion
from synth.simulation.passage_controller import PassageController, PassageTrace, of_speeds
from synth.simulation.passage_loop import PassageLoop
from synth.simulation.random_passes import RandomPasses

SENSORS = PointSensors((-5.0, 4.0, 10.0, 17.0, 24.0, 30.0))
CREDIBLE = (0.2, 9.0, 0.15, 3.5, 0.06, 0.3)


def with_approach(plant: Plant, length_m: float, entrance_stage: int = 31, initial_stage: int = 0) -> Plant:
    """`plant` whose regulator acts from `length_m` ahead of the entrance on."""
    return replace(plant, approach=Approach(length_m, entrance_stage, initial_stage))


def exact(sensors: PointSensors) -> PointSensors:
    """`sensors` without any error."""
    return replace(sensors, base_tolerance=0.0, timer_noise_s=0.0, timer_resolution_s=0.0)


def limits_of(plant: Plant, sensors: PointSensors) -> tuple[float, ...]:
    """Limits of the tracker, as a table for `plant` has them."""
    return plausible_motion(plant, sensors).numbers


def braking_rule(
    plant: Plant, sensors: PointSensors, target_m_s: float, limits: tuple[float, ...] = ()
) -> PassageController:
    """Stage j + 1 where v² > v_t² + 2·a·(S_exit − s), a in steps of 0.22 m/s²: an energy rule by hand."""
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    top = plant.top_stage
    left_m = plant.exit_m - np.array([max(each.path_m, 0.0) for each in met])
    rates = 0.22 * (np.arange(top) + 0.4)
    speeds = np.sqrt(target_m_s**2 + 2.0 * rates * left_m[:, None])
    return of_speeds(plant, sensors, np.repeat(speeds[:, None, :], top + 1, axis=1), limits)


def holding_rule(plant: Plant, sensors: PointSensors, limits: tuple[float, ...] = ()) -> PassageController:
    """No command, whatever is read."""
    top, passages = plant.top_stage, len(deciding_passages(sensors, plant.cut, plant.exit_m))
    never = np.where(np.arange(top) < np.arange(top + 1)[:, None], -np.inf, np.inf)
    return of_speeds(plant, sensors, np.repeat(never[None], passages, axis=0), limits)


def followed(loop: PassageLoop, controller: PassageController, passes: RandomPasses) -> list[PassageTrace]:
    """Every pass of `passes`, event by event."""
    return [loop.follow(controller, loop.draws(passes.part(i, i + 1))) for i in range(len(passes))]
