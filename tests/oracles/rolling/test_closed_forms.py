"""The roll against what can be solved by hand, the balance of all energy, and scipy's solution in time."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from plant_models import TrackProfile
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.roll_track import Bend, RollTrack, Weather
from scripts.studies.rolling.beside import acceleration, solved
from synth.simulation.free_roll import RollingCuts
from tests.effort import every, sized
from tests.oracles.rolling.made_cuts import EVEN, MIX, START_M, Floats, cuts, random_cuts, random_track, rolling

STATIONS_M = START_M + np.array([10.0, 55.5, 140.0, 333.0, 700.0])


def gravity(made: RollingCuts) -> Floats:
    """g' of a gondola, by the formula."""
    return np.asarray(9.81 / (1.0 + 0.42 * 4 / made.cuts.mass_t[:, 0]))


def roll(made: RollingCuts, speed_m_s: float, stations_m: Floats = STATIONS_M) -> tuple[Floats, Floats, Floats]:
    """Speeds, times and stops from `START_M`."""
    n = len(made)
    rolled = made.roll_on(np.full(n, START_M), np.full(n, speed_m_s), np.tile(stations_m, (n, 1)))
    return rolled.speed_m_s, rolled.time_s, rolled.stop_m


def test_constant_grade_and_resistance() -> None:
    w = np.array([0.2, 1.0, 1.3, 2.0, 4.0])
    made = rolling(cuts(w.tolist()))
    acceleration = gravity(made) * (1.0 - w) * 1e-3
    square = 9.0 + 2.0 * acceleration[:, None] * (STATIONS_M - START_M)
    speed, time, stop = roll(made, 3.0)
    expected = np.sqrt(np.maximum(square, 0.0))
    np.testing.assert_allclose(speed, expected, atol=1e-9)
    rolls = square > 0.0
    np.testing.assert_allclose(time[rolls], (2.0 * (STATIONS_M - START_M) / (3.0 + expected))[rolls], rtol=1e-9)
    assert np.isinf(time[~rolls]).all()
    stops = np.flatnonzero(~rolls[:, -1])
    assert len(stops) == 2
    np.testing.assert_allclose(stop[stops], START_M - 4.5 / acceleration[stops], atol=1e-6)
    assert np.isinf(stop[rolls[:, -1]]).all()


def test_backwards_with_constant_grade_and_resistance() -> None:
    w = np.array([0.2, 0.9, 1.0, 1.3, 2.0, 4.0])
    made = rolling(cuts(w.tolist()))
    found = made.roll_back(np.full(6, START_M + 250.0), 1.39, np.full(6, START_M))
    square = 1.39**2 - 2.0 * gravity(made) * (1.0 - w) * 1e-3 * 250.0
    np.testing.assert_allclose(found, np.sqrt(np.maximum(square, 0.0)), atol=1e-9)
    assert found[0] == 0.0
    assert np.all(found[1:] > 0.0)


def test_air_without_wind_makes_the_energy_an_exponential() -> None:
    """e' = g'·((i − w)·1e-3 − 2·c·e) with c = 1e-3·air."""
    made = rolling(cuts([0.2, 1.0, 1.6, 3.0], air=0.04))
    c, drive = 0.04e-3, (1.0 - np.array([0.2, 1.0, 1.6, 3.0])) * 1e-3
    limit, rate = drive / (2.0 * c), 2.0 * gravity(made) * c
    way = STATIONS_M - START_M
    energy = limit[:, None] + (4.5 - limit[:, None]) * np.exp(-rate[:, None] * way)
    speed, _, stop = roll(made, 3.0)
    np.testing.assert_allclose(speed, np.sqrt(2.0 * np.maximum(energy, 0.0)), atol=2e-5)
    for i in (2, 3):
        assert stop[i] == pytest.approx(START_M + np.log((4.5 - limit[i]) / -limit[i]) / rate[i], abs=2e-3)
    back = made.roll_back(np.full(4, START_M + 200.0), 1.39, np.full(4, START_M))
    square = 2.0 * (limit + (0.5 * 1.39**2 - limit) * np.exp(rate * 200.0))
    np.testing.assert_allclose(back, np.sqrt(np.maximum(square, 0.0)), atol=2e-5)


