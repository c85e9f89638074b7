"""Drawn cuts: common numbers, wind, air, and how cars make a cut."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from plant_models import Cut, PlantError, couple
from plant_models.rolling.car_mix import CarMix, MixedCar
from plant_models.rolling.random_cuts import MOST_CARS, DrawnCuts, air_n_per_kn, bend_draws
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.roll_track import Bend, Weather
from tests.plant_models.rolling.populations import CATEGORIES, GONDOLA, LONG_TANK, MIX, TANK, WINDY, population

LIGHT, MIDDLE = CATEGORIES.named("Л"), CATEGORIES.named("С")
BENDS = (Bend(20.0, 30.0, 1, 4.73), Bend(60.0, 90.0, 0, 14.0))
ARRAYS = ("types", "mass_t", "basic_n_per_kn", "head_wind_m_s", "bend_v2_m_s2", "bend_head_m", "air_n_per_kn")


def same(a: DrawnCuts, b: DrawnCuts) -> None:
    """Raise unless all numbers are the same bits."""
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name), err_msg=name)


def test_a_cut_is_the_same_whatever_else_is_drawn() -> None:
    people = population(bends=BENDS)
    whole = people.draw(MIDDLE, 3, 5, 0, 3000)
    same(people.draw(MIDDLE, 3, 5, 990, 1500), whole.chosen(slice(990, 2490)))


@pytest.mark.parametrize("cars", [1, 2, 9])
def test_longer_cuts_begin_with_the_same_cars_in_the_same_wind(cars: int) -> None:
    people = population(bends=BENDS)
    same(people.draw(MIDDLE, 15, 5, 0, 500).first_cars(cars, WINDY), people.draw(MIDDLE, cars, 5, 0, 500))


def test_more_bends_do_not_move_the_first_ones() -> None:
    few, more = population(bends=BENDS[:1]), population(bends=BENDS)
    a, b = few.draw(LIGHT, 1, 5, 0, 500), more.draw(LIGHT, 1, 5, 0, 500)
    np.testing.assert_array_equal(a.bend_v2_m_s2[:, 0], b.bend_v2_m_s2[:, 0])


def test_the_wind_is_normal_and_independent_of_the_cars() -> None:
    drawn = population().draw(LIGHT, 1, 9, 0, 30_000)
    assert stats.kstest(drawn.head_wind_m_s, stats.norm(0.5, 3.0).cdf).pvalue > 0.001
    for other in (drawn.mass_t[:, 0], drawn.basic_n_per_kn[:, 0], drawn.types[:, 0]):
        assert abs(np.corrcoef(drawn.head_wind_m_s, other)[0, 1]) < 5.0 / np.sqrt(30_000)


def test_resistance_does_not_follow_the_mass_within_a_category() -> None:
    drawn = population().draw(LIGHT, 2, 9, 0, 30_000)
    for a, b in ((drawn.mass_t[:, 0], drawn.basic_n_per_kn[:, 0]), drawn.basic_n_per_kn.T):
        assert abs(np.corrcoef(a, b)[0, 1]) < 5.0 / np.sqrt(30_000)


def test_a_cut_rolls_as_its_cars_weighted_by_mass_and_spreads_less() -> None:
    resistance = LIGHT.resistance
    for cars in (1, 4, 16):
        w = population().draw(LIGHT, cars, 3, 0, 20_000).resistance_n_per_kn
        assert w.mean() == pytest.approx(resistance.mean_n_per_kn, rel=0.01)
        assert w.std() == pytest.approx(resistance.std_n_per_kn / np.sqrt(cars), rel=0.03)
    drawn = population().draw(MIDDLE, 3, 3, 0, 50)
    by_hand = [np.average(w, weights=q) for w, q in zip(drawn.basic_n_per_kn, drawn.mass_t, strict=True)]
    np.testing.assert_allclose(drawn.resistance_n_per_kn, by_hand, rtol=1e-13)


def test_geometry_and_inertia_are_those_of_coupled_cars() -> None:
    """The same cuts built by `couple`, which the retarder's plant uses."""
    drawn = population(MIX).draw(MIDDLE, 3, 4, 0, 40)
    for i in range(40):
        cars = tuple(drawn.mix.cars[t].car for t in drawn.types[i])
        cut = couple(cars, float(drawn.cut_mass_t[i]), "С", 1)
        assert drawn.reduced_gravity_m_s2[i] == pytest.approx(cut.reduced_gravity_m_s2, rel=1e-12)
        assert drawn.last_axle_m[i] - drawn.first_axle_m[i] == pytest.approx(cut.axle_offsets_m[-1], abs=1e-6)
        assert drawn.car_fronts_m[i].tolist() == pytest.approx(
            [0.0, cars[0].length_m, cars[0].length_m + cars[1].length_m]
        )


def test_air_is_half_the_density_times_the_area() -> None:
    """17.8 of the norm is ½·ρ/g = 17.99 for dry air (353/(273 + t) kg/m³) to 1.1 %."""
    for temperature in (-30.0, 10.0, 35.0):
        norm = Weather(temperature_c=temperature).air_n_per_kn(8.5)
        density = 101_325.0 / (287.05 * (273.15 + temperature))
        assert norm == pytest.approx(0.5 * density * 8.5 / 9.81, rel=0.015)


def test_an_empty_gondola_meets_the_air_that_was_worked_out() -> None:
    """22 t, C_x·S = 1.36 · 8.5 m², 10 °C: 0.30, 0.83 and 2.12 N/kN at 3, 5 and 8 m/s; 85 t: 0.08, 0.21, 0.55."""
    for mass, published in ((22.0, (0.30, 0.83, 2.12)), (85.0, (0.08, 0.21, 0.55))):
        of_one = Weather(temperature_c=10.0).air_n_per_kn(1.36 * 8.5) / mass
        np.testing.assert_allclose([of_one * v**2 for v in (3.0, 5.0, 8.0)], published, atol=0.008)


