"""Where trains of a trial come from: a population of trains, or one sorting list again and again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from plant_models.hump import Route
from plant_models.rolling.random_cuts import CutPopulation
from synth.hump.control.sorting_list import SortingList
from synth.hump.control.train_population import TrainPopulation
from synth.hump.trains.list_trains import list_trains
from synth.hump.trains.train_cuts import TrainCuts, trains


class TrainSource(Protocol):
    """Where trains come from: a population, or one list again and again."""

    def trains(self, first: int, count: int) -> TrainCuts:
        """Trains `first` … `first + count − 1`; each is the same whatever the others."""


@dataclass(frozen=True)
class DrawnSource:
    """Trains of `cuts` cuts of `population`, with law and weather of `people`, over `routes`."""

    population: TrainPopulation
    people: CutPopulation
    routes: tuple[Route, ...]
    seed: int
    cuts: int
    one_wind_a_train: bool

    def trains(self, first: int, count: int) -> TrainCuts:
        """See `TrainSource`."""
        return trains(
            self.population, self.people, self.routes, self.seed, first, count, self.cuts, self.one_wind_a_train
        )


@dataclass(frozen=True)
class ListSource:
    """The humped cuts of `cuts`, with cars, law and weather of `people`, over `routes`."""

    cuts: SortingList
    people: CutPopulation
    routes: tuple[Route, ...]
    seed: int
    one_wind_a_train: bool

    def trains(self, first: int, count: int) -> TrainCuts:
        """See `TrainSource`."""
        return list_trains(self.cuts, self.people, self.routes, self.seed, first, count, self.one_wind_a_train)
