"""Brake power of a retarder position: the energy head that its full brake takes from a cut.

The work of the brake is the force on each wheel pair times the braked length, summed over the wheel pairs. It depends
on mass and axles of the cut; where the cars couple matters only to force laws whose slope depends on how many wheel
pairs are braked at once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plant_models.cut import GRAVITY_M_S2, Car, couple
from plant_models.errors import require
from plant_models.motion import path_breaks_m, path_coefficients
from plant_models.retarder import RetarderPosition
from plant_models.stage_regulator import resting_modes
from plant_models.track_profile import TrackProfile

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MASSES_T = (20.0, 100.0)
"""Masses of a car between which, and beyond, the work is linear: force laws are constant or linear in mass."""


def full_brake_head_m(position: RetarderPosition, car: Car, mass_t: Floats, axles: Ints, top_stage: Ints) -> Floats:
    """Energy head h in metres of cuts (n,) of `mass_t` on `axles`, braked over the whole position; m·g·h is the work.

    The brake is full from the first axle to the last: at rest in the highest stage that both the position and
    `top_stage` (n,) allow, reached from below, at the mean friction. A brake that still closes at the entrance takes
    less: 1 to 4 % with a regulator that acts from 4 m ahead. Axles stand as in cuts of whole cars of the type `car`.
    `PlantError` for a cut without axles or mass.
    """
    require(bool(np.all(mass_t > 0.0) and np.all(axles > 0)), "full brake: each cut must have a mass and axles")
    stages, which = np.unique(np.minimum(top_stage, position.top_stage), return_inverse=True)
    rest = np.array([resting_overpressure_kpa(position, int(stage)) for stage in stages])
    counts, of_count = np.unique(axles, return_inverse=True)
    at_masses = np.array([work_kj_per_kpa(position, car, int(count)) for count in counts])[of_count]
    cars = axles / len(car.axle_offsets_m)
    light, heavy = MASSES_T
    work = at_masses[:, 0] + (at_masses[:, 1] - at_masses[:, 0]) * (mass_t / cars - light) / (heavy - light)
    return np.asarray(rest[which] * work / (mass_t * GRAVITY_M_S2))


def resting_overpressure_kpa(position: RetarderPosition, stage: int) -> float:
    """Pressure above that of touching at which the regulator rests in `stage`, 0 or more, reached from below."""
    if stage == 0:
        return 0.0
    return max(0.0, resting_modes(position, stage)[-1][1] - position.force.touch_pressure_kpa)


def work_kj_per_kpa(position: RetarderPosition, car: Car, axles: int) -> tuple[float, ...]:
    """Work over the whole position by 1 kPa of overpressure on `axles`, for cars of each of `MASSES_T`.

    Of the nearest number of whole cars, in proportion to the axles.
    """
    cars = max(1, round(axles / len(car.axle_offsets_m)))
    works = []
    for mass_t in MASSES_T:
        cut = couple((car,) * cars, mass_t * cars, "", 1)
        edges = path_breaks_m(position, cut, TrackProfile.uniform(0.0))
        brake = path_coefficients(position, cut, TrackProfile.uniform(0.0), edges).brake_m_s2_per_kpa
        works.append(float(brake @ np.diff(edges)) * cut.inertia_t * axles / cut.axles)
    return tuple(works)
