"""What a control expects of cuts, beside numpy; beside the simulation see `test_uneven_routes`."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models.rolling.roll_track import Weather
from synth.hump.planning.forecast import Expected, SpeedRange, Ways, from_crest
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.motion import Cars, KnownRolls, Moving, Push
from synth.hump.rolling.route_rolling import rolling_on
from synth.hump.rolling.train_cuts import TrainCuts, expected
from synth.hump.rolling.train_memory import Asked, TrainMemory
from synth.hump.trial.trial import HumpTrial
from tests.synth.hump.trains.made_trials import Day

Floats = NDArray[np.float64]

LONG = Day(cuts=1, cars_mean=8.0, most_cars=24)
SHORT = Day(cuts=1, cars_mean=1.8, most_cars=4)
STALLING = Day(cuts=1, weather=Weather(-20.0, 15.0, 0.0))
COUNT = 60
BRAKED_M2_S2 = 34.0
MOST_ENTRY_M_S = (6.6, 6.0, 5.0)


def single_cuts(trial: HumpTrial) -> tuple[TrainCuts, Expected, Moving, Push]:
    """One cut a train, as it is expected, let go at the crest."""
    made = trial.source.trains(0, COUNT)
    known = expected(made)
    rolls = rolling_on(trial.ways, made.population, known, 1)
    cars = Cars(rolls, np.arange(COUNT), made.route, known.resistance_n_per_kn)
    braked = np.full((COUNT, trial.routes.positions), BRAKED_M2_S2)
    axles = made.first_axle_m, made.last_axle_m
    own = Expected(cars, *axles, braked, KnownRolls(COUNT))
    start = Moving(0.5 * made.length_m, np.linspace(1.4, 3.0, COUNT), np.linspace(5.0, 9.0, COUNT))
    return made, own, start, Push(start.speed_m_s, made.length_m)


def choices_for(routes: HumpRoutes) -> tuple[SpeedRange, ...]:
    """Three exit speeds of each position, with limits of entry."""
    return tuple(SpeedRange(2.0 + 0.1 * q, 6.0 - q, 3, MOST_ENTRY_M_S[q], 1.0) for q in range(routes.positions))


def margins(ways: Ways, column: int, free_from_s: Floats, free_by_s: Floats) -> tuple[Floats, Floats, Floats]:
    """Margins ahead and behind and the arrival, worked out from the times of one combination."""
    count = len(free_from_s)
    told = ways.followed(np.full(count, column))
    with np.errstate(invalid="ignore"):
        ahead = np.where(np.isnan(told.first_in_s), np.inf, told.first_in_s - free_from_s)
        behind = np.where(np.isnan(told.last_out_s), np.inf, free_by_s - told.last_out_s)
    ahead, behind = (np.where(np.isnan(each), np.inf, each).min(axis=1) for each in (ahead, behind))
    return ahead, behind, told.exit_m_s.sum(axis=1)


@pytest.mark.parametrize("day", [SHORT, LONG, STALLING], ids=["short", "long", "stalling"])
@pytest.mark.parametrize("hump", ["large", "medium", "dumper"])
def test_every_combination_is_compared_by_its_own_times(day: Day, hump: str) -> None:
    trial = day.on(hump)
    routes, random = trial.routes, np.random.default_rng(3)
    _, own, start, push = single_cuts(trial)
    ways = from_crest(routes, own, start, push, choices_for(routes))
    shape = COUNT, routes.elements
    free_from, free_by = random.uniform(0.0, 60.0, shape), random.uniform(20.0, 90.0, shape)
    free_from[random.random(shape) < 0.3] = -np.inf
    found = ways.compared(free_from, free_by)
    assert found.ahead_s.shape == (COUNT, 3**routes.positions)
    for column in range(3**routes.positions):
        ahead, behind, total = margins(ways, column, free_from, free_by)
        np.testing.assert_allclose(found.ahead_s[:, column], ahead, atol=1e-9)
        np.testing.assert_allclose(found.behind_s[:, column], behind, atol=1e-9)
        np.testing.assert_allclose(found.speeds_m_s[:, column], total, atol=1e-12)


@pytest.mark.parametrize("hump", ["large", "medium"])
def test_the_last_choice_runs_fastest_and_entries_are_limited(hump: str) -> None:
    """`able` from speeds at the entrances, rolled one leg after the other."""
    trial = SHORT.on(hump)
    routes = trial.routes
    _, own, start, push = single_cuts(trial)
    of_all = choices_for(routes)
    found = from_crest(routes, own, start, push, of_all).compared(
        np.full((COUNT, routes.elements), -np.inf), np.full((COUNT, routes.elements), np.inf)
    )
    rolls, rows, way = own.cars.rolls, own.cars.rows, own.cars.routes
    resistance = own.cars.resistance_n_per_kn
    for column, places in enumerate(itertools.product(range(3), repeat=routes.positions)):
        head, speed, able, beyond = start.head_m, start.speed_m_s, np.ones(COUNT, bool), np.zeros(COUNT)
        fastest = start.speed_m_s
        for q, place in enumerate(places):
            to = routes.entrance_m[way, q] + own.first_axle_m
            comes = rolls.roll_on(rows, way, head, speed, to[:, None], resistance).speed_m_s[:, 0]
            most = rolls.roll_on(rows, way, head, fastest, to[:, None], resistance).speed_m_s[:, 0]
            leaves = routes.exit_m[way, q] + own.last_axle_m
            unbraked = rolls.roll_on(rows, way, to, most, leaves[:, None], resistance).speed_m_s[:, 0]
            speeds = of_all[q].speeds(np.maximum(unbraked, 0.1))
            beyond = np.maximum(beyond, of_all[q].least_entry_m_s - comes)
            beyond = np.maximum(beyond, comes - of_all[q].most_entry_m_s)
            without, leave = comes**2 + unbraked**2 - most**2 + 1e-6, speeds[:, place] ** 2
            able &= (leave <= without) & (leave >= without - BRAKED_M2_S2)
            head, speed, fastest = leaves, speeds[:, place], speeds[:, -1]
        assert (found.able[:, column] == able).mean() > 0.99, column
        np.testing.assert_allclose(found.beyond_m_s[:, column], beyond, atol=0.01)
    assert 0.02 < found.able.mean() < 0.995
    assert 0.1 < (found.beyond_m_s > 0.1).mean() < 0.95


class AsTold:
    """Commands as a forecast chose them; errors of the positions are none."""

    def __init__(self, exit_m_s: Floats) -> None:
        self.exit_m_s = exit_m_s

    def command(self, asked: Asked) -> Floats:
        """(n,)."""
        return np.asarray(self.exit_m_s[asked.lanes, asked.position])

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """At the crest."""
        return np.linspace(1.4, 3.0, COUNT)


def test_rolls_that_are_known_are_those_that_are_worked_out() -> None:
    """To the bit: the same questions to one memory, which has seen other speeds, routes and resistances, and anew."""
    trial = STALLING.on("medium")
    made, own, start, push = single_cuts(trial)
    random, changed = np.random.default_rng(3), np.arange(COUNT) % 3 == 0
    choices, own_n_per_kn = choices_for(trial.routes), own.cars.resistance_n_per_kn
    assert own_n_per_kn is not None
    for _ in range(4):
        speeds = np.where(changed, np.round(random.uniform(1.0, 3.4, COUNT), 1), start.speed_m_s)
        routes = np.where(random.random(COUNT) < 0.2, (made.route + 1) % len(trial.routes.routes), made.route)
        resistance = np.where(random.random(COUNT) < 0.2, 2.5, own_n_per_kn)
        some = np.flatnonzero(random.random(COUNT) < 0.8)
        cars = Cars(own.cars.rolls, some, routes[some], resistance[some])
        let_go = Moving(start.head_m[some], speeds[some], start.time_s[some])
        pushed = Push(push.before_m_s[some], push.apart_m[some])
        axles = own.first_axle_m[some], own.last_axle_m[some], own.braked_m2_s2[some]
        seen, fresh = (
            from_crest(trial.routes, Expected(cars, *axles, rolls), let_go, pushed, choices).legs
            for rolls in (own.rolled, KnownRolls(COUNT))
        )
        for name, known in seen._asdict().items():
            np.testing.assert_array_equal(known, getattr(fresh, name), err_msg=name)
    assert set(own.rolled.kept) == {("from the crest", 0, 1)} | {
        leg for q in range(trial.routes.positions) for leg in (("unbraked", q, 1), ("behind", q, 3))
    }
