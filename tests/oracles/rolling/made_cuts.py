"""Cuts whose every number a test chooses, and the track under them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plant_models import TrackProfile
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import DrawnCuts
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw
from plant_models.rolling.roll_track import Bend, RollTrack, Weather
from synth.simulation.free_roll import RollingCuts, rolling_cuts
from tests.plant_models.rolling.populations import FLAT, GONDOLA, LONG_TANK, TANK, population

Floats = NDArray[np.float64]

MIX = CarMix(
    (MixedCar(GONDOLA, 1.0, 11.6), MixedCar(TANK, 1.0, 10.5), MixedCar(FLAT, 1.0, 6.2), MixedCar(LONG_TANK, 1.0, 12.0))
)
EVEN = RollTrack(TrackProfile.uniform(1.0), 3000.0)
START_M = 300.0
"""Where heads start: long cuts stand wholly on the even track."""


def cuts(
    w0: Sequence[float],
    *,
    mass_t: float = 24.0,
    air: float = 0.0,
    wind_m_s: float = 0.0,
    bend_v2: Sequence[float] = (),
    bend_head_m: Sequence[float] = (),
) -> DrawnCuts:
    """Single gondolas, one for each resistance, N/kN; the rest is the same for all."""
    n = len(w0)
    return DrawnCuts(
        mix=MIX,
        types=np.zeros((n, 1), dtype=np.int64),
        mass_t=np.full((n, 1), mass_t),
        basic_n_per_kn=np.array(w0)[:, None],
        head_wind_m_s=np.full(n, wind_m_s),
        bend_v2_m_s2=np.tile(np.array(bend_v2, dtype=np.float64), (n, 1)),
        bend_head_m=np.tile(np.array(bend_head_m or np.zeros(len(bend_v2)), dtype=np.float64), (n, 1)),
        air_n_per_kn=np.full(n, air),
    )


def random_cuts(rng: np.random.Generator, n: int, cars: int, bends: int) -> DrawnCuts:
    """Cuts of all types, masses and runners between the best and the worst, in winds to ±8 m/s."""
    types = rng.integers(0, len(MIX.cars), (n, cars))
    tare, gross = (np.array([getattr(c.car, key) for c in MIX.cars])[types] for key in ("tare_t", "gross_t"))
    mass = tare + rng.random((n, cars)) * (gross - tare)
    return DrawnCuts(
        mix=MIX,
        types=types,
        mass_t=mass,
        basic_n_per_kn=rng.uniform(0.5, 4.0, (n, cars)),
        head_wind_m_s=rng.uniform(-8.0, 8.0, n),
        bend_v2_m_s2=rng.uniform(0.0, 6e-3, (n, bends)),
        bend_head_m=rng.uniform(0.0, 0.05, (n, bends)),
        air_n_per_kn=rng.uniform(0.2, 1.0, n) / mass.sum(axis=1),
    )


def random_track(rng: np.random.Generator) -> RollTrack:
    """A hump with a steep beginning, elements of 30 to 120 m, and bends of 10 to 40 m."""
    lengths = rng.uniform(30.0, 120.0, 9)
    starts = np.concatenate(([0.0], np.cumsum(lengths)))
    grades = (45.0, 20.0, 10.0, *rng.uniform(-1.0, 3.0, 7))
    places = 100.0 + 90.0 * np.arange(8) + rng.uniform(0.0, 40.0, 8)
    bends = tuple(Bend(float(a), float(a + rng.uniform(10.0, 40.0)), 1, 5.0) for a in places)
    return RollTrack(TrackProfile(tuple(starts.tolist()), tuple(float(g) for g in grades)), 1200.0, bends)


def rolling(
    drawn: DrawnCuts,
    track: RollTrack = EVEN,
    law: ResistanceLaw | None = None,
    weather: Weather | None = None,
    yard_from_m: float = 0.0,
) -> RollingCuts:
    """`drawn` on `track`; by the hump norm and without snow unless a test says otherwise."""
    people = population(MIX, law or HumpNormLaw(), weather or Weather(), track.bends)
    return rolling_cuts(people, track, yard_from_m, drawn)
