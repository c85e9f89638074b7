"""Trains of a population: shares and numbers as asked, the same for the same seed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models.errors import PlantError
from plant_models.library import load_car, load_weight_categories
from plant_models.rolling.car_mix import CarMix, MixedCar
from synth.hump.control.train_population import TrainPopulation, chosen
from tests.synth.hump.control.drawn_list import drawn_list

CATEGORIES = load_weight_categories()
MIX = CarMix(tuple(MixedCar(load_car(name).car, share, 10.0) for name, share in (("gondola-4", 0.7), ("tank-4", 0.3))))
POPULATION = TrainPopulation(MIX, CATEGORIES, {1: 0.4, 3: 0.2, 5: 0.4}, dict.fromkeys(range(1, 33), 1.0))
MANY = 999


def test_cuts_have_a_geometric_number_of_cars() -> None:
    """P(n) = q·(1 − q)^(n − 1) with q = 1/2, of 10 × 999 cuts; χ² with five classes below its 99.9 % quantile."""
    cars = np.array([cut.cars for seed in range(10) for cut in drawn_list(POPULATION, seed, MANY).cuts])
    counts = np.array([*(np.sum(cars == n) for n in range(1, 5)), np.sum(cars >= 5)])
    expected = len(cars) * np.array([1 / 2, 1 / 4, 1 / 8, 1 / 16, 1 / 16])
    assert float(np.sum((counts - expected) ** 2 / expected)) < 18.5
    assert {cut.cars for cut in drawn_list(replace(POPULATION, cars_mean=1.0), 1, 200).cuts} == {1}
    assert max(cut.cars for cut in drawn_list(replace(POPULATION, cars_mean=8.0, most_cars=9), 1, MANY).cuts) == 9


def test_categories_and_tracks_have_their_shares() -> None:
    """Within four standard deviations."""
    cuts = [cut for seed in range(10) for cut in drawn_list(POPULATION, seed, MANY).cuts]
    for number, share in {1: 0.4, 2: 0.0, 3: 0.2, 4: 0.0, 5: 0.4}.items():
        found = sum(cut.category == number for cut in cuts) / len(cuts)
        assert abs(found - share) <= 4.0 * (share * (1.0 - share) / len(cuts)) ** 0.5
    tracks = [sum(cut.track == track for cut in cuts) for track in range(1, 33)]
    assert sum(tracks) == len(cuts)
    assert max(abs(count - len(cuts) / 32) for count in tracks) < 4.5 * (len(cuts) / 32) ** 0.5


def test_every_cut_is_of_its_category() -> None:
    """Axle loads of its cars, so of the cut too, lie between the limits of the category."""
    limits = [category.mass_above_t for category in CATEGORIES.members]
    for cut in drawn_list(POPULATION, 3, MANY).cuts:
        place = next(n for n, category in enumerate(CATEGORIES.members) if category.number == cut.category)
        per_car = cut.mass_t / cut.axles * 4.0
        assert limits[place] <= per_car + 1e-3
        assert place + 1 == len(limits) or per_car <= limits[place + 1] + 1e-3
        assert cut.axles == 4 * cut.cars


def test_a_seed_is_a_train_and_a_longer_train_begins_with_the_shorter() -> None:
    train = drawn_list(POPULATION, 5, 40)
    assert train == drawn_list(POPULATION, 5, 40)
    assert drawn_list(POPULATION, 5, 60).cuts[:40] == train.cuts
    assert drawn_list(POPULATION, 6, 40) != train


def test_a_share_of_none_is_never_chosen() -> None:
    shares = {1: 0.0, 2: 1.0, 3: 0.0, 4: 1.0, 5: 0.0}
    u = np.array([2.0**-53, 0.25, 0.5, 0.75, 1.0 - 2.0**-53])
    assert set(chosen(shares, u).tolist()) == {2, 4}
    assert set(chosen(shares, u, np.full(5, 2)).tolist()) == {4}
    assert set(chosen(shares, u, np.full(5, 4)).tolist()) == {2}


def test_cuts_that_follow_each_other_go_to_different_tracks() -> None:
    """By the shares of the others: behind track 1, track 2 has 0.3 of 0.5 (four standard deviations)."""
    some = replace(POPULATION, track_shares={1: 0.5, 2: 0.3, 3: 0.2})
    drawn = some.drawn(3, 0, 100, 40).track.reshape(100, 40)
    ahead, behind = drawn[:, :-1].ravel(), drawn[:, 1:].ravel()
    assert not np.any(ahead == behind)
    after = behind[ahead == 1]
    assert abs(np.mean(after == 2) - 0.6) < 4.0 * (0.24 / len(after)) ** 0.5
    first = some.drawn(3, 0, 4000, 1).track
    assert abs(np.mean(first == 1) - 0.5) < 4.0 * (0.25 / 4000) ** 0.5
    assert {cut.track for cut in drawn_list(replace(POPULATION, track_shares={7: 1.0, 8: 0.0}), 1, 20).cuts} == {7}


def test_a_train_is_the_same_whatever_is_drawn_beside_it() -> None:
    whole, part = POPULATION.drawn(5, 0, 60, 40), POPULATION.drawn(5, 23, 31, 40)
    for name in ("cars", "category", "track", "types", "mass_t"):
        np.testing.assert_array_equal(getattr(part, name), getattr(whole, name)[23 * 40 : 54 * 40], err_msg=name)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"cars_mean": 0.5}, "cars_mean"),
        ({"most_cars": 0}, "most_cars"),
        ({"track_shares": {}}, "track_shares has no share above 0"),
        ({"track_shares": {1: -1.0}}, "track_shares of 1"),
        ({"category_shares": {9: 1.0}}, "category_shares names 9"),
    ],
)
def test_what_no_population_can_be_is_refused(change: dict[str, object], words: str) -> None:
    with pytest.raises(PlantError, match=words):
        replace(POPULATION, **change)  # type: ignore[arg-type]  # wrong on purpose


def test_a_train_has_1_to_999_cuts() -> None:
    for cuts in (0, 1000):
        with pytest.raises(PlantError, match="must have 1 to 999"):
            drawn_list(POPULATION, 1, cuts)