def test_cars_behind_the_first_count_by_their_following_share() -> None:
    mix = CarMix((MixedCar(GONDOLA, 1.0, 10.0), MixedCar(TANK, 1.0, 6.0)), following_share=0.3)
    drawn = population(mix).draw(MIDDLE, 3, 4, 0, 60)
    areas = np.array([10.0, 6.0])[drawn.types] * [1.0, 0.3, 0.3]
    expected = WINDY.air_n_per_kn(1.0) * areas.sum(axis=1) / drawn.mass_t.sum(axis=1)
    np.testing.assert_allclose(drawn.air_n_per_kn, expected, rtol=1e-13)


def test_heads_of_bends_are_drawn_apart_for_each_bend() -> None:
    drawn = population(bends=BENDS).draw(LIGHT, 1, 8, 0, 20_000)
    law = HumpNormLaw()
    for column, bend in zip(drawn.bend_v2_m_s2.T, BENDS, strict=True):
        mean = law.per_switch_m_s2 * bend.switches + law.per_degree_m_s2 * bend.turn_deg
        assert stats.kstest(column, stats.erlang(3, scale=mean / 3).cdf).pvalue > 0.001
    assert abs(np.corrcoef(drawn.bend_v2_m_s2[:, 0], drawn.bend_v2_m_s2[:, 1])[0, 1]) < 5.0 / np.sqrt(20_000)
    assert not drawn.bend_head_m.any()
    chinese = population(law=Tb10062Law(), bends=BENDS).draw(LIGHT, 1, 8, 0, 10)
    np.testing.assert_allclose(chinese.bend_head_m, [[24e-3 + 8e-3 * 4.73, 8e-3 * 14.0]] * 10)


def test_a_car_of_eight_axles_rolls_by_tb_10062_as_one_of_four_with_its_axle_load() -> None:
    """By its own 150 t the norm's mean would be negative and its spread nearly none."""
    long = population(CarMix((MixedCar(LONG_TANK, 1.0, 12.0),)), Tb10062Law()).draw(
        CATEGORIES.named("Т"), 1, 2, 0, 4000
    )
    halves = 0.5 * long.mass_t[:, 0]
    mean = 2.439 + (0.00008 * halves - 0.01743) * 10.0 - 0.015 * halves + 0.017
    assert long.basic_n_per_kn.mean() == pytest.approx(mean.mean(), rel=0.02)
    assert long.basic_n_per_kn.std() > 0.2


@pytest.mark.parametrize("cars", [0, -1, MOST_CARS + 1])
def test_a_cut_without_cars_or_with_too_many_is_refused(cars: int) -> None:
    with pytest.raises(PlantError, match=rf"^cut: {cars} cars; a cut has 1 to {MOST_CARS}$"):
        population().draw(LIGHT, cars, 1, 0, 10)


def test_chosen_cuts_keep_all_their_numbers() -> None:
    drawn = population(bends=BENDS).draw(MIDDLE, 2, 5, 0, 30)
    which = np.array([4, 17, 2])
    some = drawn.chosen(which)
    assert len(some) == 3
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(some, name), getattr(drawn, name)[which])


def test_arrays_are_read_only() -> None:
    drawn = population().draw(LIGHT, 1, 1, 0, 5)
    with pytest.raises(ValueError, match="read-only"):
        drawn.mass_t[0] = 1.0


def test_a_single_gondola_has_the_inertia_of_the_retarders_cut() -> None:
    drawn = population(CarMix((MixedCar(GONDOLA, 1.0, 11.6),))).draw(LIGHT, 1, 1, 0, 1)
    cut = Cut("Л", float(drawn.cut_mass_t[0]), GONDOLA.axle_offsets_m, 2)
    assert drawn.reduced_gravity_m_s2[0] == pytest.approx(cut.reduced_gravity_m_s2, rel=1e-14)


def test_a_car_of_mass_0_is_none() -> None:
    """A cut that is filled up to five cars is the cut of two: by each value that a roll takes from it."""
    people = population(bends=BENDS)
    two, five = people.draw(MIDDLE, 2, 5, 0, 200), people.draw(MIDDLE, 5, 5, 0, 200)
    mass = five.mass_t.copy()
    mass[:, 2:] = 0.0
    filled = replace(five, mass_t=mass, air_n_per_kn=air_n_per_kn(five.mix, people.weather, five.types, mass))
    assert np.all(filled.cars_of_cut == 2)
    for name in (
        "cut_mass_t",
        "resistance_n_per_kn",
        "reduced_gravity_m_s2",
        "first_axle_m",
        "last_axle_m",
        "air_n_per_kn",
    ):
        np.testing.assert_allclose(getattr(filled, name), getattr(two, name), rtol=1e-14, err_msg=name)
    np.testing.assert_array_equal(filled.car_lengths_m.sum(axis=1), two.car_lengths_m.sum(axis=1))
    assert not filled.shares[:, 2:].any()


@pytest.mark.parametrize("law", [HumpNormLaw(), Tb10062Law()])
def test_draws_on_a_track_are_the_heads_that_a_population_of_it_has(law: ResistanceLaw) -> None:
    there, bare = population(law=law, bends=BENDS), population(law=law)
    draws = bend_draws(law, 5, 5, 0, 200)
    nowhere = replace(bare.draw(MIDDLE, 1, 5, 0, 200), bend_v2_m_s2=draws, bend_head_m=draws)
    same(nowhere.on_bends(law, BENDS), there.draw(MIDDLE, 1, 5, 0, 200))
