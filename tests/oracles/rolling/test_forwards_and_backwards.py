"""What must hold of every roll: one way is the other, more speed gets farther, neighbours and threads do not count."""

from __future__ import annotations

import os

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plant_models import TrackProfile
from plant_models.rolling.roll_track import Bend, RollTrack
from scripts.studies.rolling.cases import CASES, COUPLING_M_S, PARK_EXIT_M
from synth.simulation.free_roll import rolling_cuts
from tests.effort import sized
from tests.oracles.rolling.made_cuts import START_M, cuts, random_cuts, random_track, rolling

SEEDS = st.integers(0, 2**32 - 1)


@given(SEEDS, st.integers(1, 8))
@settings(max_examples=sized(7, 30))
def test_forwards_from_the_speed_found_backwards_a_cut_arrives_with_the_coupling_speed(seed: int, cars: int) -> None:
    """Or, where a hump of the track decides, faster: then it hardly crawls over it. A little slower, it stops before or
    arrives slower; from rest, where 0 was found, it arrives too fast."""
    rng, n = np.random.default_rng(seed), 32
    track = random_track(rng)
    made = rolling(random_cuts(rng, n, cars, len(track.bends)), track)
    start = rng.uniform(250.0, 400.0, n)
    arrival = start + rng.uniform(5.0, 400.0, n)
    found = made.roll_back(arrival, COUPLING_M_S, start)
    way = start[:, None] + (arrival - start)[:, None] * np.linspace(0.0, 1.0, 81)[1:]
    rolled = made.roll_on(start, found, way)
    slowest, last = rolled.speed_m_s.min(axis=1), rolled.speed_m_s[:, -1]
    plain = (found > 0.0) & (slowest > 0.3)
    np.testing.assert_allclose(last[plain], COUPLING_M_S, atol=2e-3)
    slower = made.roll_on(start, 0.97 * found, arrival[:, None])
    assert np.all(slower.speed_m_s[found > 0.3] < COUPLING_M_S)
    from_rest = made.roll_on(start, np.full(n, 0.02), arrival[:, None]).speed_m_s[:, 0]
    assert np.all(from_rest[found == 0.0] > COUPLING_M_S)


@given(SEEDS, st.integers(1, 5))
@settings(max_examples=sized(5, 20))
def test_a_faster_start_is_a_faster_arrival_and_a_farther_stop(seed: int, cars: int) -> None:
    rng = np.random.default_rng(seed)
    track, n = random_track(rng), 40
    made = rolling(random_cuts(rng, 1, cars, len(track.bends)).chosen(np.zeros(n, dtype=np.int64)), track)
    start, speeds = np.full(n, 300.0), np.linspace(0.1, 5.0, n)
    rolled = made.roll_on(start, speeds, np.full((n, 1), 600.0))
    assert np.all(np.diff(rolled.speed_m_s[:, 0]) >= 0.0)
    assert np.all(np.diff(rolled.stop_m[np.isfinite(rolled.stop_m)]) > 0.0)
    assert np.all(np.diff(rolled.time_s[np.isfinite(rolled.time_s[:, 0]), 0]) < 0.0)
    back = np.array([made.roll_back(np.full(n, 600.0), v, start)[0] for v in np.linspace(0.2, 3.0, 15)])
    assert np.all(np.diff(back) >= -2e-3)  # where a hump of the track decides, only the error of the steps is left


def test_a_hump_of_the_track_decides() -> None:
    """2 permille up for 50 m, then 4 down: a cut that crawls over the top arrives too fast, so it must stop before it.

    The speed that just carries a cut without resistance to the top follows from the head of the top alone.
    """
    track = RollTrack(TrackProfile((0.0, 400.0, 450.0), (0.0, -2.0, 4.0)), 1000.0)
    made = rolling(cuts([0.0]), track)
    car = made.cuts.mix.cars[0].car
    behind = (car.length_m - car.axle_offsets_m[-1]) / 2.0 + np.array(car.axle_offsets_m)
    heads = np.linspace(400.0, 480.0, 16_001)
    top = -track.fall_m(heads[:, None] - behind).mean(axis=1).min()
    found = made.roll_back(np.array([800.0]), COUPLING_M_S, np.array([380.0]))[0]
    gravity = made.cuts.reduced_gravity_m_s2[0]
    assert found == pytest.approx(np.sqrt(2.0 * gravity * top), abs=1e-3)
    below, above = (made.roll_on(np.array([380.0]), np.array([found + d]), np.array([[800.0]])) for d in (-0.01, 0.01))
    assert below.speed_m_s[0, 0] == 0.0
    assert above.speed_m_s[0, 0] > COUPLING_M_S


