"""A population of trains instead of a sorting list."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.library.weight_category import WeightCategories
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_numbers import Purpose, uniform_numbers
from synth.hump.control.cut_record import MOST_CUTS


@frozen_arrays
class DrawnTrains:
    """Trains of `cuts` cuts each, one row a cut, train by train: `cars` and `track` (rows,); `category` (rows,): place
    in the categories; `types` (rows, cars): places in `mix`; `mass_t` (rows, cars): 0 where a cut has no more cars."""

    mix: CarMix
    cuts: int
    cars: Ints
    category: Ints
    track: Ints
    types: Ints
    mass_t: Floats


@dataclass(frozen=True)
class TrainPopulation:
    """Cuts of a shifted geometric number of cars, mean `cars_mean`, at most `most_cars`; the law is assumed, no
    published one was found. The cars of a cut are of one weight category. A cut goes to another track than the cut
    ahead of it, with which it would be one cut: to each other track by its share among them. Where one track alone has
    a share, all go there.

    `category_shares`, `track_shares`: by the number of a category, and of a track. `PlantError` for shares that are
    negative or all 0, and for a category that no car of `mix` can be in.
    """

    mix: CarMix
    categories: WeightCategories
    category_shares: Mapping[int, float]
    track_shares: Mapping[int, float]
    cars_mean: float = 2.0
    most_cars: int = 20

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

    def drawn(self, seed: int, first: int, count: int, cuts: int) -> DrawnTrains:
        """Trains `first` … `first + count − 1` of the row `seed`, each of `cuts` cuts; a train is the same whatever
        `first` and `count`."""
        require(1 <= cuts <= MOST_CUTS, f"train: {cuts} cuts; it must have 1 to {MOST_CUTS}")
        begins, rows = first * cuts, count * cuts
        u = uniform_numbers(seed, Purpose.TRAIN, begins, rows, 3)
        of_cars = uniform_numbers(seed, Purpose.TRAIN_CARS, begins, rows, 2 * self.most_cars)
        cars, (categories, types, masses) = self._cars(u[:, 0]), self._loads(u[:, 1], of_cars)
        mass = np.where(np.arange(self.most_cars) < cars[:, None], masses, 0.0)
        return DrawnTrains(self.mix, cuts, cars, categories, self._tracks(u[:, 2].reshape(count, cuts)), types, mass)

    def _loads(self, u: Floats, of_cars: Floats) -> tuple[Ints, Ints, Floats]:
        """Category of each cut, types and masses of as many cars as a cut can have."""
        numbers = np.array([category.number for category in self.categories.members])
        drawn = chosen(self.category_shares, u)
        place = np.argmax(drawn[:, None] == numbers, axis=1)
        types, masses = np.empty((len(u), self.most_cars), dtype=np.int64), np.empty((len(u), self.most_cars))
        for each in np.unique(place):
            category, rows = self.categories.members[each], np.flatnonzero(place == each)
            mix = self.mix.of(self.categories, category)
            some = mix.types(of_cars[rows, 0::2])
            masses[rows] = mix.masses_t(self.categories, category, some, of_cars[rows, 1::2])
            types[rows] = np.array([self.mix.cars.index(car) for car in mix.cars])[some]
        return place, types, masses

    def _cars(self, u: Floats) -> Ints:
        """n of P(n) = q·(1 − q)^(n−1), q = 1/mean, for uniform `u`."""
        if self.cars_mean == 1.0:
            return np.ones(u.shape, dtype=np.int64)
        n = np.ceil(np.log1p(-u) / np.log1p(-1.0 / self.cars_mean))
        return np.asarray(np.clip(n, 1, self.most_cars), dtype=np.int64)

    def _tracks(self, u: Floats) -> Ints:
        """Tracks of the cuts of each train, (trains · cuts,), for uniform `u` (trains, cuts)."""
        tracks = np.empty(u.shape, dtype=np.int64)
        tracks[:, 0] = chosen(self.track_shares, u[:, 0])
        for cut in range(1, u.shape[1]):
            tracks[:, cut] = chosen(self.track_shares, u[:, cut], tracks[:, cut - 1])
        return tracks.reshape(-1)


def chosen(shares: Mapping[int, float], u: Floats, but: Ints | None = None) -> Ints:
    """The numbers that uniform `u` falls on, the smallest first; never `but` (as `u`), unless it alone has a share."""
    numbers = np.array(sorted(shares))
    bounds = np.concatenate(([0.0], np.cumsum([shares[number] for number in sorted(shares)])))
    at = u * bounds[-1]
    if but is not None:
        place = np.searchsorted(numbers, but)
        begin, end = bounds[place], bounds[place + 1]
        others = begin + (bounds[-1] - end)
        among = np.minimum(u * others, np.nextafter(others, 0.0))
        among = np.where(among < begin, among, np.maximum(among + (end - begin), end))
        at = np.where(others > 0.0, among, at)
    place = np.searchsorted(bounds[1:], at, side="right")
    last = int(np.flatnonzero(np.diff(bounds))[-1])
    return np.asarray(numbers[np.minimum(place, last)])
