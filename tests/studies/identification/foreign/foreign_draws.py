"""What chance gives to one pass of the foreign plant, drawn before anything moves: common numbers for all tables."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from tests.studies.identification.foreign.foreign_plant import ForeignPlant

Floats = NDArray[np.float64]

LONGEST_PASS_S = 120.0
"""A cut that is still inside after this time counts as stalled: it creeps."""

JITTERS = 64


@frozen_arrays
@dataclass(frozen=True, eq=False)
class ForeignDraw:
    """One pass.

    `entry_m_s`; `friction` xi and `resistance` rho of the cut, of mean 1; `wave_numbers_per_m` and `phases` (waves,) of
    eta; `first_sample_s` after the radar saw it; `valve_jitter_s` (JITTERS,) of its valve openings in turn; standard
    normal `radar_z`, `path_z`, `gauge_z` of its samples in turn.
    """

    entry_m_s: float
    friction: float
    resistance: float
    wave_numbers_per_m: Floats
    phases: Floats
    first_sample_s: float
    valve_jitter_s: Floats
    radar_z: Floats
    path_z: Floats
    gauge_z: Floats


def foreign_draw(plant: ForeignPlant, seed: int, number: int) -> ForeignDraw:
    """Pass `number` of this class of cuts (told by its mass) with `seed`; the same for every table.

    The standard numbers depend on seed, mass and number alone: plants that differ in a parameter have common numbers.
    """
    rng = np.random.default_rng((seed, round(1000.0 * plant.cut.mass_t), number))
    u = rng.random(2)
    friction_z, resistance_z = rng.standard_normal(2)
    brake = plant.brake
    samples = math.ceil(LONGEST_PASS_S / plant.sensor.period_s) + 1
    length_u, phase_u = rng.random((2, brake.waves))
    jitter_u = rng.random(JITTERS)
    radar, path, gauge = rng.standard_normal((3, samples))
    shortest, longest = brake.wave_lengths_m
    return ForeignDraw(
        entry_m_s=_entry_m_s(plant, float(u[0])),
        friction=_lognormal(brake.cut_cv, float(friction_z)),
        resistance=_lognormal(plant.cut.resistance_cv, float(resistance_z)),
        wave_numbers_per_m=2.0 * np.pi / (shortest * (longest / shortest) ** length_u),
        phases=2.0 * np.pi * phase_u,
        first_sample_s=float(u[1]) * plant.sensor.period_s,
        valve_jitter_s=plant.drive.delay_jitter_s * (2.0 * jitter_u - 1.0),
        radar_z=radar,
        path_z=path,
        gauge_z=gauge,
    )


def _entry_m_s(plant: ForeignPlant, u: float) -> float:
    """The inverse of the distribution function at `u`."""
    entry = plant.entry
    law = NormalDist(entry.mean_m_s, entry.std_m_s)
    below, above = law.cdf(entry.low_m_s), law.cdf(entry.high_m_s)
    return min(max(law.inv_cdf(below + (above - below) * u), entry.low_m_s), entry.high_m_s)


def _lognormal(cv: float, z: float) -> float:
    """A lognormal number of mean 1 and this coefficient of variation for the standard normal `z`."""
    variance = math.log1p(cv * cv)
    return math.exp(math.sqrt(variance) * z - 0.5 * variance)
