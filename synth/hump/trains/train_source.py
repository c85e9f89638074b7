"""Where trains of a trial come from: a population of trains, or one sorting list again and again."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.hump import Route
from plant_models.rolling.random_cuts import CutPopulation
from synth.hump.control.sorting_list import SortingList
from synth.hump.control.train_population import TrainPopulation
from synth.hump.trains.list_trains import list_trains
from synth.hump.trains.train_cuts import TrainCuts, trains


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
