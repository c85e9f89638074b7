"""Cuts of trains: drawn, and of a list.

Cuts of whole trains: those of the population's lists, the same whatever is drawn beside them, by the laws.
Trains of a sorting list: what it tells stands, types fit it and have the law of the mix under that condition.
"""

from __future__ import annotations

from dataclasses import fields, replace
from itertools import product

import numpy as np
import pytest
from scipy import stats

from plant_models.cut import GRAVITY_M_S2, ROTATING_MASS_PER_AXLE_T
from plant_models.errors import PlantError
from plant_models.hump import Route
from plant_models.library.hump_entry import load_hump
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.resistance_law import HumpNormLaw, Tb10062Law
from plant_models.rolling.roll_track import Weather
from synth.hump.control.cut_record import CutRecord, Mark, SortingList
from synth.hump.control.train_population import TrainPopulation
from synth.hump.rolling.list_trains import FITS_M, ListedCars, list_trains
from synth.hump.rolling.train_cuts import TrainCuts, expected, trains
from tests.plant_models.rolling.populations import CATEGORIES, FLAT, GONDOLA, LONG_TANK, MIX, TANK, population
from tests.synth.hump.control.test_sorting_list import drawn_list
from tests.synth.hump.trains.humped_trains import route_rolling

OWN_MIX = CarMix((MixedCar(GONDOLA, 0.5, 11.6), MixedCar(TANK, 0.3, 10.5), MixedCar(LONG_TANK, 0.2, 12.0)))
TRAINS = TrainPopulation(OWN_MIX, CATEGORIES, {1: 0.4, 2: 0.2, 5: 0.4}, dict.fromkeys(range(1, 33), 1.0), 2.0, 10)
PEOPLE = population(MIX, weather=Weather(temperature_c=5.0, head_wind_mean_m_s=1.0, head_wind_std_m_s=3.0))
ROUTES: tuple[Route, ...] = tuple(load_hump("large").graph.routes(201).values())


def some(first: int, count: int, cuts: int = 40, **options: bool) -> TrainCuts:
    """Trains of one seed."""
    return trains(TRAINS, PEOPLE, ROUTES, 5, first, count, cuts, **options)


def test_the_first_train_is_the_list_of_the_population() -> None:
    listed, made = drawn_list(TRAINS, 5, 40), some(0, 1)
    for name in ("cars", "axles", "track"):
        assert getattr(made, name).tolist() == [getattr(cut, name) for cut in listed.cuts]
    assert [CATEGORIES.members[place].number for place in made.category] == [cut.category for cut in listed.cuts]
    np.testing.assert_allclose(made.mass_t, [cut.mass_t for cut in listed.cuts], atol=1e-9)
    np.testing.assert_allclose(made.drawn.cut_mass_t, [cut.mass_t for cut in listed.cuts], atol=0.0006)
    np.testing.assert_allclose(made.length_m, [cut.length_m for cut in listed.cuts], atol=1e-9)
    assert [ROUTES[place].track for place in made.route] == [cut.track for cut in listed.cuts]


def test_a_train_is_the_same_whatever_is_drawn_beside_it() -> None:
    whole, part = some(0, 60), some(23, 31)
    rows = slice(23 * 40, 54 * 40)
    for field in fields(whole.drawn):
        if field.name != "mix":
            np.testing.assert_array_equal(getattr(part.drawn, field.name), getattr(whole.drawn, field.name)[rows])
    for name in ("route", "track", "category", "mass_t", "cars", "axles", "length_m", "first_axle_m", "last_axle_m"):
        np.testing.assert_array_equal(getattr(part, name), getattr(whole, name)[rows], err_msg=name)
        assert not getattr(part, name).flags.writeable
    assert (part.seed, part.first, part.trains, part.cuts, len(part)) == (5, 23, 31, 40, 31 * 40)


def test_cars_have_the_resistance_of_their_category_and_cuts_the_wind_of_the_day() -> None:
    """Gamma laws by category, a normal wind: Kolmogorov's test at 1 %; draws of bends of an Erlang law."""
    made = some(0, 200)
    for place in np.unique(made.category):
        law = CATEGORIES.members[place].resistance
        cars = (made.drawn.mass_t > 0.0) & (made.category == place)[:, None]
        gamma = stats.gamma(law.shape, scale=law.scale_n_per_kn)
        assert stats.kstest(made.drawn.basic_n_per_kn[cars], gamma.cdf).pvalue > 0.01
    assert not made.drawn.basic_n_per_kn[made.drawn.mass_t == 0.0].any()
    assert stats.kstest(made.drawn.head_wind_m_s, stats.norm(1.0, 3.0).cdf).pvalue > 0.01
    assert stats.kstest(made.drawn.bend_v2_m_s2.ravel(), stats.erlang(3).cdf).pvalue > 0.01
    assert made.drawn.bend_v2_m_s2.shape == (8000, 6)