def test_a_short_hump_of_the_track_is_not_jumped_over() -> None:
    """20 m up by 4 permille and 20 m down: by the head of its top, 1 % slower stops and 1 % faster goes on."""
    track = RollTrack(TrackProfile((0.0, 400.0, 420.0, 440.0), (1.0, -3.0, 5.0, 1.0)), 1000.0)
    made = rolling(cuts([1.0]), track)
    heads = np.linspace(380.0, 480.0, 4001)
    height = np.array([made.fall_m(np.array([x]))[0] for x in heads]) - 1e-3 * heads
    top = made.fall_m(np.array([350.0]))[0] - 0.35 - height.min()
    needed = np.sqrt(2.0 * made.cuts.reduced_gravity_m_s2[0] * top)
    for share, goes_on in ((0.99, False), (1.01, True)):
        rolled = made.roll_on(np.array([350.0]), np.array([share * needed]), np.array([[700.0]]))
        assert bool(np.isinf(rolled.stop_m[0])) == goes_on


def test_a_bend_can_hold_a_cut_that_would_start_by_itself_elsewhere() -> None:
    """1 permille less 0.5 N/kN wins 0.5e-3 m a metre; the bend takes 0.05 m. So a cut stops before its end, or not at
    all: what it has left at the start follows from the heads alone."""
    track = RollTrack(TrackProfile.uniform(1.0), 1000.0, (Bend(400.0, 430.0, 1, 5.0),))
    made = rolling(cuts([0.5], bend_v2=(0.0,), bend_head_m=(0.05,)), track)
    middle = 0.5 * made.cuts.car_lengths_m[0, 0]
    found = made.roll_back(np.array([700.0]), 0.3, np.array([380.0 + middle]))[0]
    head = 0.05 - 0.5e-3 * 50.0
    assert found == pytest.approx(np.sqrt(2.0 * made.cuts.reduced_gravity_m_s2[0] * head), abs=1e-3)
    steeper = rolling(cuts([0.5], bend_v2=(0.0,), bend_head_m=(0.01,)), track)
    assert steeper.roll_back(np.array([700.0]), 0.3, np.array([380.0 + middle]))[0] == 0.0


def test_backwards_through_bends_is_forwards_turned_round() -> None:
    """Strong bends of both kinds in strong wind, so that the mean of v matters: by the steps in use, 1.5 mm/s."""
    bends = tuple(Bend(330.0 + 30.0 * k, 337.0 + 30.0 * k, 1, 5.0) for k in range(5))
    track = RollTrack(TrackProfile.uniform(4.0), 1000.0, bends)
    w0 = np.linspace(0.5, 2.5, 30).tolist()
    made = rolling(cuts(w0, air=0.1, wind_m_s=6.0, bend_v2=(5e-3,) * 5, bend_head_m=(0.05,) * 5), track)
    start, n = np.full(30, 325.0), 30
    arrival = np.linspace(400.0, 480.0, n)
    found = made.roll_back(arrival, COUPLING_M_S, start)
    rolls = found > 0.5
    assert rolls.sum() > 20
    forth = made.roll_on(start, found, arrival[:, None]).speed_m_s[:, 0]
    np.testing.assert_allclose(forth[rolls], COUPLING_M_S, atol=1.5e-3)


def test_light_cars_keep_the_promised_error_by_the_step_in_use() -> None:
    """1 mm/s above 0.3 m/s and 0.1 m at stops, wind with a standard deviation of 3 m/s, against steps of 0.1 m."""
    case, n = CASES[0], 6000
    made = case.rolling(1, 21, n)
    start = case.starts_m(made)
    stations = start[:, None] + np.array([50.0, 120.0, 250.0, 500.0])
    rolled, true = (made.roll_on(start, case.speeds_m_s(n), stations, *step) for step in ((), (0.1,)))
    fast, stopped = true.speed_m_s > 0.3, np.isfinite(true.stop_m)
    assert np.abs(rolled.speed_m_s - true.speed_m_s)[fast].max() < 0.4e-3
    assert np.array_equal(stopped, np.isfinite(rolled.stop_m))
    assert np.abs(rolled.stop_m[stopped] - true.stop_m[stopped]).max() < 0.1


