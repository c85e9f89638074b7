"""The grid to design lines for estimated speeds on: finer than the one for measured speeds, as the error is smaller."""

from __future__ import annotations

from dataclasses import replace

from plant_models import DopplerSensor
from synth.problem.resolution import LEAST_SPEED_STEP_M_S, Resolution

ERROR_SHARE = 0.45
"""The error of the estimate, as a share of that of the measured speed: 0.41 to 0.45 in the default book."""

LEAST_ERROR_M_S = 0.01
"""Lines are designed for no smaller error, which would need too fine a grid: they are a little too far apart then."""

ESTIMATOR_FRICTION_NODES = 4
"""Scenarios of friction of a design for estimated speeds; an odd number with that for any day, so that one is the mean
friction: with six in all, six of 145 random cuts had 1.02 to 1.08 of the rms without estimator. With seven the rms
scatters about the same one. Scenarios of resistance are not saved: with two instead of three, lines for long slow
cuts run between them, with 10 to 20 % more rms in the park."""

ESTIMATOR_STEP_SHARE = 1.0
"""Largest speed step of the grid, in standard deviations of the error. With 0.65 the mean rms is 1 % more. With 1.3 a
tune takes a tenth less, but the cubic interpolation leaves negative probabilities, and some polishes descend into
them: three of 223 random cuts had 1.06 to 1.16 of the rms without estimator."""


def design_error_m_s(sensor: DopplerSensor) -> float:
    """Standard deviation of the estimated speed that lines are designed for, m/s."""
    return max(ERROR_SHARE * sensor.reading_std_m_s, LEAST_ERROR_M_S)


def estimator_resolution(resolution: Resolution, sensor: DopplerSensor, lowest_target_m_s: float) -> Resolution:
    """`resolution` with a speed step for the error of the estimate, and fewer scenarios, for all targets of a plant."""
    # The step is that at the reference speed; below it cells are wider.
    wider = max(1.0, resolution.reference_speed_m_s / lowest_target_m_s)
    step = max(ESTIMATOR_STEP_SHARE * design_error_m_s(sensor) / wider, LEAST_SPEED_STEP_M_S)
    return replace(
        resolution,
        speed_step_m_s=min(resolution.speed_step_m_s, step),
        friction_nodes=ESTIMATOR_FRICTION_NODES,
    )