def test_a_train_may_have_one_wind() -> None:
    one, each = some(0, 300, 5, one_wind_a_train=True), some(0, 300, 5)
    wind = one.drawn.head_wind_m_s.reshape(300, 5)
    assert np.all(wind == wind[:, :1])
    assert stats.kstest(wind[:, 0], stats.norm(1.0, 3.0).cdf).pvalue > 0.01
    np.testing.assert_array_equal(one.drawn.basic_n_per_kn, each.drawn.basic_n_per_kn)
    np.testing.assert_array_equal(some(7, 3, 5, one_wind_a_train=True).drawn.head_wind_m_s, wind[7:10].ravel())


def test_resistance_on_straight_track_is_the_sum_of_its_parts() -> None:
    made = trains(TRAINS, replace(PEOPLE, law=Tb10062Law()), ROUTES, 5, 0, 2, 40)
    rows = np.array([3, 3, 50])
    against = np.array([2.0, 4.0, 1.0]) + made.drawn.head_wind_m_s[rows]
    air = made.drawn.air_n_per_kn[rows] * against * np.abs(against)
    w0 = [np.average(made.drawn.basic_n_per_kn[r], weights=made.drawn.mass_t[r]) for r in rows]
    found = made.resistance_at(rows, np.array([2.0, 4.0, 1.0]))
    np.testing.assert_allclose(found, w0 + air + 0.39 + 0.1 * np.array([2.0, 4.0, 1.0]), rtol=1e-12)


@pytest.mark.parametrize("law", [HumpNormLaw(), Tb10062Law()])
def test_expected_is_what_a_control_knows(law: HumpNormLaw | Tb10062Law) -> None:
    made = trains(TRAINS, replace(PEOPLE, law=law), ROUTES, 5, 0, 50, 40)
    known = expected(made)
    np.testing.assert_allclose(known.cut_mass_t, made.mass_t, rtol=1e-12)
    real = known.mass_t > 0.0
    np.testing.assert_array_equal(real, made.drawn.mass_t > 0.0)
    load = np.where(real, known.mass_t, 0.0) / OWN_MIX.axles[known.types]
    np.testing.assert_allclose(load[real], np.repeat(made.mass_t / made.axles, made.cars), rtol=1e-12)
    assert np.all(known.head_wind_m_s == 1.0)
    np.testing.assert_array_equal(known.bend_v2_m_s2, law.mean_bend_draw)
    inertia = made.mass_t + ROTATING_MASS_PER_AXLE_T * made.axles
    np.testing.assert_allclose(known.reduced_gravity_m_s2, GRAVITY_M_S2 * made.mass_t / inertia, rtol=1e-12)
    for place in np.unique(made.category):
        of = made.category == place
        error = made.drawn.resistance_n_per_kn[of] - known.resistance_n_per_kn[of]
        assert abs(error.mean()) < 4.0 * error.std() / np.sqrt(of.sum())


def test_trains_roll_on_their_routes_and_expected_ones_in_their_midst() -> None:
    """The mean time to the first retarder of drawn cuts is near that of expected ones; some 100 m without brakes."""
    made = some(0, 25)
    rows = np.flatnonzero(made.cars <= 4)
    lanes = rows, made.route[rows], 0.5 * made.length_m[rows], np.full(len(rows), 1.7)
    stations = (68.0 + made.first_axle_m[rows])[:, None]
    times = [
        route_rolling(made.population, ROUTES, cuts).roll_on(*lanes, stations).time_s
        for cuts in (made.drawn, expected(made))
    ]
    assert abs(np.mean(times[0] / times[1]) - 1.0) < 0.02
    assert np.std(times[0] / times[1]) > 1e-3


def test_a_track_without_route_is_refused() -> None:
    beyond = replace(TRAINS, track_shares={40: 1.0})
    with pytest.raises(PlantError, match="track 40 over lead 0"):
        trains(beyond, PEOPLE, ROUTES, 5, 0, 1, 3)


LISTED = replace(PEOPLE, mix=OWN_MIX)


def made(*records: CutRecord, first: int = 0, count: int = 20) -> TrainCuts:
    """Trains of a list."""
    return list_trains(SortingList(records), LISTED, ROUTES, 5, first, count)


def test_what_a_list_tells_stands_in_every_train() -> None:
    """A list that a population gave: its cars fit to the millimetre, so lengths do."""
    listed = drawn_list(TRAINS, 9, 40)
    found = list_trains(listed, LISTED, ROUTES, 5, 0, 30)
    for name in ("cars", "axles", "track", "mass_t"):
        told = np.tile([getattr(cut, name) for cut in listed.cuts], 30)
        np.testing.assert_array_equal(getattr(found, name), told)
    assert [LISTED.categories.members[place].number for place in found.category[:40]] == [
        cut.category for cut in listed.cuts
    ]
    np.testing.assert_allclose(found.drawn.cut_mass_t, found.mass_t, rtol=1e-12)
    apart = np.abs(found.length_m - np.tile([cut.length_m for cut in listed.cuts], 30))
    assert apart.max() <= FITS_M + 0.01 * 10
    assert len(np.unique(found.drawn.basic_n_per_kn[::40, 0])) == 30  # what the list does not tell differs


