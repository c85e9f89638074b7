"""A population of trains instead of a sorting list: it gives lists that nobody wrote."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil, log1p

import numpy as np
from numpy.typing import NDArray

from plant_models.errors import require, require_between
from plant_models.library.weight_category import WeightCategories
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_numbers import Purpose, uniform_numbers
from synth.yard.hump.cut_record import USUAL_HUMP_SPEED_M_S, CutRecord
from synth.yard.hump.sorting_list import SortingList

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class TrainPopulation:
    """Cuts of a shifted geometric number of cars, mean `cars_mean`, at most `most_cars`; the law is assumed, no
    published one was found. The cars of a cut are of one weight category.

    `category_shares`, `track_shares`: by the number of a category, and of a track. `PlantError` for shares that are
    negative or all 0, and for a category that no car of `mix` can be in.
    """

    mix: CarMix
    categories: WeightCategories
    category_shares: Mapping[int, float]
    track_shares: Mapping[int, float]
    cars_mean: float = 2.0
    most_cars: int = 20
    hump_speed_m_s: float = USUAL_HUMP_SPEED_M_S

    def __post_init__(self) -> None:
        require_between("train: cars_mean", self.cars_mean, 1.0, 10.0)
        require_between("train: most_cars", float(self.most_cars), 1.0, 60.0)
        for name, shares in (("category_shares", self.category_shares), ("track_shares", self.track_shares)):
            for number, share in shares.items():
                require_between(f"train: {name} of {number}", share, 0.0, 1e6)
            require(sum(shares.values()) > 0.0, f"train: {name} has no share above 0; one at least must be positive")
        known = {category.number for category in self.categories.members}
        for number in self.category_shares:
            require(number in known, f"train: category_shares names {number}, which is none of {self.categories.name}")

    def train(self, seed: int, cuts: int) -> SortingList:
        """A train of `cuts` cuts; cut i of a seed is the same whatever the number of cuts."""
        require(1 <= cuts <= 999, f"train: {cuts} cuts; it must have 1 to 999")
        u = uniform_numbers(seed, Purpose.TRAIN, 0, cuts, 3)
        of_cars = uniform_numbers(seed, Purpose.TRAIN_CARS, 0, cuts, 2 * self.most_cars)
        return SortingList(tuple(self._cut(row + 1, u[row], of_cars[row].reshape(-1, 2)) for row in range(cuts)))

    def _cut(self, serial: int, u: Floats, of_cars: Floats) -> CutRecord:
        cars = self._cars(float(u[0]))
        number = chosen(self.category_shares, float(u[1]))
        category = next(each for each in self.categories.members if each.number == number)
        mix = self.mix.of(self.categories, category)
        types = mix.types(of_cars[:cars, 0])
        masses = mix.masses_t(self.categories, category, types, of_cars[:cars, 1])
        each = [mix.cars[place].car for place in types]
        return CutRecord(
            serial=serial,
            cars=cars,
            axles=sum(len(car.axle_offsets_m) for car in each),
            mass_t=round(float(masses.sum()), 3),
            category=number,
            track=chosen(self.track_shares, float(u[2])),
            length_m=round(sum(car.length_m for car in each), 3),
            hump_speed_m_s=self.hump_speed_m_s,
        )

    def _cars(self, u: float) -> int:
        """n of P(n) = q·(1 − q)^(n−1), q = 1/mean, for uniform `u`."""
        if self.cars_mean == 1.0:
            return 1
        return min(max(ceil(log1p(-u) / log1p(-1.0 / self.cars_mean)), 1), self.most_cars)


def chosen(shares: Mapping[int, float], u: float) -> int:
    """The number that uniform `u` falls on, the smallest first."""
    numbers = sorted(shares)
    bounds = np.cumsum([shares[number] for number in numbers])
    place = int(np.searchsorted(bounds, u * bounds[-1], side="right"))
    return numbers[min(place, len(numbers) - 1)]