def test_a_cut_at_rest_stays_where_it_is() -> None:
    rolled = rolling(cuts([1.0, 0.5])).roll_on(np.full(2, START_M), np.zeros(2), np.full((2, 2), START_M + 50.0))
    assert rolled.stop_m.tolist() == [START_M, START_M]
    assert not rolled.speed_m_s.any()


def test_a_station_where_the_roll_begins_has_its_speed_and_no_time() -> None:
    made = rolling(cuts([1.0, 2.0]))
    rolled = made.roll_on(np.full(2, START_M), np.array([2.0, 3.0]), np.full((2, 1), START_M))
    np.testing.assert_allclose(rolled.speed_m_s[:, 0], [2.0, 3.0], rtol=1e-14)
    assert not rolled.time_s.any()
    np.testing.assert_allclose(made.roll_back(np.full(2, START_M), 1.39, np.full(2, START_M)), 1.39, rtol=1e-14)


def test_a_speed_that_is_no_number_gives_none_and_ends() -> None:
    rolled = rolling(cuts([1.0])).roll_on(np.array([START_M]), np.array([np.nan]), np.array([[START_M + 50.0]]))
    assert np.isnan(rolled.speed_m_s[0, 0])


def test_no_cuts_roll_nowhere() -> None:
    made = rolling(cuts([1.0]).chosen(slice(0, 0)))
    nothing = np.empty(0)
    assert made.roll_on(nothing, nothing, np.empty((0, 3))).speed_m_s.shape == (0, 3)
    assert made.roll_back(nothing, 1.39, nothing).shape == (0,)


@pytest.mark.parametrize("cars", [1, 3])
def test_neither_threads_nor_neighbours_change_a_bit(cars: int, monkeypatch: pytest.MonkeyPatch) -> None:
    case, n = CASES[0], 3000
    made = case.rolling(cars, 5, n)
    start, speed = case.starts_m(made), case.speeds_m_s(n)
    stations = start[:, None] + np.array([40.0, 250.0, 500.0])
    found = []
    for threads in (1, 2, 4):
        monkeypatch.setattr(os, "cpu_count", lambda threads=threads: threads)
        rolled = made.roll_on(start, speed, stations)
        back = made.roll_back(stations[:, 1], COUPLING_M_S, start)
        found.append(b"".join(a.tobytes() for a in (rolled.speed_m_s, rolled.time_s, rolled.stop_m, back)))
    assert found[0] == found[1] == found[2]
    alone = np.arange(7, n, 397)
    some = rolling_cuts(case.population, case.track, PARK_EXIT_M, made.cuts.chosen(alone))
    again = some.roll_on(start[alone], speed[alone], stations[alone])
    assert again.stop_m.tobytes() == rolled.stop_m[alone].tobytes()
    assert again.speed_m_s.tobytes() == rolled.speed_m_s[alone].tobytes()
    assert some.roll_back(stations[alone, 1], COUPLING_M_S, start[alone]).tobytes() == back[alone].tobytes()


@pytest.mark.parametrize("cars", [1, 4])
def test_the_error_falls_at_least_with_the_square_of_the_step(cars: int) -> None:
    """Root mean square over drawn cuts, at steps of 12, 6 and 3 m against 0.1 m."""
    case, n = CASES[0], 2000
    made = case.rolling(cars, 3, n)
    start = case.starts_m(made)
    speed, stations = 2.0 + case.speeds_m_s(n), start[:, None] + np.array([240.0])
    true = made.roll_on(start, speed, stations, 0.1).speed_m_s
    back = made.roll_back(stations[:, 0], 2.0, start, 0.1)
    fast = true > 0.5
    errors = []
    for step in (12.0, 6.0, 3.0):
        forth = made.roll_on(start, speed, stations, step).speed_m_s[fast] - true[fast]
        errors.append(
            [np.sqrt(np.mean(each**2)) for each in (forth, made.roll_back(stations[:, 0], 2.0, start, step) - back)]
        )
    orders = np.log2(np.array(errors)[:-1] / np.array(errors)[1:])
    assert np.all(orders > 1.85), orders
