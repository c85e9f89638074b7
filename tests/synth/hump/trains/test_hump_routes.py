"""Routes, and cuts that roll on them.

Routes as arrays: places of the marks, what two routes share, and heads of cuts that pass places.
Cuts of different numbers of cars on routes: each must roll as it does alone on its own track.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models.hump import Signal, Switch
from plant_models.library import load_hump
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.roll_track import Weather
from synth.hump.rolling.hump_routes import HumpRoutes, Mark, hump_routes
from synth.hump.rolling.motion import Cars, Moving, Push, braked_evenly, rolled_free
from synth.hump.rolling.route_rolling import RouteRolling, rolling_on, route_ways
from synth.simulation.free_roll import Rolled, rolling_cuts
from tests.oracles.rolling.made_cuts import MIX
from tests.plant_models.hump.random_humps import random_hump, small_hump
from tests.plant_models.rolling.populations import MIX as OTHER_MIX
from tests.plant_models.rolling.populations import population
from tests.synth.hump.trains.bare_cuts import GRAVITY_M_S2, EvenFall
from tests.synth.hump.trains.humped_trains import route_rolling
from tests.synth.hump.trains.mixed_cuts import WIDEST, mixed_cuts, route, without_padding

HUMPS = [("large", 201), ("large-two-leads", 202), ("medium", 201), ("dumper", 201)]


def checked(routes: HumpRoutes) -> None:
    """Every array beside the elements of the routes."""
    for row, own in enumerate(routes.routes):
        elements = [each for each in own.elements[:-1] if not isinstance(each.vertex, Signal)]
        assert (routes.vertex[row, len(elements) :] == -1).all()
        assert np.isinf(routes.place_m[row, len(elements) :]).all()
        for column, each in enumerate(elements):
            place = routes.place_m[row, column]
            assert routes.numbers[routes.vertex[row, column]] == each.number
            assert place[Mark.FIRST_IN] == place[Mark.LAST_IN] == each.from_m
            assert place[Mark.FIRST_OUT] == place[Mark.LAST_OUT] == each.to_m
            points = isinstance(each.vertex, Switch)
            assert place[Mark.LAST_CLEAR] == (own.fouling_m(each.number) if points else each.to_m)
            assert routes.points[row, column] == (each.position if points else -1)
        held = np.flatnonzero(np.isfinite(routes.entrance_m[row]))
        assert held.tolist() == list(range(len(held)))
        for position in held:
            column = routes.retarder[row, position]
            assert routes.entrance_m[row, position] == elements[column].at_m
            assert routes.exit_m[row, position] <= routes.place_m[row, column, Mark.LAST_OUT]


@pytest.mark.parametrize(("name", "lead"), HUMPS)
def test_places_are_those_of_the_routes(name: str, lead: int) -> None:
    checked(hump_routes(load_hump(name).graph, lead))


def test_random_humps_have_their_places() -> None:
    for seed in range(40):
        graph = random_hump(seed)
        for lead in graph.leads:
            checked(hump_routes(graph, lead))


def test_routes_share_their_elements_up_to_the_switch_that_parts_them() -> None:
    """Tracks 1, 2 and 3: switch 1 to the left is track 1; to the right retarder 401 and switch 2."""
    routes = hump_routes(small_hump(), 201)
    one, two, three = (int(np.flatnonzero(routes.tracks == track)[0]) for track in (1, 2, 3))
    assert routes.shared(np.array([one, one, two, two]), np.array([two, one, three, two])).tolist() == [1, 1, 3, 3]


def rolling(fall: float, resisted: float = 0.0) -> Cars:
    """Two cuts, of which the second is resisted."""
    return Cars(EvenFall(fall, np.array([0.0, resisted])), np.array([0, 1]), np.array([0, 0]))


def test_free_rolls_pass_places_in_any_order() -> None:
    """10 m at 2 m/s; places behind the start or beyond the end are not on the way, those behind a stop are never
    passed: the second one loses 0.2 m/s² and stops after 10 m."""
    start = Moving(np.array([100.0, 100.0]), np.array([2.0, 2.0]), np.array([5.0, 7.0]))
    heads = np.array([[108.0, 100.0, 104.0, 121.0, 99.0], [112.0, 103.6, 100.0, 110.0, 120.0]])
    end, times = rolled_free(rolling(0.0, 0.2 / GRAVITY_M_S2), start, np.array([120.0, 120.0]), heads)
    np.testing.assert_allclose(times[0], [9.0, np.nan, 7.0, np.nan, np.nan])
    np.testing.assert_allclose(times[1], [np.inf, 7.0 + 2.0, np.nan, 17.0, np.inf])
    assert end.head_m.tolist() == [120.0, 110.0]
    assert end.speed_m_s.tolist() == [2.0, 0.0]
    assert end.time_s.tolist() == [15.0, np.inf]


def test_an_even_brake_keeps_the_balance_of_energy_and_time() -> None:
    start = Moving(np.array([0.0, 0.0]), np.array([6.0, 6.0]), np.array([1.0, 1.0]))
    exits, to = np.array([3.0, 0.0]), np.array([30.0, 30.0])
    duration = np.array([2.0 * 30.0 / (6.0 + 3.0), np.inf])
    heads = np.tile(np.linspace(0.0, 30.0, 200), (2, 1))
    end, times = braked_evenly(start, to, exits, duration, heads)
    assert np.isinf(times[1, 1:]).all()
    assert end.head_m.tolist() == [30.0, 0.0]
    assert end.time_s.tolist() == [pytest.approx(1.0 + 60.0 / 9.0), np.inf]
    speed = np.sqrt(36.0 - 27.0 * heads[0] / 30.0)
    slowness = np.cumsum(0.5 * (1.0 / speed[1:] + 1.0 / speed[:-1]) * np.diff(heads[0]))
    np.testing.assert_allclose(times[0, 1:] - 1.0, slowness, rtol=1e-5)


def test_a_train_is_pushed_at_an_even_rate() -> None:
    """From 2 m/s to 3 m/s on 15 m: half of the way is over at √6.5 m/s; farther back at 2 m/s."""
    start = Moving(np.array([10.0]), np.array([3.0]), np.array([100.0]))
    times = Push(np.array([2.0]), np.array([15.0])).times_s(start, np.array([[10.0, 2.5, -5.0, 10.1]]))
    expected = [100.0, 100.0 - 15.0 / (3.0 + np.sqrt(6.5)), 100.0 - 30.0 / 5.0, np.nan]
    np.testing.assert_allclose(times[0], expected)


Floats = NDArray[np.float64]
ROUTES = (route("large", 7), route("medium", 3), route("dumper", 8))
BENDS = 6
N, LANES = 60, 400


def people(law: ResistanceLaw | None = None, weather: Weather | None = None) -> CutPopulation:
    """The mix of the made cuts."""
    return population(MIX, law or HumpNormLaw(), weather or Weather())


def asked(seed: int, cuts: DrawnCuts) -> tuple[NDArray[np.int64], NDArray[np.int64], Floats, Floats, Floats]:
    """Lanes: cuts, routes, starts, speeds and stations; on the hump and far into the yard, some of them stop."""
    rng = np.random.default_rng(seed)
    rows, routes = rng.integers(0, len(cuts), LANES), rng.integers(0, len(ROUTES), LANES)
    start = rng.uniform(5.0, 200.0, LANES)
    stations = start[:, None] + np.sort(rng.uniform(0.0, 320.0, (LANES, 4)), axis=1)
    return rows, routes, start, rng.uniform(0.3, 4.0, LANES), stations


def same(a: Rolled, b: Rolled) -> None:
    """The same bytes."""
    for name in ("speed_m_s", "time_s", "stop_m"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


@pytest.mark.parametrize(
    ("law", "weather"),
    [(HumpNormLaw(), Weather()), (Tb10062Law(), Weather(temperature_c=-10.0, snow_n_per_kn=0.5))],
)
def test_each_cut_rolls_on_its_route_as_alone_on_the_track(law: ResistanceLaw, weather: Weather) -> None:
    cuts, crowd = mixed_cuts(np.random.default_rng(1), N, BENDS), people(law, weather)
    rows, routes, start, speed, stations = asked(2, cuts)
    rolled = route_rolling(crowd, ROUTES, cuts).roll_on(rows, routes, start, speed, stations)
    compared = 0
    for place, each in enumerate(ROUTES):
        for cars in range(1, WIDEST + 1):
            lanes = np.flatnonzero((routes == place) & (cuts.cars_of_cut[rows] == cars))
            if len(lanes) == 0:
                continue
            alone = without_padding(cuts, rows[lanes]).on_bends(law, each.roll_track.bends)
            made = rolling_cuts(crowd, each.roll_track, each.yard_from_m, alone)
            true = made.roll_on(start[lanes], speed[lanes], np.minimum(stations[lanes], each.length_m))
            fast = true.speed_m_s > 0.3  # a slower cut stops soon: there the last bits of the energy count more
            np.testing.assert_allclose(rolled.speed_m_s[lanes] ** 2, true.speed_m_s**2, rtol=1e-12, atol=1e-12)
            np.testing.assert_allclose(rolled.time_s[lanes][fast], true.time_s[fast], rtol=1e-12)
            np.testing.assert_allclose(rolled.stop_m[lanes], true.stop_m, rtol=1e-12)
            compared += len(lanes)
    assert compared == LANES
    assert 0.03 < np.isfinite(rolled.stop_m).mean() < 0.7  # both kinds are among them


def test_a_rerouted_cut_rolls_to_the_parting_as_on_its_own_route() -> None:
    """Two tracks of the medium hump, with 4 and 5 bends: the same bytes ahead of the parting, others behind it."""
    pair = route("medium", 2), route("medium", 10)
    assert len({len(each.roll_track.bends) for each in pair}) == 2
    shared = [
        a for a, b in zip(*(each.elements for each in pair), strict=False) if (a.number, a.at_m) == (b.number, b.at_m)
    ]
    parting_m = max(each.at_m for each in shared)
    cuts = mixed_cuts(np.random.default_rng(3), N, BENDS)
    rolling = route_rolling(people(), pair, cuts)
    rows = np.arange(N)
    stations = np.tile(np.append(np.linspace(20.0, parting_m, 9), 0.5 * (parting_m + pair[0].length_m)), (N, 1))
    own, other = (rolling.roll_on(rows, np.full(N, r), np.full(N, 10.0), np.full(N, 3.0), stations) for r in (0, 1))
    np.testing.assert_array_equal(own.speed_m_s[:, :9], other.speed_m_s[:, :9])
    np.testing.assert_array_equal(own.time_s[:, :9], other.time_s[:, :9])
    assert np.all(own.speed_m_s[:, 9] != other.speed_m_s[:, 9])


def test_neither_neighbours_nor_threads_change_a_bit() -> None:
    cuts = mixed_cuts(np.random.default_rng(4), N, BENDS)
    rolling = route_rolling(people(), ROUTES, cuts, threads=1)
    arrays = [np.concatenate(parts) for parts in zip(*(asked(seed, cuts) for seed in range(5)), strict=True)]
    all_of = rolling.roll_on(*arrays)
    same(all_of, replace(rolling, threads=2).roll_on(*arrays))
    some = np.random.default_rng(5).permutation(len(arrays[0]))[:77]
    few = rolling.roll_on(*(array[some] for array in arrays))
    same(few, Rolled(all_of.speed_m_s[some], all_of.time_s[some], all_of.stop_m[some]))


def test_another_resistance_is_that_of_a_cut_that_has_it() -> None:
    cuts = mixed_cuts(np.random.default_rng(6), N, BENDS)
    rows, routes, start, speed, stations = asked(7, cuts)
    told = np.random.default_rng(8).uniform(0.5, 4.0, N)
    other = replace(cuts, basic_n_per_kn=np.tile(told[:, None], (1, WIDEST)))
    as_told = route_rolling(people(), ROUTES, cuts).roll_on(rows, routes, start, speed, stations, told[rows])
    as_has = route_rolling(people(), ROUTES, other).roll_on(rows, routes, start, speed, stations)
    rolls = as_has.speed_m_s > 0.1
    np.testing.assert_allclose(as_told.speed_m_s[rolls], as_has.speed_m_s[rolls], rtol=1e-10)


def one(rolling: RouteRolling, start: float, speed: float, stations: list[float], route_place: int = 2) -> Rolled:
    """One cut."""
    arrays = np.array([start]), np.array([speed]), np.array([stations])
    return rolling.roll_on(np.array([0]), np.array([route_place]), *arrays)


def test_stations_beyond_the_end_and_behind_the_cut_are_harmless() -> None:
    rolling = route_rolling(people(), ROUTES, mixed_cuts(np.random.default_rng(9), 1, BENDS))
    end = ROUTES[2].length_m
    plain = one(rolling, 60.0, 3.0, [100.0, 200.0, end])
    odd = one(rolling, 60.0, 3.0, [50.0, 60.0, 100.0, 100.0, 200.0, end + 1.0, np.inf])
    assert odd.speed_m_s[0].tolist()[:2] == pytest.approx([3.0, 3.0], rel=1e-15)
    assert odd.time_s[0].tolist()[:2] == [0.0, 0.0]
    np.testing.assert_array_equal(odd.speed_m_s[0, [2, 3, 4, 5, 6]], plain.speed_m_s[0, [0, 0, 1, 2, 2]])
    np.testing.assert_array_equal(odd.time_s[0, [2, 3, 4, 5, 6]], plain.time_s[0, [0, 0, 1, 2, 2]])
    stands = one(rolling, 60.0, 0.0, [60.0, 100.0])
    assert stands.stop_m[0] == 60.0
    assert np.isinf(stands.time_s).all()
    none = rolling.roll_on(*(np.empty(0, dtype=np.int64),) * 2, *(np.empty(0),) * 2, np.empty((0, 3)))
    assert none.speed_m_s.shape == (0, 3)


def test_what_cannot_be_rolled_is_refused() -> None:
    cuts = mixed_cuts(np.random.default_rng(10), 1, BENDS)
    rolling = route_rolling(people(), ROUTES, cuts)
    for start, speed in ((np.nan, 1.0), (np.inf, 1.0), (1.0, np.nan)):
        with pytest.raises(ValueError, match="must be finite"):
            one(rolling, start, speed, [100.0])
    ways = route_ways(people(), ROUTES, OTHER_MIX)
    with pytest.raises(ValueError, match="of the mix of the routes"):
        rolling_on(ways, people(), cuts)
    with pytest.raises(ValueError, match="draws for 6 bends"):
        route_rolling(people(), ROUTES, mixed_cuts(np.random.default_rng(11), 1, 5))


def test_routes_that_fall_alike_share_their_tables() -> None:
    graph_routes = tuple(route("large", track) for track in (1, 2, 17, 32))
    ways = route_ways(people(), (*graph_routes, route("dumper", 1)))
    assert ways.way.fall_m.shape[0] == 2 * len(MIX.cars)
    assert len(set(ways.rows.rows_from[:4].tolist())) == 1
