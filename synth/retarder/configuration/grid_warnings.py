"""Whether the grid resolves what the regulator sees at low exit speeds."""

from __future__ import annotations

from collections.abc import Iterator

from plant_models import DopplerSensor
from synth.problem.resolution import Resolution

WIDEST_CELL, ADVISED_CELL = 1.0, 0.6
"""Width of a speed cell at the target in standard deviations of the measured speed. From one on, the polish can find
lines that are good on the grid alone: 36 t to 1.5 m/s at CV 0.05, predicted 0.66 of the simulated rms."""


def grid_warnings(resolution: Resolution, sensor: DopplerSensor, targets_m_s: tuple[float, ...]) -> Iterator[str]:
    """A sentence if the cells at the lowest target are too wide; they are even in v²/2, so widest there."""
    lowest = min(targets_m_s)
    std = sensor.reading_std_m_s
    cell = resolution.speed_step_m_s * resolution.reference_speed_m_s / lowest
    if not sensor.exact and cell > WIDEST_CELL * std:
        advised = ADVISED_CELL * std * lowest / resolution.reference_speed_m_s
        yield (
            f"grid.speed_step_m_s is {resolution.speed_step_m_s:g}, which makes cells of {cell:.3f} m/s at the target "
            f"{lowest:g} m/s, wider than the measured speed is uncertain ({std:.3f} m/s): tables for low targets may "
            f"be worse than predicted; {advised:.2g} or less is better"
        )
