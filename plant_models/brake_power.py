"""Brake power of a retarder position: the energy head that its full brake takes from a cut.

The work of the brake is the force on each wheel pair times the braked length, summed over the wheel pairs. It depends
on mass and axles of the cut; where the cars couple matters only to force laws whose slope depends on how many wheel
pairs are braked at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from plant_models.cut import GRAVITY_M_S2, Car, Cut, couple
from plant_models.errors import require
from plant_models.frozen_arrays import Floats, Ints
from plant_models.motion import path_breaks_m, path_coefficients
from plant_models.retarder import RetarderPosition
from plant_models.stage_regulator import resting_modes
from plant_models.track_profile import TrackProfile

MASSES_T = (20.0, 100.0)
"""Masses of a car between which, and beyond, the work is linear: force laws are constant or linear in mass."""


@dataclass(frozen=True)
class FullBrake:
    """What the full brake of `position` takes; axles stand as in cuts of whole cars of the type `car`.

    The brake is full from the first axle to the last: at rest in a stage, reached from below, at the mean friction.
    A brake that still closes at the entrance takes less: 1 to 4 % with a regulator that acts from 4 m ahead.
    """

    position: RetarderPosition
    car: Car

    def head_m(self, mass_t: Floats, axles: Ints, top_stage: Ints) -> Floats:
        """Energy head h in metres of cuts (n,) of `mass_t` on `axles`; the work over the whole position is m·g·h.

        In the highest stage that both the position and `top_stage` (n,) allow. `PlantError` for a cut without axles
        or mass.
        """
        require(bool(np.all(mass_t > 0.0) and np.all(axles > 0)), "full brake: each cut must have a mass and axles")
        stages, which = np.unique(np.minimum(top_stage, self.position.top_stage), return_inverse=True)
        rest = np.array([resting_overpressure_kpa(self.position, int(stage)) for stage in stages])
        counts, of_count = np.unique(axles, return_inverse=True)
        at_masses = np.array([self.work_kj_per_kpa(int(count)) for count in counts])[of_count]
        cars = axles / len(self.car.axle_offsets_m)
        light, heavy = MASSES_T
        work = at_masses[:, 0] + (at_masses[:, 1] - at_masses[:, 0]) * (mass_t / cars - light) / (heavy - light)
        return np.asarray(rest[which] * work / (mass_t * GRAVITY_M_S2))

    def work_kj_per_kpa(self, axles: int) -> tuple[float, ...]:
        """Work over the whole position by 1 kPa of overpressure on `axles`, for cars of each of `MASSES_T`.

        Of the nearest number of whole cars, in proportion to the axles.
        """
        if axles not in self._works:
            cars = max(1, round(axles / len(self.car.axle_offsets_m)))
            cuts = (couple((self.car,) * cars, mass_t * cars, "", 1) for mass_t in MASSES_T)
            self._works[axles] = tuple(self._work_kj_per_kpa(cut) * axles / cut.axles for cut in cuts)
        return self._works[axles]

    @cached_property
    def _works(self) -> dict[int, tuple[float, ...]]:
        """Those already worked out, by axles: trains ask for few numbers of axles, but for each thousands of times."""
        return {}

    def _work_kj_per_kpa(self, cut: Cut) -> float:
        """That of a cut of whole cars."""
        edges = path_breaks_m(self.position, cut, TrackProfile.uniform(0.0))
        brake = path_coefficients(self.position, cut, TrackProfile.uniform(0.0), edges).brake_m_s2_per_kpa
        return float(brake @ np.diff(edges)) * cut.inertia_t


def resting_overpressure_kpa(position: RetarderPosition, stage: int) -> float:
    """Pressure above that of touching at which the regulator rests in `stage`, 0 or more, reached from below."""
    if stage == 0:
        return 0.0
    return max(0.0, resting_modes(position, stage)[-1][1] - position.force.touch_pressure_kpa)
