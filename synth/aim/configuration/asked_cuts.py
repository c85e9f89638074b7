"""Which cuts a file asks tables for: weight categories and numbers of cars."""

from __future__ import annotations

from plant_models import PlantError
from plant_models.errors import require
from plant_models.library import WeightCategories, WeightCategory
from plant_models.rolling.random_cuts import MOST_CARS
from synth.aim.configuration.settings import AimFileSettings


def members_of(categories: WeightCategories, settings: AimFileSettings) -> tuple[WeightCategory, ...]:
    """The categories that are asked for, all if none is; `PlantError` for unknown ones, and for one named twice."""
    if settings.cuts.categories is None:
        return categories.members
    members: list[WeightCategory] = []
    for place, name in enumerate(settings.cuts.categories):
        try:
            member = categories.named(name)
        except PlantError as fault:
            raise PlantError(f"cuts.categories[{place}]: {fault}") from None
        require(member not in members, f"cuts.categories[{place}] is {name!r}, which is there before; leave it out")
        members.append(member)
    return tuple(members)


def require_cars(settings: AimFileSettings) -> None:
    """`PlantError` unless the numbers of cars increase within what a cut has."""
    cars = settings.cuts.cars
    for place, count in enumerate(cars):
        require(1 <= count <= MOST_CARS, f"cuts.cars[{place}] is {count}; a cut has 1 to {MOST_CARS} cars")
        require(
            place == 0 or count > cars[place - 1],
            f"cuts.cars[{place}] is {count} after {cars[place - 1]}; give the numbers of cars in increasing order",
        )
