"""What a cut can do between two passages of a plant: the limits that the tracker of a controller is given."""

from __future__ import annotations

import math

import numpy as np

from plant_models import Plant, PointSensors
from synth.simulation.closed_loop import path_cells

LEAST_SPEED_M_S = 0.1
"""A slower reading is not believed; a cut so slow as to give one is about to stop."""

FAR_STDS = 4.0
"""How far from its mean a friction, a resistance or a reading may lie and still be believed."""

SPARE_ACCELERATION_M_S2, SPARE_PATH_M = 0.05, 0.1
"""Beyond what the model can do: wind, and the place of a sensor."""


def credible_motion(plant: Plant, sensors: PointSensors) -> tuple[float, float, float, float, float, float]:
    """`limits` of `tuning_tables.passages.tracker` for `plant`: least and greatest speed, acceleration, deceleration, …

    The greatest speed is that of the fastest cut that is never braked; the acceleration that of a cut without
    resistance; the deceleration that at the top stage with much friction and resistance. The path is allowed an error
    of one base: the speed of a reading is that at its middle, the time that of its second pulse.
    """
    path = path_cells(plant)
    length = np.diff(path.edges_m)
    fastest = math.sqrt(plant.entry.high_m_s**2 + 2.0 * float(np.maximum(path.gravity_m_s2, 0.0) @ length))
    noise = FAR_STDS * float(sensors.reading_std_m_s(fastest)) / fastest
    factor = float(plant.friction.cut_factor(np.array([FAR_STDS]), plant.friction_cv)[0])
    factor *= 1.0 + FAR_STDS * plant.friction.path_std
    law = plant.resistance
    drag = path.drag_m_s2_per_n_kn * (law.mean_n_per_kn + FAR_STDS * law.std_n_per_kn)
    position = plant.position
    highest_kpa = position.stage_pressures_kpa[plant.top_stage] + position.pneumatics.dead_band_kpa
    overpressure = max(0.0, highest_kpa - position.force.touch_pressure_kpa)
    slowed = drag - path.gravity_m_s2 + factor * overpressure * path.brake_m_s2_per_kpa
    return (
        LEAST_SPEED_M_S,
        fastest * (1.0 + noise),
        max(0.0, float(path.gravity_m_s2.max())) + SPARE_ACCELERATION_M_S2,
        max(0.0, float(slowed.max())) + SPARE_ACCELERATION_M_S2,
        min(noise, 0.9),
        sensors.base_m + SPARE_PATH_M,
    )
