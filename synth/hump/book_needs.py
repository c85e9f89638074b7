"""What a book for one position of a trial must be made for: how cuts come there, seen on some trains that are humped,
and the fewest cut classes that stand for all of them.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from plant_models.errors import PlantError
from plant_models.frozen_arrays import Floats
from plant_models.library.weight_category import WeightCategory
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation
from synth.frame.faults import InputError
from synth.hump.rolling.table_hump_position import nearest_axles
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.needed_tables import Kind
from synth.hump.trial.resolved_trial import ResolvedTrial
from synth.kernels.cache import guarded

CUTS: Final = 1000
"""Cuts that are humped, or some more: whole trains."""

BEYOND: Final = 0.01
"""Share of the cuts that may come slower than the entry speeds that are told, and the same faster."""

INNER: Final = (0.1, 0.25, 0.5, 0.75, 0.9)
"""The quantiles between these two at which bins of a histogram meet."""

SHARES: Final = [10, 15, 25, 25, 15, 10]
"""Per cent of the cuts in each bin; in both outer ones lie those beyond them, too."""

LOWEST_M_S: Final = 0.3
"""Nothing slower is told."""

FEWEST: Final = 30
"""Cuts of a category that a histogram can be made of."""


@dataclass(frozen=True)
class Entering:
    """How `cuts` cuts came to a position.

    `low_m_s`, `high_m_s`: entry speeds, but for a few. `of_category`: edges of the bins of a histogram of them, by the
    number of the weight category, where there were enough cuts. `command_m_s`: the highest exit speed that one was
    aimed with, None where none was aimed.
    """

    cuts: int
    low_m_s: float
    high_m_s: float
    of_category: Mapping[int, tuple[float, ...]]
    command_m_s: float | None

    def law(self, category: int, top_target_m_s: float, most_m_s: float) -> dict[str, Any]:
        """The entry speeds of a class of this category as a configuration has them; nothing where those of all cuts
        stand for them. The fastest lie above `top_target_m_s`, for a table asks for that, and not above `most_m_s`."""
        edges = self.of_category.get(category, ())
        if not edges:
            return {}
        last = min(max(edges[-1], top_target_m_s), most_m_s)
        kept = [edge for edge in edges[:-1] if edge < last]
        shares = [*SHARES[: len(kept) - 1], sum(SHARES[len(kept) - 1 :])]
        return {"edges_m_s": [*kept, last], "shares": shares}


def entering_at(place: int, config: ResolvedTrial) -> Entering:
    """How cuts come to the position at `place`; `InputError` where none comes."""
    trains = math.ceil(CUTS / config.settings.trains.cuts)
    humped, _, memory = guarded(made_trial(config).humped, 0, trains)
    speeds, commands = memory.entry_m_s[:, :, place], memory.command_m_s[:, :, place]
    came = np.isfinite(speeds)
    if not came.any():
        raise InputError(f"{config.place}: of {trains} trains no cut comes to position {place + 1}: it needs no tables")
    low, high = np.quantile(speeds[came], [BEYOND, 1.0 - BEYOND])
    aimed = commands[np.isfinite(commands) & config.roles.aims[place][memory.route]]
    category = humped.category.reshape(speeds.shape)
    members = enumerate(config.categories.members)
    return Entering(
        cuts=int(came.sum()),
        low_m_s=max(math.floor(10.0 * low) / 10.0, LOWEST_M_S),
        high_m_s=math.ceil(10.0 * high) / 10.0,
        of_category={m.number: bins_of(speeds[came & (category == row)]) for row, m in members},
        command_m_s=float(aimed.max()) if len(aimed) else None,
    )


def bins_of(speeds_m_s: Floats) -> tuple[float, ...]:
    """Edges of the bins of a histogram; nothing of too few cuts, or of those that come with one speed."""
    if len(speeds_m_s) < FEWEST:
        return ()
    edges = np.quantile(speeds_m_s, [BEYOND, *INNER, 1.0 - BEYOND]).clip(LOWEST_M_S).round(2)
    return tuple(edges.tolist()) if (np.diff(edges) > 0.0).all() else ()


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
