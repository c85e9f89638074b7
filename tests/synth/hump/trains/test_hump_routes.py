"""Routes as arrays: places of the marks, what two routes share, and heads of cuts that pass places."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models.hump import Signal, Switch
from plant_models.library import load_hump
from synth.hump.trains.hump_routes import HumpRoutes, Mark, hump_routes
from synth.hump.trains.meeting import first_of
from synth.hump.trains.motion import Cars, Moving, Push, braked_evenly, merged, rolled_free
from tests.plant_models.hump.random_humps import random_hump, small_hump
from tests.synth.hump.trains.bare_cuts import GRAVITY_M_S2, EvenFall

HUMPS = [("large", 201), ("large-two-leads", 202), ("medium", 201), ("dumper", 201)]


def checked(routes: HumpRoutes) -> None:
    """Every array beside the elements of the routes."""
    for row, route in enumerate(routes.routes):
        elements = [each for each in route.elements[:-1] if not isinstance(each.vertex, Signal)]
        assert (routes.vertex[row, len(elements) :] == -1).all()
        assert np.isinf(routes.place_m[row, len(elements) :]).all()
        for column, each in enumerate(elements):
            place = routes.place_m[row, column]
            assert routes.numbers[routes.vertex[row, column]] == each.number
            assert place[Mark.FIRST_IN] == place[Mark.LAST_IN] == each.from_m
            assert place[Mark.FIRST_OUT] == place[Mark.LAST_OUT] == each.to_m
            points = isinstance(each.vertex, Switch)
            assert place[Mark.LAST_CLEAR] == (route.fouling_m(each.number) if points else each.to_m)
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


def test_the_first_found_is_told_or_how_many_there_are() -> None:
    found = np.array([[False, True, True], [False, False, False]])
    assert first_of(found).tolist() == [1, 3]
    assert first_of(np.empty((2, 0), bool)).tolist() == [0, 0]


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


def test_some_of_all_are_replaced() -> None:
    every = Moving(np.zeros(3), np.ones(3), np.full(3, 2.0))
    some = Moving(np.array([7.0]), np.array([8.0]), np.array([9.0]))
    found = merged(every, some, np.array([False, True, False]))
    assert (found.head_m.tolist(), found.speed_m_s.tolist()) == ([0.0, 7.0, 0.0], [1.0, 8.0, 1.0])
    assert every.head_m.tolist() == [0.0, 0.0, 0.0]