def test_a_train_of_a_list_is_the_same_whatever_is_drawn_beside_it() -> None:
    listed = drawn_list(TRAINS, 9, 40).cuts
    whole, part = made(*listed), made(*listed, first=7, count=5)
    for name in ("types", "mass_t", "basic_n_per_kn", "head_wind_m_s", "bend_v2_m_s2"):
        np.testing.assert_array_equal(getattr(part.drawn, name), getattr(whole.drawn, name)[280:480], err_msg=name)


def test_types_have_the_law_of_the_mix_among_those_that_fit() -> None:
    """Three cars with 16 axles: all 64 orders of types counted out by hand; χ² below its 99.9 % quantile."""
    mix = CarMix(
        (MixedCar(GONDOLA, 0.4, 1.0), MixedCar(TANK, 0.3, 1.0), MixedCar(FLAT, 0.2, 1.0), MixedCar(LONG_TANK, 0.1, 1.0))
    )
    lengths = np.array([c.car.length_m for c in mix.cars])
    shares = np.array([c.share for c in mix.cars])
    length = float(lengths[[0, 2, 3]].sum())
    weight = {
        order: float(np.prod(shares[list(order)]))
        for order in product(range(4), repeat=3)
        if mix.axles[list(order)].sum() == 16 and abs(lengths[list(order)].sum() - length) <= FITS_M
    }
    n, rng = 20_000, np.random.default_rng(1)
    types = ListedCars(mix, 3).types(16, length, rng.random(n), rng.random((n, 3)))
    assert types is not None
    orders, counts = np.unique(types, axis=0, return_counts=True)
    assert {tuple(order) for order in orders.tolist()} == set(weight)
    told = np.array([weight[tuple(order)] for order in orders.tolist()])
    expected = n * told / told.sum()
    assert len(weight) in (6, 12)
    assert float(np.sum((counts - expected) ** 2 / expected)) < 31.3


@pytest.mark.parametrize(("cars", "long"), [(1, 1), (6, 2), (20, 7), (60, 25)])
def test_the_nearest_cars_are_taken_where_no_length_fits(cars: int, long: int) -> None:
    """Too short a list of gondolas and long tanks has as many of each as the axles tell; far from it, nearest wins."""
    mix = CarMix((MixedCar(GONDOLA, 0.5, 1.0), MixedCar(LONG_TANK, 0.1, 1.0)))
    types = ListedCars(mix, cars).types(4 * cars + 4 * long, 5.0 * cars, np.array([0.5]), np.full((1, cars), 0.4))
    assert types is not None
    assert np.count_nonzero(types) == long


def test_a_block_of_tanks_is_one() -> None:
    """Five cars of 12.02 m of a mix where tanks are 3 of 10, in each of 20 trains."""
    cut = CutRecord(1, 5, 20, 120.0, 1, 3, 5 * 12.02)
    assert np.all(made(cut).drawn.types == 1)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"axles": 9}, r"cut 2 has 9 axles on 2 cars; .* has 4 or 8"),
        ({"axles": 20}, r"cut 2 has 20 axles on 2 cars"),
        ({"track": 77}, "cut 2 goes to track 77 over lead 0"),
        ({"lead": 1}, "cut 2 goes to track 5 over lead 1"),
        ({"category": 99}, "cut 2 has category 99"),
    ],
)
def test_a_cut_that_does_not_fit_is_named(change: dict[str, int], words: str) -> None:
    cut = CutRecord(2, 2, 8, 60.0, 1, 5, 27.84)
    with pytest.raises(PlantError, match=words):
        made(CutRecord(1, 1, 4, 25.0, 1, 3, 13.92), replace(cut, **change))  # type: ignore[arg-type]  # whole numbers


def test_a_category_that_no_car_of_the_mix_can_have_is_named() -> None:
    """A mix of flats alone, heaviest category: its cut is named."""
    light = CarMix((MixedCar(replace(FLAT, gross_t=40.0), 1.0, 6.0),))
    cut = SortingList((CutRecord(4, 1, 4, 80.0, 5, 3, 14.62),))
    with pytest.raises(PlantError, match="cut 4: car mix: no car"):
        list_trains(cut, population(light), ROUTES, 5, 0, 1)


def test_cuts_that_are_not_humped_are_left_out() -> None:
    kept = CutRecord(1, 1, 4, 25.0, 1, 3, 13.92)
    parked = replace(kept, serial=2, marks=frozenset({Mark.DO_NOT_HUMP}))
    assert made(kept, parked).cuts == 1
    with pytest.raises(PlantError, match="no cut of it goes over the hump"):
        made(parked)


def test_a_list_and_the_population_have_the_same_resistances_and_winds() -> None:
    """Common numbers: the first cars of the same seed are the same runners in the same wind."""
    listed = drawn_list(TRAINS, 5, 40)
    of_list, drawn = list_trains(listed, LISTED, ROUTES, 5, 0, 1), trains(TRAINS, PEOPLE, ROUTES, 5, 0, 1, 40)
    width = of_list.drawn.cars
    np.testing.assert_array_equal(of_list.drawn.basic_n_per_kn, drawn.drawn.basic_n_per_kn[:, :width])
    np.testing.assert_array_equal(of_list.drawn.head_wind_m_s, drawn.drawn.head_wind_m_s)
