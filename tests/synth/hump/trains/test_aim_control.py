"""The aim of the last position keeps its probability on fresh cuts; what it reads is the resistance of the cut."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from plant_models.hump import TrackSection
from plant_models.library.catalogue import load_car, load_weight_categories
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw
from plant_models.rolling.weather import Weather
from synth.aim.knowledge import ByCategory, Requirement
from synth.aim.outcome import Couplings, couplings
from synth.aim.position_models import NormalPosition
from synth.hump.trains.aim_control import AimControl, ReadAhead
from synth.hump.trains.aim_design import AimDesign, MeasuredAhead, hump_aim, scene_of
from synth.hump.trains.expected_way import ExpectedWay
from synth.hump.trains.free_stretch import ResistanceOnStretch
from synth.hump.trains.hump_aim import CategoryAim, HumpAim
from synth.hump.trains.speed_sensors import SpeedSensors
from synth.hump.trains.train_memory import TrainMemory
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
from tuning_tables.aim import AimAxes
from tuning_tables.aim.held_aim import aim_grid

CATEGORIES = load_weight_categories()
MIX = CarMix((MixedCar(load_car("gondola-4").car, 0.7, 11.6), MixedCar(load_car("tank-4").car, 0.3, 9.0)))
POSITION = NormalPosition(0.1, only_brakes=False)
DESIGN = AimDesign(
    CutPopulation(MIX, CATEGORIES, HumpNormLaw(), Weather()),
    POSITION,
    Requirement(0.1, (0.5, 7.0)),
    MeasuredAhead(0.1),
    cars=(1, 3, 5),
)
FRESH = 4000
CHANCE = 3.5 * np.sqrt(0.1 * 0.9 * (1.0 / DESIGN.design_cuts + 1.0 / FRESH))
"""Of the share of over-speeds: of the cuts that speeds were chosen on, and of fresh ones."""
ROUTES = large()


@cache
def aim() -> HumpAim:
    return hump_aim(ROUTES, DESIGN)


def met_by(category: int, cars: int, measured: bool) -> Couplings:
    """Fresh cuts that are commanded by the aim at free distances between its nodes."""
    scene = scene_of(ROUTES.routes[0], DESIGN, 1)
    cuts = scene.draw(CATEGORIES.members[category], cars, 99, 0, FRESH)
    free = np.random.default_rng(cars).uniform(5.0, 643.0 - cuts.rolling.cuts.last_axle_m)
    reading = ResistanceOnStretch(ROUTES.exit_m[0, 1], 0.1).of(cuts).with_error(cuts) if measured else None
    rows = np.zeros(FRESH, dtype=np.int64)
    command = aim().command_m_s(rows, rows + category, rows + cars, free, reading)
    return couplings(cuts, POSITION.exits(cuts), command, cuts.release_m + free)


@pytest.mark.parametrize("category", [0, 4])
@pytest.mark.parametrize("cars", [1, 2, 3, 4, 5, 7])
def test_no_more_cuts_couple_too_fast_than_are_asked_for(category: int, cars: int) -> None:
    alone, read = (met_by(category, cars, measured) for measured in (False, True))
    for met in (alone, read):
        least = 0.1 - CHANCE if cars in DESIGN.cars else 0.03  # others are commanded as fewer or more cars, if slower
        assert least < met.overspeed.value < 0.1 + CHANCE
    spared = alone.gap_m - read.gap_m
    if cars <= 3:  # long cuts differ little from each other, and the stretch is short for them
        assert spared.mean() > 3.0 * spared.std() / np.sqrt(FRESH)


def test_a_reading_is_the_resistance_where_nothing_else_differs() -> None:
    population = CutPopulation(
        CarMix((MixedCar(load_car("gondola-4").car, 1.0, 0.0),)), CATEGORIES, HumpNormLaw(), Weather()
    )
    scene = scene_of(ROUTES.routes[0], replace(DESIGN, population=population), 1)
    bare = replace(scene, track=replace(scene.track, bends=()), population=replace(population, bends=()))
    cuts = bare.draw(CATEGORIES.members[0], 2, 5, 0, 500)
    found = ResistanceOnStretch(ROUTES.exit_m[0, 1], 0.1).of(cuts)
    assert found.value == pytest.approx(cuts.rolling.cuts.resistance_n_per_kn, abs=2e-3)


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