def test_air_with_wind_and_the_speed_that_it_leads_to() -> None:
    """On an even grade the cut ends at the speed where grade and resistance are equal, with the wind and against it."""
    long = RollTrack(TrackProfile.uniform(4.0), 9900.0)
    for wind in (-4.0, 0.0, 1.0):
        made = rolling(cuts([2.5], air=0.3, wind_m_s=wind), long)
        end = made.roll_on(np.array([START_M]), np.array([2.0]), np.array([[9800.0]])).speed_m_s[0, 0]
        assert end + wind == pytest.approx(np.sqrt(1.5 / 0.3), abs=1e-6)


def test_a_wind_from_behind_that_is_faster_pushes() -> None:
    """dx = v·dv / (g'·((i − w)·1e-3 + c·(8 − v)²)), integrated from the first to the last speed, is the way."""
    made = rolling(cuts([1.5], air=0.05, wind_m_s=-8.0))
    end = float(roll(made, 1.0, START_M + np.array([60.0]))[0][0, 0])
    assert end > 1.0

    def way_per_speed(v: float) -> float:
        return v / (float(gravity(made)[0]) * 1e-3 * (1.0 - 1.5 + 0.05 * (8.0 - v) ** 2))

    assert quad(way_per_speed, 1.0, end)[0] == pytest.approx(60.0, abs=6e-3)


def test_resistance_linear_in_the_speed() -> None:
    """v' = a − b·v: v and x are exponentials of time."""
    made = rolling(cuts([1.9]), law=Tb10062Law())
    g = float(gravity(made)[0])
    a, b = g * (1.0 - 1.9) * 1e-3, g * 0.1e-3

    def state(t: float) -> tuple[float, float]:
        fall = np.exp(-b * t)
        return 3.0 * fall + a / b * (1.0 - fall), START_M + 3.0 / b * (1.0 - fall) + a / b * (t - (1.0 - fall) / b)

    at_stop = np.log(1.0 - 3.0 * b / a) / b
    speed, time, stop = roll(made, 3.0)
    assert stop[0] == pytest.approx(state(at_stop)[1], abs=2e-3)
    for k, station in enumerate(STATIONS_M[:4]):
        t = brentq(lambda t, s=station: state(t)[1] - s, 0.0, at_stop, xtol=1e-12)
        assert speed[0, k] == pytest.approx(state(t)[0], abs=2e-5)
        assert time[0, k] == pytest.approx(t, rel=1e-5)


def test_a_bend_takes_its_head_from_each_car_as_its_middle_passes() -> None:
    track = RollTrack(EVEN.profile, EVEN.end_m, (Bend(400.0, 430.0, 1, 10.0), Bend(500.0, 520.0, 1, 10.0)))
    made = rolling(cuts([1.0], bend_v2=(4e-3, 0.0), bend_head_m=(0.0, 0.03)), track)
    middle = 0.5 * made.cuts.car_lengths_m[0, 0]
    stations = np.array([400.0, 415.0, 430.0, 500.0, 515.0, 520.0]) + middle
    speed, _, _ = roll(made, 3.0, stations)
    g = gravity(made)[0]
    first = 4.5 * np.exp(-2.0 * g * 4e-3 * np.array([0.0, 0.5, 1.0, 1.0, 1.0, 1.0]))
    energy = first - g * 0.03 * np.array([0.0, 0.0, 0.0, 0.0, 0.75, 1.0])
    np.testing.assert_allclose(speed[0], np.sqrt(2.0 * energy), atol=2e-5)


def test_snow_lies_in_the_yard_and_the_slope_has_its_extra_resistance() -> None:
    made = rolling(cuts([0.0]), law=Tb10062Law(), weather=Weather(snow_n_per_kn=0.5), yard_from_m=600.0)
    bare = rolling(cuts([0.0]), law=Tb10062Law(), yard_from_m=0.0)
    g = gravity(made)[0]
    lengths = np.array([5.0, 10.0])
    for begin, extra in ((300.0, 0.39), (700.0, 0.5)):
        way = begin + lengths
        with_it, without = (
            each.roll_on(np.array([begin]), np.array([4.0]), way[None]).speed_m_s[0] ** 2 for each in (made, bare)
        )
        np.testing.assert_allclose(without - with_it, 2.0 * g * extra * 1e-3 * lengths, rtol=3e-3)


