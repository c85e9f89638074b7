"""Trains of a sorting list: what it tells stands, types fit it and have the law of the mix under that condition."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from plant_models.errors import PlantError
from plant_models.rolling.car_mix import CarMix, MixedCar
from synth.hump.control.cut_record import CutRecord, Mark
from synth.hump.control.sorting_list import SortingList
from synth.hump.trains.list_trains import list_trains
from synth.hump.trains.listed_cars import FITS_M, ListedCars
from synth.hump.trains.train_cuts import TrainCuts, trains
from tests.plant_models.rolling.populations import FLAT, GONDOLA, LONG_TANK, TANK, population
from tests.synth.hump.control.drawn_list import drawn_list
from tests.synth.hump.trains.test_train_cuts import OWN_MIX, PEOPLE, ROUTES, TRAINS

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
