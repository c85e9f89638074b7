"""Types and masses of drawn cars, and the track that they roll on: fall, bends, and what neither can be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from plant_models import Car, PlantError, TrackProfile
from plant_models.rolling.car_mix import CarMix, MixedCar, mass_limits_t
from plant_models.rolling.roll_track import Bend, RollTrack, Weather
from tests.plant_models.rolling.populations import CATEGORIES, FLAT, GONDOLA, LONG_TANK, MIX, TANK

U = np.random.default_rng(1).random((40_000, 2))
LIMITS = {"Л": (0.0, 28.0), "ЛС": (28.0, 44.0), "С": (44.0, 60.0), "СТ": (60.0, 72.0), "Т": (72.0, np.inf)}


def test_types_come_by_their_shares() -> None:
    types = MIX.types(U[:, 0])
    found = np.bincount(types, minlength=3)
    assert stats.chisquare(found, np.array([0.5, 0.3, 0.2]) * len(U)).pvalue > 0.001


def test_shares_need_not_add_up_to_1() -> None:
    thousandfold = CarMix(tuple(replace(c, share=1000.0 * c.share) for c in MIX.cars))
    np.testing.assert_array_equal(thousandfold.types(U[:, 0]), MIX.types(U[:, 0]))


@pytest.mark.parametrize("name", LIMITS)
def test_masses_are_possible_for_the_type_and_in_the_category(name: str) -> None:
    category = CATEGORIES.named(name)
    mix = MIX.of(CATEGORIES, category)
    types = mix.types(U[:, 0])
    masses = mix.masses_t(CATEGORIES, category, types, U[:, 1])
    low, high = LIMITS[name]
    for number, mixed in enumerate(mix.cars):
        own = masses[types == number]
        assert low <= own.min()
        assert own.max() <= high
        assert mixed.car.tare_t <= own.min()
        assert own.max() <= mixed.car.gross_t
        assert CATEGORIES.of(float(own.min()) + 1e-6, len(mixed.car.axle_offsets_m)) == category


@pytest.mark.parametrize("name", ["Л", "ЛС", "С", "СТ"])
def test_masses_are_uniform_between_what_type_and_category_allow(name: str) -> None:
    category = CATEGORIES.named(name)
    mix = CarMix((MixedCar(TANK, 1.0, 10.5),))
    masses = mix.masses_t(CATEGORIES, category, np.zeros(len(U), dtype=np.int64), U[:, 1])
    low, high = LIMITS[name]
    low = max(low, TANK.tare_t)
    assert stats.kstest(masses, stats.uniform(low, high - low).cdf).pvalue > 0.001


@pytest.mark.parametrize("scale", [4.0, 15.0])
def test_the_heaviest_lack_an_exponential_load_cut_off_at_their_category(scale: float) -> None:
    category = CATEGORIES.members[-1]
    mix = CarMix((MixedCar(GONDOLA, 1.0, 11.6),), underload_mean_t=scale)
    masses = mix.masses_t(CATEGORIES, category, np.zeros(len(U), dtype=np.int64), U[:, 1])
    room = GONDOLA.gross_t - category.mass_above_t
    law = stats.truncexpon(room / scale, scale=scale)
    assert stats.kstest(GONDOLA.gross_t - masses, law.cdf).pvalue > 0.001
    np.testing.assert_allclose(masses, GONDOLA.gross_t - law.ppf(U[:, 1]), rtol=1e-9)


def test_an_equal_category_that_was_read_again_has_the_same_masses() -> None:
    """Values count, not objects: a category that came through a file or to another process is the heaviest, too."""
    heaviest = CATEGORIES.members[-1]
    again = replace(heaviest)
    types = np.zeros(100, dtype=np.int64)
    np.testing.assert_array_equal(
        MIX.masses_t(CATEGORIES, again, types, U[:100, 1]), MIX.masses_t(CATEGORIES, heaviest, types, U[:100, 1])
    )


def test_limits_of_a_car_of_eight_axles_are_those_of_its_axle_load() -> None:
    category = CATEGORIES.named("СТ")
    assert mass_limits_t(CATEGORIES, category, LONG_TANK) == (120.0, 144.0)
    assert mass_limits_t(CATEGORIES, category, GONDOLA) == (60.0, 72.0)


def test_a_type_that_cannot_be_in_a_category_does_not_come() -> None:
    heavy_only = Car("block", (0.0, 1.8, 8.6, 10.4), 14.0, 50.0, 90.0)
    mix = CarMix((MixedCar(heavy_only, 0.9, 11.0), MixedCar(FLAT, 0.1, 6.2)))
    assert [c.car.name for c in mix.of(CATEGORIES, CATEGORIES.named("Л")).cars] == ["flat-4"]
    assert [c.car.name for c in mix.of(CATEGORIES, CATEGORIES.named("С")).cars] == ["block", "flat-4"]
    with pytest.raises(PlantError, match="no car of it can be in the weight category Л"):
        CarMix((MixedCar(heavy_only, 1.0, 11.0),)).of(CATEGORIES, CATEGORIES.named("Л"))


def test_a_type_with_share_0_does_not_come() -> None:
    mix = CarMix((MixedCar(GONDOLA, 1.0, 11.6), MixedCar(TANK, 0.0, 10.5)))
    assert [c.car.name for c in mix.of(CATEGORIES, CATEGORIES.named("С")).cars] == ["gondola-4"]


@pytest.mark.parametrize(
    ("faulty", "sentence"),
    [
        (lambda: CarMix(()), "car mix: it holds no car"),
        (lambda: CarMix((MixedCar(TANK, 0.0, 1.0),)), "all shares are 0; one at least must be positive"),
        (lambda: MixedCar(TANK, -1.0, 1.0), "share of tank-4 is -1.0; it must be a finite number from 0"),
        (lambda: MixedCar(TANK, 1.0, np.nan), "drag_area_m2 of tank-4 is nan"),
        (lambda: replace(MIX, following_share=1.1), "following_share is 1.1; it must be a finite number from 0 to 1"),
        (lambda: replace(MIX, underload_mean_t=0.0), "underload_mean_t is 0.0; it must be a finite number from 0.01"),
    ],
)
def test_an_impossible_mix_is_refused_in_one_sentence(faulty, sentence: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(PlantError) as found:
        faulty()
    assert sentence in str(found.value)
    assert "\n" not in str(found.value)


TRACK = RollTrack(TrackProfile((0.0, 40.0, 100.0), (45.0, 10.0, -2.0)), 160.0)


def test_the_fall_is_the_sum_of_grades_times_lengths() -> None:
    at = np.array([-30.0, 0.0, 20.0, 40.0, 70.0, 100.0, 130.0, 160.0, 500.0])
    np.testing.assert_allclose(TRACK.fall_m(at), [0.0, 0.0, 0.9, 1.8, 2.1, 2.4, 2.34, 2.28, 2.28], atol=1e-12)
    assert TRACK.breaks_m == (0.0, 40.0, 100.0, 160.0)


@given(st.lists(st.tuples(st.floats(1.0, 200.0), st.floats(-20.0, 60.0)), min_size=1, max_size=8))
def test_the_slope_of_the_fall_is_the_grade_of_the_profile(elements: list[tuple[float, float]]) -> None:
    starts = np.concatenate(([0.0], np.cumsum([length for length, _ in elements])))
    profile = TrackProfile(tuple(starts[:-1].tolist()), tuple(grade for _, grade in elements))
    track = RollTrack(profile, float(starts[-1]))
    x = np.linspace(0.0, starts[-1], 4001)
    slope = 1e3 * np.diff(track.fall_m(x)) / np.diff(x)
    middle = 0.5 * (x[:-1] + x[1:])
    whole = np.min(np.abs(middle[:, None] - starts), axis=1) > np.diff(x)[0]
    np.testing.assert_allclose(slope[whole], profile.grade_permille(middle[whole]), atol=1e-6)


@pytest.mark.parametrize(
    ("faulty", "sentence"),
    [
        (lambda: RollTrack(TrackProfile((5.0,), (1.0,)), 100.0), "track: starts_m is (5.0,); it must begin with 0"),
        (
            lambda: RollTrack(TrackProfile((0.0, 50.0), (1.0, 1.0)), 50.0),
            "begins at 50 m; it must begin before the end",
        ),
        (lambda: RollTrack(TrackProfile((0.0,), (1.0,)), -5.0), "track: end_m is -5.0; it must be a finite number"),
        (lambda: RollTrack(TrackProfile((0.0,), (1.0,)), np.inf), "track: end_m is inf; it must be a finite number"),
        (lambda: TrackProfile((0.0,), (100.0,)), "grades_permille is 100.0; it must be a finite number from -60 to 60"),
        (lambda: Bend(30.0, 20.0, 1, 0.0), "bend: to_m is 20; it must be more than from_m, 30"),
        (lambda: Bend(-1.0, 20.0, 1, 0.0), "bend: from_m is -1.0; it must be a finite number from 0"),
        (lambda: Bend(1.0, 20.0, 0, 0.0), "switches and turn_deg are both 0 at 1 m"),
        (lambda: Bend(1.0, 20.0, 21, 0.0), "bend: switches is 21; it must be from 0 to 20"),
        (lambda: Bend(1.0, 20.0, 1, 400.0), "bend: turn_deg is 400.0; it must be a finite number from 0 to 360"),
        (
            lambda: RollTrack(TRACK.profile, 160.0, (Bend(10.0, 30.0, 1, 0.0), Bend(29.0, 40.0, 1, 0.0))),
            "the bend from 29 m overlaps the one that ends at 30 m",
        ),
        (
            lambda: RollTrack(TRACK.profile, 160.0, (Bend(150.0, 170.0, 1, 0.0),)),
            "the last bend ends at 170 m, after the end of the track, 160 m",
        ),
        (lambda: Weather(temperature_c=-80.0), "weather: temperature_c is -80.0; it must be a finite number from -60"),
        (lambda: Weather(head_wind_mean_m_s=40.0), "weather: head_wind_mean_m_s is 40.0"),
        (lambda: Weather(head_wind_std_m_s=-1.0), "weather: head_wind_std_m_s is -1.0; it must be a finite number"),
        (
            lambda: Weather(snow_n_per_kn=11.0),
            "weather: snow_n_per_kn is 11.0; it must be a finite number from 0 to 10",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(faulty, sentence: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(PlantError) as found:
        faulty()
    assert sentence in str(found.value)
    assert "\n" not in str(found.value)


def test_bends_may_touch() -> None:
    assert (
        RollTrack(TRACK.profile, 160.0, (Bend(10.0, 30.0, 1, 0.0), Bend(30.0, 160.0, 1, 0.0))).bends[1].from_m == 30.0
    )
