"""The grid to design lines for estimated speeds on: finer than the one for measured speeds, as the error is smaller."""

from __future__ import annotations

import math
from dataclasses import replace

from plant_models import DopplerSensor
from plant_models.errors import require
from synth.problem.resolution import LEAST_SPEED_STEP_M_S, Resolution

FIRST_SHARE = 0.45
"""Guess of the estimate's error, as a share of the measured speed's."""

FRICTION_NODES, RESISTANCE_NODES = 4, 1
"""Scenarios of a design for estimated speeds: of the running resistance only the mean, as the estimator does not learn
it. More of both were not tried with an estimator."""

STEP_SHARE = 0.65
"""Largest speed step of the grid, in standard deviations of the guessed error: coarser ones are exploited."""


def guessed_error_m_s(sensor: DopplerSensor) -> float:
    """Of the estimated speed, before any pass was simulated."""
    return FIRST_SHARE * sensor.reading_std_m_s


def estimator_resolution(resolution: Resolution, sensor: DopplerSensor, lowest_target_m_s: float) -> Resolution:
    """`resolution` with a speed step for the error of the estimate, and fewer scenarios, for all targets of a plant.

    Raises `PlantError`, whose sentence names the keys of the sensor, where the error is too small for a grid.
    """
    # The step is that at the reference speed; below it cells are wider.
    wider = max(1.0, resolution.reference_speed_m_s / lowest_target_m_s)
    step = STEP_SHARE * guessed_error_m_s(sensor) / wider
    least_m_s = math.ceil(1e5 * LEAST_SPEED_STEP_M_S * wider / (STEP_SHARE * FIRST_SHARE)) / 1e5
    require(
        step >= LEAST_SPEED_STEP_M_S,
        f"sensor: noise_m_s is {sensor.noise_m_s:g} and sensor.resolution_m_s is {sensor.resolution_m_s:g}; with "
        f"regulator.estimator = true and a lowest target of {lowest_target_m_s:g} m/s, "
        f"sqrt(noise_m_s² + resolution_m_s²/12) must be {least_m_s:g} m/s or more, because lines for the estimated "
        "speed would need too fine a grid; set the noise that the sensor has, or regulator.estimator = false",
    )
    return replace(
        resolution,
        speed_step_m_s=min(resolution.speed_step_m_s, step),
        friction_nodes=FRICTION_NODES,
        resistance_nodes=RESISTANCE_NODES,
    )
