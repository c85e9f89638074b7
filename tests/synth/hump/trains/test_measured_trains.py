"""What is read of cuts, and the aim that takes it.

What is measured of the cuts of drawn trains on the large hump, by the kernel that rolls them.
The aim of the last position keeps its probability on fresh cuts; what it reads is the resistance of the cut.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models.hump import TrackSection
from plant_models.library.catalogue import load_car, load_weight_categories
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw, Tb10062Law
from plant_models.rolling.roll_track import Weather
from synth.aim.knowledge import ByCategory, Requirement
from synth.aim.position_models import NormalPosition
from synth.hump.planning.aim_control import AimControl, CategoryAim, HumpAim, ReadAhead
from synth.hump.planning.aim_design import CARS, AimDesign, MeasuredAhead, hump_aim
from synth.hump.planning.free_stretch import ExpectedWay, SpeedSensors
from synth.hump.planning.rollability import MeasuredRollability, bend_spreads, measured_rollability, resistance_prior
from synth.hump.rolling.motion import Cars, Moving, rolled_free
from synth.hump.rolling.train_cuts import TrainCuts, expected, trains
from synth.hump.rolling.train_memory import Asked, TrainMemory
from tests.plant_models.rolling.populations import MIX, population
from tests.synth.hump.trains.asked_cuts import (
    FIRST_M,
    GRADE,
    GRAVITY_M_S2,
    LAST_M,
    EvenSlope,
    alike_cuts,
    asked_at,
    large,
)
from tests.synth.hump.trains.humped_trains import route_rolling
from tests.synth.hump.trains.test_train_cuts import PEOPLE, TRAINS
from tuning_tables.aim import AimAxes
from tuning_tables.aim.axes import aim_grid

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


def test_a_speed_is_read_only_when_the_last_axle_is_out() -> None:
    measured, asked = rollability(drawn()), asked_on_the_way(drawn(), 1)
    memory, now_s = asked.memory, asked.start.time_s
    memory.end_s[:, 0, 0] = now_s + 1.0
    waits = measured.expected(asked).mean_n_per_kn
    memory.exit_m_s[:, 0, 0] += 0.5
    assert measured.expected(asked).mean_n_per_kn.tolist() == waits.tolist()
    memory.end_s[:, 0, 0] = now_s - 1.0
    assert (measured.expected(asked).mean_n_per_kn != waits).mean() > 0.5


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


CATEGORIES = load_weight_categories()
GONDOLAS_AND_TANKS = CarMix(
    (MixedCar(load_car("gondola-4").car, 0.7, 11.6), MixedCar(load_car("tank-4").car, 0.3, 9.0))
)
POSITION = NormalPosition(0.1, only_brakes=False)
DESIGN = AimDesign(
    CutPopulation(GONDOLAS_AND_TANKS, CATEGORIES, HumpNormLaw(), Weather()),
    POSITION,
    Requirement(0.1, (0.5, 7.0)),
    MeasuredAhead(0.1),
    cars=(1, 3, 5),
)


@cache
def aim() -> HumpAim:
    return hump_aim(ROUTES, DESIGN)


def test_expected_speed_is_that_of_the_mean_reading_where_cuts_are_measured() -> None:
    place = np.zeros(1, dtype=np.int64)
    asked = place, place + 2, place + 3, np.array([150.0])
    mean = np.array([aim().tables[0][2].mean_n_per_kn])
    assert aim().expected_m_s(*asked, measured=True) == aim().command_m_s(*asked, mean)
    assert aim().expected_m_s(*asked, measured=False) == aim().command_m_s(*asked)
    assert aim().command_m_s(*asked, mean) > aim().command_m_s(*asked)


def test_routes_share_speeds_where_their_tracks_are_alike() -> None:
    assert len(aim().tables) == 1
    first, *others = ROUTES.routes
    section = first.elements[-1].vertex
    assert isinstance(section, TrackSection)
    steep = replace(section, next=replace(section.next, grades=((0.0, 2.0),)))
    steeper = replace(first, elements=(*first.elements[:-1], replace(first.elements[-1], vertex=steep)))
    changed = replace(ROUTES, routes=(steeper, *others))
    design = replace(DESIGN, knowledge=ByCategory(), cars=(1,), design_cuts=200)
    found = hump_aim(changed, design)
    assert found.group.tolist() == [0] + [1] * len(others)
    steep_m_s, plain_m_s = (table[0].by_category.speed_m_s[0, 2:6, 0] for table in found.tables)
    assert (steep_m_s < plain_m_s - 0.02).all()


def test_threads_change_nothing() -> None:
    design = replace(DESIGN, cars=(1, 2), design_cuts=300)
    one, two = (hump_aim(ROUTES, replace(design, threads=threads)) for threads in (1, 2))
    for alone, beside in zip(one.tables[0], two.tables[0], strict=True):
        assert alone.measured is not None
        assert beside.measured is not None
        assert np.array_equal(alone.measured.speed_m_s, beside.measured.speed_m_s)


def linear_aim() -> HumpAim:
    """One group and category: exit speed = 1 + distance/100 + resistance/10; by category alone 0.7 + distance/100."""
    cars, distance, resistance = np.array([1]), np.array([0.0, 500.0]), np.array([-10.0, 50.0])
    plain = aim_grid(AimAxes(cars, distance), 0.7 + distance[None, :] / 100.0)
    speeds = 1.0 + distance[None, :, None] / 100.0 + resistance[None, None, :] / 10.0
    measured = aim_grid(AimAxes(cars, distance, resistance), speeds)
    return HumpAim(np.zeros(32, dtype=np.int64), ((CategoryAim(plain, measured),),), 0.4)


def test_command_by_hand() -> None:
    trains = alike_cuts(4, np.zeros(4, dtype=np.int64), np.ones(4, dtype=np.int64))
    own, mean = np.array([0.5, 1.5, 3.0, 1.0]), np.full(4, 1.3)
    memory = TrainMemory(4, 1, ROUTES)
    memory.exit_m_s[:, 0, 1], memory.end_s[:, 0, 1] = [5.0, 4.0, 3.0, np.nan], 50.0  # the last speed was not read
    slope = EvenSlope(own)
    begin, end = ROUTES.exit_m[0, 1] + LAST_M, ROUTES.entrance_m[0, 2] + FIRST_M
    rows = np.arange(4)
    rolled = slope.roll_on(rows[:3], rows, np.full(3, begin), memory.exit_m_s[:3, 0, 1], np.full((3, 1), end))
    comes = np.append(rolled.speed_m_s[:, 0], 4.0)
    release = ROUTES.exit_m[0, 2] + LAST_M
    free = release + np.array([100.0, 200.0, 50.0, 100.0])
    asked = asked_at(ROUTES, 2, memory, comes, free)
    way = ExpectedWay(slope, mean, np.full(4, GRAVITY_M_S2))
    exact = ReadAhead(SpeedSensors(ROUTES, trains, 1e-4), way)
    plain = AimControl(linear_aim(), ROUTES, trains)
    assert plain.command(asked) == pytest.approx([1.7, 2.7, 1.2, 1.7], abs=1e-6)
    assert replace(plain, reading=exact).command(asked) == pytest.approx([2.05, 3.15, 1.8, 1.7], abs=1e-3)
    near = replace(asked, free_m=np.full(4, release - 1.0))
    assert plain.command(near).tolist() == [0.4] * 4


def test_readings_scatter_as_they_say() -> None:
    count = 4000
    trains = alike_cuts(count, np.zeros(count, dtype=np.int64), np.ones(count, dtype=np.int64))
    own, gravity = np.full(count, 2.0), np.full(count, GRAVITY_M_S2)
    memory = TrainMemory(count, 1, ROUTES)
    memory.exit_m_s[:, 0, 1], memory.end_s[:, 0, 1] = 5.0, 50.0
    length = ROUTES.entrance_m[0, 2] + FIRST_M - ROUTES.exit_m[0, 1] - LAST_M
    square = 25.0 + 2.0 * GRAVITY_M_S2 * (GRADE - 0.002) * length
    asked = asked_at(ROUTES, 2, memory, np.full(count, np.sqrt(square)), np.full(count, 500.0))
    sensors = SpeedSensors(ROUTES, trains, 0.1)
    reading = ReadAhead(sensors, ExpectedWay(EvenSlope(own), np.full(count, 1.0), gravity))
    found, std = reading.n_per_kn(asked), 1e3 * 0.1 * np.sqrt(25.0 + square) / (GRAVITY_M_S2 * length)
    assert sensors.stretch(asked, 2).std_n_per_kn(gravity).mean() == pytest.approx(std, rel=0.01)
    assert found.std() == pytest.approx(std, rel=0.05)
    assert found.mean() == pytest.approx(2.0, abs=4.0 * std / np.sqrt(count))
    some = replace(asked, lanes=asked.lanes[7:9], routes=asked.routes[7:9], start=asked.start.chosen(np.array([7, 8])))
    assert reading.n_per_kn(some).tolist() == found[7:9].tolist()
