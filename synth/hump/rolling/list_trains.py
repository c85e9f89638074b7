"""Trains of a sorting list: what the list tells stands, what it does not tell is drawn for each of them, as the types
of cars that fit its cars, axles and length; and where trains of a trial come from, a population or one list again and
again.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from plant_models.errors import PlantError, require
from plant_models.frozen_arrays import Floats, Ints
from plant_models.hump import Route
from plant_models.library.weight_category import WeightCategory
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.random_numbers import Purpose, uniform_numbers
from synth.hump.control.cut_record import CutRecord, SortingList
from synth.hump.control.train_population import DrawnTrains, TrainPopulation
from synth.hump.rolling.train_cuts import Draw, TrainCuts, cuts_on_routes, routes_to, trains

FITS_M = 0.5
"""Lengths that differ by no more fit the list; where none fits, the nearest do. Assumed: lists round."""

FINEST_M, LARGEST_TABLE = 0.01, 4e6
"""Lengths are added up in steps of this, or as many times longer ones as keep the table smaller."""


@dataclass(frozen=True)
class ListedCars:
    """Cuts of `cars` cars of `mix`, each drawn by its share: how probable each sum of axles and of lengths is."""

    mix: CarMix
    cars: int

    @property
    def axles(self) -> Ints:
        """Axles that a car of the mix can have, rising."""
        return np.unique(self.mix.axles)

    @cached_property
    def step_m(self) -> float:
        """Step of the lengths."""
        step, kinds = FINEST_M, float(np.ptp(self._axles) * self.cars + 1)
        while kinds * (np.ptp(self._lengths_m) / step * self.cars + 1) * self.cars > LARGEST_TABLE:
            step *= 2.0
        return step

    @cached_property
    def _axles(self) -> Ints:
        """Axles of each type beyond those of the type with the fewest, in the steps by which types differ."""
        return np.asarray((self.mix.axles - self.axles[0]) // self._axle_step)

    @property
    def _axle_step(self) -> int:
        return max(int(np.gcd.reduce(np.diff(self.axles))), 1)

    @property
    def _lengths_m(self) -> Floats:
        return np.array([each.car.length_m for each in self.mix.cars])

    @cached_property
    def _steps(self) -> Ints:
        """Length of each type beyond that of the shortest, in steps."""
        return np.asarray(np.rint((self._lengths_m - self._lengths_m.min()) / self.step_m), dtype=np.int64)

    @property
    def _shares(self) -> Floats:
        shares = np.array([each.share for each in self.mix.cars])
        return np.asarray(shares / shares.sum())

    @cached_property
    def _levels(self) -> tuple[Floats, ...]:
        """Probability of (axles, length) of 0, 1, … `cars` cars."""
        axles, steps, shares = self._axles, self._steps, self._shares
        levels = [np.ones((1, 1))]
        for _ in range(self.cars):
            before = levels[-1]
            level = np.zeros((before.shape[0] + axles.max(), before.shape[1] + steps.max()))
            for a, b, share in zip(axles, steps, shares, strict=True):
                level[a : a + before.shape[0], b : b + before.shape[1]] += share * before
            levels.append(level)
        return tuple(levels)

    def types(self, axles: int, length_m: float, u: Floats, u_cars: Floats) -> Ints | None:
        """Types of cuts with so many axles, for uniform `u` (n,) and `u_cars` (n, cars): the cuts of the mix under the
        condition that axles and length fit. None if no cars of the mix have so many axles."""
        last = self._levels[-1]
        place, rest = divmod(axles - self.cars * int(self.axles[0]), self._axle_step)
        if rest or not 0 <= place < len(last) or not last[place].any():
            return None
        at_axles = last[place]
        apart = np.abs(self.cars * self._lengths_m.min() + self.step_m * np.arange(len(at_axles)) - length_m)
        nearest = float(apart[at_axles > 0.0].min())
        fit = np.where(apart <= max(nearest, FITS_M) + 0.5 * self.cars * self.step_m, at_axles, 0.0)
        fitting = np.flatnonzero(fit)
        b = fitting[drawn(fit[None, fitting], u)]
        a, types = np.full(len(u), place), np.empty(u_cars.shape, dtype=np.int64)
        for car in reversed(range(self.cars)):
            types[:, car] = drawn(self._weights(self._levels[car], a, b), u_cars[:, car])
            a, b = a - self._axles[types[:, car]], b - self._steps[types[:, car]]
        return types

    def _weights(self, level: Floats, a: Ints, b: Ints) -> Floats:
        """Weight of each type as the last car of cuts with the sums `a`, `b`; `level`: of one car fewer."""
        rest_a, rest_b = a[:, None] - self._axles, b[:, None] - self._steps
        inside = (rest_a >= 0) & (rest_a < level.shape[0]) & (rest_b >= 0) & (rest_b < level.shape[1])
        return np.where(inside, self._shares * level[np.where(inside, rest_a, 0), np.where(inside, rest_b, 0)], 0.0)


def drawn(weights: Floats, u: Floats) -> Ints:
    """The column of each row of `weights`, (n, columns) or (1, columns), that uniform `u` (n,) falls on; none of
    weight 0."""
    bounds = np.cumsum(weights, axis=1)
    place = (bounds <= (u * bounds[:, -1])[:, None]).sum(axis=1)
    last = weights.shape[1] - 1 - np.argmax(weights[:, ::-1] > 0.0, axis=1)
    return np.asarray(np.minimum(place, last))


def list_trains(
    sorting_list: SortingList,
    people: CutPopulation,
    routes: tuple[Route, ...],
    seed: int,
    first: int,
    count: int,
    one_wind_a_train: bool = False,
) -> TrainCuts:
    """The humped cuts of `sorting_list`, `count` times: trains `first` … of the row `seed`, each the same whatever
    `first` and `count`.

    Cars, axles, mass, category and track are those of the list, the mass spread evenly over the axles. Drawn are the
    types of the cars (of those of the mix that have the category, the axles and, within half a metre or as near as
    possible, the length), their resistance, wind (one draw a train with `one_wind_a_train`) and bends. `PlantError`
    names the cut that no cars of the mix fit, or that goes to a track without route.
    """
    records = sorting_list.humped
    require(len(records) > 0, "sorting list: no cut of it goes over the hump")
    u = uniform_numbers(seed, Purpose.TRAIN_CARS, first * len(records), count * len(records), 2 * most_cars(records))
    types = listed_types(people, records, u.reshape(count, len(records), -1))
    trains = trains_of_types(people, records, count, types)
    route = np.array([route_of(routes, record) for record in records])
    mass = np.array([record.mass_t for record in records])
    draw = Draw(seed, first, one_wind_a_train)
    return cuts_on_routes(people, routes, trains, np.tile(route, count), np.tile(mass, count), draw)


def listed_types(people: CutPopulation, records: tuple[CutRecord, ...], u: Floats) -> Ints:
    """Places in the mix for uniform `u` (trains, cuts, 2 · cars), (trains, cuts, cars); 0 where there is no car."""
    types = np.zeros((*u.shape[:2], most_cars(records)), dtype=np.int64)
    known: dict[tuple[int, int], ListedCars] = {}
    for cut, record in enumerate(records):
        key = record.category, record.cars
        if key not in known:
            known[key] = ListedCars(mix_of(people, record), record.cars)
        cars = known[key]
        found = cars.types(record.axles, record.length_m, u[:, cut, 1], u[:, cut, 0 : 2 * record.cars : 2])
        if found is None:
            raise PlantError(
                f"sorting list: cut {record.serial} has {record.axles} axles on {record.cars} cars; a car of its "
                f"category in the car mix has {' or '.join(str(axles) for axles in cars.axles)}"
            )
        types[:, cut, : record.cars] = np.array([people.mix.cars.index(car) for car in cars.mix.cars])[found]
    return types


def mix_of(people: CutPopulation, record: CutRecord) -> CarMix:
    """The cars of the mix that can be of the category of the cut."""
    try:
        return people.mix.of(people.categories, category_of(people, record))
    except PlantError as error:
        raise PlantError(f"sorting list: cut {record.serial}: {error}") from None


def category_of(people: CutPopulation, record: CutRecord) -> WeightCategory:
    """The weight category of a cut."""
    found = [each for each in people.categories.members if each.number == record.category]
    require(
        len(found) > 0,
        f"sorting list: cut {record.serial} has category {record.category}, which is none of {people.categories.name}",
    )
    return found[0]


def route_of(routes: tuple[Route, ...], record: CutRecord) -> int:
    """Place of the route of a cut."""
    try:
        return int(routes_to(routes, np.array([record.lead]), np.array([record.track]))[0])
    except PlantError:
        raise PlantError(
            f"sorting list: cut {record.serial} goes to track {record.track} over lead {record.lead}; the hump has no "
            "such route"
        ) from None


def trains_of_types(people: CutPopulation, records: tuple[CutRecord, ...], count: int, types: Ints) -> DrawnTrains:
    """The cuts of `records` `count` times, with their types (trains, cuts, cars), masses by axles."""
    cars, axles, track = (np.array([getattr(r, name) for r in records]) for name in ("cars", "axles", "track"))
    category = np.array([people.categories.members.index(category_of(people, r)) for r in records])
    a_load = np.array([record.mass_t for record in records]) / axles
    real = np.arange(types.shape[2]) < cars[:, None]
    mass = np.where(real, people.mix.axles[types], 0) * a_load[:, None]
    rows = count * len(records)
    return DrawnTrains(
        mix=people.mix,
        cuts=len(records),
        cars=np.tile(cars, count),
        category=np.tile(category, count),
        track=np.tile(track, count),
        types=types.reshape(rows, -1),
        mass_t=mass.reshape(rows, -1),
    )


def most_cars(records: tuple[CutRecord, ...]) -> int:
    """Cars of the longest cut."""
    return max(record.cars for record in records)


@dataclass(frozen=True)
class TrainSource:
    """Trains of `cuts` cuts of a population, or the humped cuts of a list again and again, with cars, law and weather
    of `people`, over `routes`."""

    of: TrainPopulation | SortingList
    people: CutPopulation
    routes: tuple[Route, ...]
    seed: int
    cuts: int
    one_wind_a_train: bool = False

    def trains(self, first: int, count: int) -> TrainCuts:
        """Trains `first` … `first + count − 1`; each is the same whatever the others."""
        if isinstance(self.of, SortingList):
            return list_trains(self.of, self.people, self.routes, self.seed, first, count, self.one_wind_a_train)
        return trains(self.of, self.people, self.routes, self.seed, first, count, self.cuts, self.one_wind_a_train)
