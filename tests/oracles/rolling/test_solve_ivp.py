"""The roll of random cuts on random tracks against scipy's solution of the equation of motion in time."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models.frozen_arrays import Floats
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.weather import Weather
from scripts.studies.rolling.by_scipy import acceleration, solved
from tests.effort import every, sized
from tests.oracles.rolling.made_cuts import random_cuts, random_track, rolling

YARD_FROM_M, SNOW = 400.0, 0.3
SLOW_M_S = 0.3


@pytest.mark.parametrize(
    ("law", "cars"), every(2, [(HumpNormLaw(), 2), (HumpNormLaw(), 5), (Tb10062Law(), 1), (Tb10062Law(), 8)])
)
def test_the_roll_is_that_of_the_equation_of_motion(law: ResistanceLaw, cars: int) -> None:
    """Speeds above 0.3 m/s to 1 mm/s, stops to 0.1 m, times to 0.1 % and 0.03 s: some cuts on a track."""
    rng, n = np.random.default_rng(100 + cars), sized(2, 4)
    track = random_track(rng)
    made = rolling(random_cuts(rng, n, cars, len(track.bends)), track, law, Weather(snow_n_per_kn=SNOW), YARD_FROM_M)
    start, speed = rng.uniform(150.0, 350.0, n), rng.uniform(0.8, 4.5, n)
    stations = start[:, None] + np.cumsum(rng.uniform(5.0, 120.0, (n, 7)), axis=1)
    rolled = made.roll_on(start, speed, stations)

    def extra(at: Floats) -> Floats:
        slope = np.where((at >= 0.0) & (at < YARD_FROM_M), law.slope_extra_n_per_kn, 0.0)
        return np.asarray(slope + np.where(at >= YARD_FROM_M, SNOW, 0.0))

    for i in range(n):
        a = acceleration(made.cuts, i, track, law.linear_n_per_kn, extra)
        true = solved(a, float(start[i]), float(speed[i]), stations[i])
        fast = true.speed_m_s > SLOW_M_S
        np.testing.assert_allclose(rolled.speed_m_s[i][fast], true.speed_m_s[fast], atol=1e-3)
        np.testing.assert_allclose(rolled.time_s[i][fast], true.time_s[fast], rtol=1e-3, atol=0.03)
        assert np.isinf(rolled.stop_m[i]) == np.isinf(true.stop_m)
        if np.isfinite(true.stop_m):
            assert rolled.stop_m[i] == pytest.approx(true.stop_m, abs=0.1)
            behind = stations[i] > true.stop_m
            assert not rolled.speed_m_s[i][behind].any()
            assert np.isinf(rolled.time_s[i][behind]).all()


@pytest.mark.parametrize("cars", every(2, [1, 4]))
def test_the_speed_rolled_backwards_arrives_by_the_equation_of_motion(cars: int) -> None:
    rng, n = np.random.default_rng(300 + cars), 6
    track = random_track(rng)
    made = rolling(random_cuts(rng, n, cars, len(track.bends)), track)
    start = rng.uniform(250.0, 350.0, n)
    arrival = start + rng.uniform(30.0, 300.0, n)
    found = made.roll_back(arrival, 1.39, start)
    assert (found > 0.0).sum() >= 3
    for i in np.flatnonzero(found > 0.0):
        a = acceleration(made.cuts, int(i), track, 0.0, np.zeros_like)
        true = solved(a, float(start[i]), float(found[i]), arrival[i : i + 1])
        assert true.speed_m_s[0] == pytest.approx(1.39, abs=2e-3)
    for i in np.flatnonzero(found == 0.0):
        a = acceleration(made.cuts, int(i), track, 0.0, np.zeros_like)
        assert solved(a, float(start[i]), 0.02, arrival[i : i + 1]).speed_m_s[0] > 1.39
