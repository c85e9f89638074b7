"""The fewest cut classes of a book that stand for all cuts of a trial."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from plant_models.errors import PlantError
from plant_models.library.weight_category import WeightCategory
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation
from synth.hump.trains.class_choice import nearest_axles
from synth.hump.trains.needed_tables import Kind

MASSES: Final = 1000
"""Points of the law of masses that the mean of a category is taken over."""

MOST_CARS: Final = 60
"""Of a class."""


@dataclass(frozen=True)
class NeededClass:
    """`cars` coupled cars of the type `car`, of a weight category; `mass_t`: of all of them together."""

    category: WeightCategory
    car: str
    cars: int
    mass_t: float

    @property
    def label(self) -> str:
        """Its name in a configuration."""
        return f"{self.category.latin}-{self.cars}"


def fewest_classes(kinds: Iterable[Kind], people: CutPopulation) -> Iterator[NeededClass]:
    """The classes for these cuts, by category and then by length. They are made of the most frequent type of car that
    can be of the category, and weigh what its cars weigh on the mean. `PlantError` where no equal cars are near
    enough to some cuts."""
    of_category: dict[int, set[int]] = {}
    for place, axles in kinds:
        of_category.setdefault(place, set()).add(axles)
    for place, needed in sorted(of_category.items()):
        member = people.categories.members[place]
        mix = people.mix.of(people.categories, member)
        offered = equal_cars(mix)
        chain = fewest_axles(needed, sorted(offered))
        if not chain:
            raise PlantError(
                f"cars.mix: no equal cars of it can stand for all cuts of category {member.label}, which have "
                f"{min(needed)} to {max(needed)} axles"
            )
        for axles in chain:
            car, cars = offered[axles]
            yield NeededClass(
                member, mix.cars[car].car.name, cars, round(cars * mean_mass_t(mix, people, member, car), 1)
            )


def equal_cars(mix: CarMix) -> dict[int, tuple[int, int]]:
    """(place of the type in the mix, number of cars) by the axles that so many cars of a type have; the most frequent
    type that has so many."""
    by_share = sorted(range(len(mix.cars)), key=lambda place: -mix.cars[place].share)
    found: dict[int, tuple[int, int]] = {}
    for place in by_share:
        for cars in range(1, MOST_CARS + 1):
            found.setdefault(cars * int(mix.axles[place]), (place, cars))
    return found


def mean_mass_t(mix: CarMix, people: CutPopulation, member: WeightCategory, car: int) -> float:
    """Mean mass of a car of the type at the place `car`, in the category `member`."""
    u = (np.arange(MASSES) + 0.5) / MASSES
    return float(mix.masses_t(people.categories, member, np.full(MASSES, car), u).mean())


def fewest_axles(needed: Collection[int], offered: Collection[int]) -> tuple[int, ...]:
    """Of the rising axle numbers `offered` the fewest, and of these the lowest, of which the nearest one stands for
    each of those `needed`; nothing where none do.

    Which of the classes is nearest is decided between two neighbours. So chains grow upwards, a class at a time.
    """

    def served(held: tuple[int, ...], low: float, high: float) -> bool:
        return all(nearest_axles(held, axles) is not None for axles in needed if low <= axles <= high)

    chains: list[tuple[int, ...]] = [(count,) for count in offered if served((count,), 0, count)]
    while chains:
        for chain in chains:
            if served(chain[-1:], chain[-1], np.inf):
                return chain
        longer: dict[int, tuple[int, ...]] = {}
        for chain in chains:
            for count in offered:
                if count > chain[-1] and served((chain[-1], count), chain[-1], count):
                    longer.setdefault(count, (*chain, count))
        chains = list(longer.values())
    return ()