def test_a_car_rolls_down_axle_by_axle() -> None:
    """Across a break of grade the fall is the mean of those of its four axles."""
    track = RollTrack(TrackProfile((0.0, 350.0), (10.0, -10.0)), 1000.0)
    made = rolling(cuts([0.0]), track)
    heads = np.arange(340.0, 380.0, 0.7)
    car = MIX.cars[0].car
    overhang = (car.length_m - car.axle_offsets_m[-1]) / 2.0
    axles = heads[:, None] - overhang - np.array(car.axle_offsets_m)
    height = np.where(axles < 350.0, 10e-3 * axles, 7.0 - 10e-3 * axles).mean(axis=1)
    begin = (10e-3 * (START_M - overhang - np.array(car.axle_offsets_m))).mean()
    speed, _, _ = roll(made, 2.0, heads)
    np.testing.assert_allclose(speed[0], np.sqrt(4.0 + 2.0 * gravity(made)[0] * (height - begin)), atol=5e-4)
    np.testing.assert_allclose([made.fall_m(np.array([x]))[0] for x in heads], height, atol=7e-5)


@pytest.mark.parametrize("cars", [1, 2, 5, 8])
def test_all_energy_is_accounted_for(cars: int) -> None:
    """Kinetic energy over g' falls by the height won, less the work of rolling, air and bends, each summed up apart
    from the speeds at stations 1 m apart."""
    rng = np.random.default_rng(cars)
    track = random_track(rng)
    made = rolling(random_cuts(rng, 60, cars, len(track.bends)), track)
    drawn, begin = made.cuts, 60.0
    heads = begin + np.arange(0.0, 701.0)
    speed = made.roll_on(np.full(60, begin - 1.0), np.full(60, 4.0), np.tile(heads, (60, 1))).speed_m_s
    kinetic = 0.5 * speed**2 / drawn.reduced_gravity_m_s2[:, None]
    shares, length = drawn.mass_t / drawn.mass_t.sum(axis=1, keepdims=True), drawn.car_lengths_m
    height, bends = np.zeros_like(speed), np.zeros_like(speed)
    for i in range(60):
        front = 0.0
        for j in range(cars):
            car = MIX.cars[drawn.types[i, j]].car
            first = front + (car.length_m - car.axle_offsets_m[-1]) / 2.0
            axles = heads[:, None] - first - np.array(car.axle_offsets_m)
            height[i] += shares[i, j] * track.fall_m(axles).mean(axis=1)
            middle = heads - front - 0.5 * length[i, j]
            for b, bend in enumerate(track.bends):
                passed = np.clip((middle - bend.from_m) / (bend.to_m - bend.from_m), 0.0, 1.0)
                square = 0.5 * (speed[i, 1:] ** 2 + speed[i, :-1] ** 2)
                lost = np.diff(passed) * (drawn.bend_v2_m_s2[i, b] * square + drawn.bend_head_m[i, b])
                bends[i, 1:] += shares[i, j] * np.cumsum(lost)
            front += car.length_m
    against = speed + drawn.head_wind_m_s[:, None]
    force = 1e-3 * drawn.air_n_per_kn[:, None] * against * np.abs(against)
    air = np.zeros_like(speed)
    air[:, 1:] = np.cumsum(0.5 * (force[:, 1:] + force[:, :-1]), axis=1)
    rolled = 1e-3 * (shares * drawn.basic_n_per_kn).sum(axis=1)[:, None] * (heads - begin)
    missing = (kinetic - kinetic[:, :1]) - (height - height[:, :1]) + rolled + air + bends
    fast = np.minimum.accumulate(speed, axis=1) > 0.5
    assert fast.sum() > 10_000
    assert np.abs(missing[fast]).max() < 3e-4


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
