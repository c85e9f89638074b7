"""Types and masses of drawn cars: shares, limits that a type can have, uniform and exponential laws."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from plant_models import Car, PlantError
from plant_models.rolling.car_mix import CarMix, MixedCar, mass_limits_t
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
