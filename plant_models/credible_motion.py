"""What a cut can do between two passages over point sensors: by this a regulator believes a pulse pair or not."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from plant_models.motion import path_breaks_m, path_coefficients
from plant_models.plant import Plant
from plant_models.point_sensors import PointSensors

LEAST_SPEED_M_S = 0.1
"""A slower reading is not believed; a cut so slow as to give one is about to stop."""

FAR_STDS = 4.0
"""How far from its mean a friction, a resistance or a reading may lie and still be believed."""

SPARE_ACCELERATION_M_S2, SPARE_PATH_M = 0.05, 0.1
"""Beyond what the model can do: wind, and the place of a sensor."""


@dataclass(frozen=True)
class CredibleMotion:
    """Limits of what a pulse pair may tell.

    `speed_m_s`: least and greatest; `acceleration_m_s2`, `deceleration_m_s2`: greatest; `speed_tolerance`: relative
    error allowed of a speed; `path_tolerance_m`: error allowed of a path.
    """

    speed_m_s: tuple[float, float]
    acceleration_m_s2: float
    deceleration_m_s2: float
    speed_tolerance: float
    path_tolerance_m: float


def credible_motion(plant: Plant, sensors: PointSensors) -> CredibleMotion:
    """The limits for `plant`, whatever its regulator commands.

    The greatest speed is that of a cut that is never braked and comes with the greatest speed that the position or the
    entry law takes; the acceleration that of a cut without resistance; the deceleration that at the top stage, reached
    from above, with much friction and resistance. The path may be off by one base: the speed of a reading is that at
    its middle, the time that of its second pulse.
    """
    position, law = plant.position, plant.resistance
    edges = path_breaks_m(position, plant.cut, plant.profile, plant.start_m)
    path = path_coefficients(position, plant.cut, plant.profile, edges)
    first_m_s = max(plant.entry.high_m_s, position.max_entry_speed_m_s)
    gained = 2.0 * float(np.maximum(path.gravity_m_s2, 0.0) @ np.diff(edges))
    fastest = math.sqrt(first_m_s**2 + gained)
    noise = FAR_STDS * float(sensors.reading_std_m_s(fastest)) / fastest
    factor = float(plant.friction.cut_factor(np.array([FAR_STDS]), plant.friction_cv)[0])
    factor *= 1.0 + FAR_STDS * plant.friction.path_std
    drag = path.resistance_m_s2_per_n_kn * (law.mean_n_per_kn + FAR_STDS * law.std_n_per_kn)
    highest_kpa = position.stage_pressures_kpa[plant.top_stage] + position.pneumatics.dead_band_kpa
    overpressure_kpa = max(0.0, highest_kpa - position.force.touch_pressure_kpa)
    slowed = drag - path.gravity_m_s2 + factor * overpressure_kpa * path.brake_m_s2_per_kpa
    return CredibleMotion(
        (LEAST_SPEED_M_S, fastest * (1.0 + noise)),
        max(0.0, float(path.gravity_m_s2.max())) + SPARE_ACCELERATION_M_S2,
        max(0.0, float(slowed.max())) + SPARE_ACCELERATION_M_S2,
        min(noise, 0.9),
        sensors.base_m + SPARE_PATH_M,
    )
