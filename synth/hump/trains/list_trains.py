"""Trains of a sorting list: what the list tells stands, what it does not tell is drawn for each of them."""

from __future__ import annotations

import numpy as np

from plant_models.errors import PlantError, require
from plant_models.frozen_arrays import Floats, Ints
from plant_models.hump import Route
from plant_models.library.weight_category import WeightCategory
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.random_numbers import Purpose, uniform_numbers
from synth.hump.control.cut_record import CutRecord
from synth.hump.control.sorting_list import SortingList
from synth.hump.control.train_population import DrawnTrains
from synth.hump.trains.listed_cars import ListedCars
from synth.hump.trains.train_cuts import Draw, TrainCuts, cuts_on_routes, routes_to


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
