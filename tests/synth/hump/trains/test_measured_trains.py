"""What is measured of the cuts of drawn trains on the large hump, by the kernel that rolls them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models.rolling.resistance_law import HumpNormLaw, Tb10062Law
from synth.aim.knowledge import ByCategory, Requirement
from synth.aim.position_models import NormalPosition
from synth.hump.trains.aim_control import AimControl, ReadAhead
from synth.hump.trains.aim_design import CARS, AimDesign, MeasuredAhead, hump_aim
from synth.hump.trains.asked import Asked
from synth.hump.trains.expected_way import ExpectedWay
from synth.hump.trains.motion import Cars, Moving, rolled_free
from synth.hump.trains.resistance_prior import bend_spreads, resistance_prior
from synth.hump.trains.rollability import MeasuredRollability, measured_rollability
from synth.hump.trains.speed_sensors import SpeedSensors
from synth.hump.trains.train_cuts import TrainCuts, expected, trains
from synth.hump.trains.train_memory import TrainMemory
from tests.plant_models.rolling.populations import MIX, population
from tests.synth.hump.trains.asked_cuts import large
from tests.synth.hump.trains.rolling_cuts import route_rolling
from tests.synth.hump.trains.test_train_cuts import PEOPLE, TRAINS

Floats = NDArray[np.float64]

ROUTES = large()
COUNT = 4000
EXITS_M_S = (4.8, 4.2)


def asked_on_the_way(made: TrainCuts, position: int) -> Asked:
    """One cut of every train comes to `position`; it left those before with normal speeds about `EXITS_M_S`."""
    rows, random = np.arange(len(made)), np.random.default_rng(5)
    cars = Cars(route_rolling(made.population, ROUTES.routes, made.drawn), rows, made.route)
    memory, none = TrainMemory(len(made), 1, ROUTES), np.empty((len(made), 0))
    memory.crest_s[:], memory.hump_speed_m_s[:] = 0.0, 1.6
    moving = Moving(0.5 * made.length_m, np.full(len(made), 1.6), np.zeros(len(made)))
    for place in range(position + 1):
        entrance = ROUTES.entrance_m[made.route, place] + made.first_axle_m
        moving, _ = rolled_free(cars, moving, np.maximum(entrance, moving.head_m), none)
        if place < position:
            memory.begin_s[:, 0, place], memory.entry_m_s[:, 0, place] = moving.time_s, moving.speed_m_s
            leaves = ROUTES.exit_m[made.route, place] + made.last_axle_m
            speed = EXITS_M_S[place] + 0.3 * random.standard_normal(len(made))
            memory.exit_m_s[:, 0, place], memory.end_s[:, 0, place] = speed, moving.time_s + 5.0
            moving = Moving(leaves, speed, moving.time_s + 5.0)
    return Asked(0, position, rows, made.route, moving, np.full(len(made), 900.0), memory)


@cache
def drawn() -> TrainCuts:
    return trains(TRAINS, PEOPLE, ROUTES.routes, 7, 0, COUNT, 1)


def rollability(made: TrainCuts) -> MeasuredRollability:
    known = expected(made)
    way = ExpectedWay(
        route_rolling(made.population, ROUTES.routes, known), known.resistance_n_per_kn, known.reduced_gravity_m_s2
    )
    return measured_rollability(SpeedSensors(ROUTES, made, 0.1), made, way)


def ahead_n_per_kn(made: TrainCuts, speed_m_s: Floats) -> Floats:
    """Resistance with what the air takes beyond that of the mean wind."""
    mean, wind = PEOPLE.weather.head_wind_mean_m_s, made.drawn.head_wind_m_s
    above = (speed_m_s + wind) * np.abs(speed_m_s + wind) - (speed_m_s + mean) * np.abs(speed_m_s + mean)
    return np.asarray(made.drawn.resistance_n_per_kn + made.drawn.air_n_per_kn * above)


@pytest.mark.parametrize("position", [0, 1, 2])
def test_measured_trains_are_as_uncertain_as_they_say(position: int) -> None:
    made, measured = drawn(), rollability(drawn())
    asked = asked_on_the_way(made, position)
    true = ahead_n_per_kn(made, asked.start.speed_m_s)
    told = measured.expected(asked)
    before = measured.on_the_way(measured.before_the_crest(asked.lanes), asked.lanes, asked.start.speed_m_s)
    error = (told.mean_n_per_kn - true) / told.std_n_per_kn
    assert error.mean() == pytest.approx(0.0, abs=0.08)
    assert error.std() == pytest.approx(1.0, abs=0.08)
    assert (np.abs(error) < 1.96).mean() == pytest.approx(0.95, abs=0.02)
    gained = (told.mean_n_per_kn - true).var() / (before.mean_n_per_kn - true).var()
    assert gained == pytest.approx((told.std_n_per_kn**2).mean() / (before.std_n_per_kn**2).mean(), rel=0.12)


def aimed(knowledge: ByCategory | MeasuredAhead) -> tuple[NDArray[np.bool_], Floats]:
    """Whether the drawn cuts couple too fast that are aimed at places anywhere on their tracks, and their gaps."""
    made = drawn()
    position = NormalPosition(0.1, only_brakes=False)
    aim = hump_aim(ROUTES, AimDesign(made.population, position, Requirement(0.1, (0.5, 7.0)), knowledge))
    measured = isinstance(knowledge, MeasuredAhead)
    reading = ReadAhead(SpeedSensors(ROUTES, made, 0.1), rollability(made).way) if measured else None
    random, asked = np.random.default_rng(9), asked_on_the_way(made, 2)
    release = ROUTES.exit_m[made.route, 2] + made.last_axle_m
    arrival = random.uniform(release + 5.0, ROUTES.length_m[made.route])
    command = AimControl(aim, ROUTES, made, reading).command(replace(asked, free_m=arrival))
    leaves = np.maximum(command + 0.1 * random.standard_normal(COUNT), 0.0)
    rolls = route_rolling(made.population, ROUTES.routes, made.drawn)
    couples = rolls.roll_on(asked.lanes, made.route, release, leaves, arrival[:, None])
    return couples.speed_m_s[:, 0] > 5.0 / 3.6, np.where(np.isfinite(couples.stop_m), arrival - couples.stop_m, 0.0)


def test_aimed_trains_couple_too_fast_as_often_as_asked() -> None:
    alone, read = aimed(ByCategory()), aimed(MeasuredAhead(0.1))
    listed = np.isin(drawn().cars, CARS)
    chance = 3.5 * np.sqrt(0.09 * (1.0 / listed.sum() + 1.0 / 2000))  # all speeds are chosen on the same 2000 numbers
    for too_fast, _ in (alone, read):
        assert too_fast[listed].mean() == pytest.approx(0.1, abs=chance)
    spared = alone[1] - read[1]
    assert spared.mean() > 5.0 * spared.std() / np.sqrt(COUNT)


@pytest.mark.parametrize("law", [HumpNormLaw(), Tb10062Law()])
def test_prior_is_that_of_the_laws(law: HumpNormLaw | Tb10062Law) -> None:
    people = population(MIX, law=law, weather=PEOPLE.weather)
    made = trains(TRAINS, people, ROUTES.routes, 7, 0, COUNT, 1)
    prior, error = resistance_prior(ROUTES, made), made.drawn.resistance_n_per_kn - expected(made).resistance_n_per_kn
    for cars in (1, 2, 4):
        some = made.cars == cars
        assert (error[some] / prior.std_n_per_kn[some]).std() == pytest.approx(1.0, abs=5.0 / np.sqrt(2 * some.sum()))


def test_bends_spread_as_they_are_drawn() -> None:
    spread = bend_spreads(ROUTES, PEOPLE)
    for row in (0, 13):
        track = ROUTES.routes[row].roll_track
        cuts = population(MIX, bends=track.bends).draw(TRAINS.categories.members[0], 1, 3, 0, 20_000)
        middles = np.array([0.5 * (bend.from_m + bend.to_m) for bend in track.bends])
        begins = [0.0, *ROUTES.exit_m[row, :-1]]
        for position, (begin, end) in enumerate(zip(begins, ROUTES.entrance_m[row], strict=True)):
            heads = cuts.bend_v2_m_s2[:, (middles > begin) & (middles < end)].sum(axis=1)
            assert spread[row, position, 0] == pytest.approx(heads.std(), rel=0.03)
    assert (spread[..., 1] == 0.0).all()
