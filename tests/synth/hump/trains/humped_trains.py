"""Cuts on routes, and trains of them.

Cuts made ready to roll on routes that are made ready for them alone.
Trains that were humped on the large hump without a plan, so fast that cuts catch up with one another.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from plant_models.hump import Route
from plant_models.library.hump_entry import HumpEntry, load_hump
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from plant_models.rolling.roll_track import Weather
from synth.hump.control.train_population import TrainPopulation
from synth.hump.rolling.hump_position import Arrivals, NormalHumpPosition
from synth.hump.rolling.hump_routes import hump_routes
from synth.hump.rolling.humping import Hump, humped
from synth.hump.rolling.route_rolling import RouteRolling, rolling_on, route_ways
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_cuts import trains as drawn_trains
from synth.hump.rolling.train_memory import Asked, TrainMemory
from tests.plant_models.rolling.populations import CATEGORIES, MIX, population


def route_rolling(
    population: CutPopulation, routes: tuple[Route, ...], cuts: DrawnCuts, threads: int = 0
) -> RouteRolling:
    """`cuts` on `routes`, by the law of resistance and the weather of `population`."""
    return rolling_on(route_ways(population, routes, cuts.mix), population, cuts, threads)


Floats = NDArray[np.float64]
TRAINS, CUTS = 8, 24
EXITS_M_S = (5.2, 4.4, 1.5)
FIRST, SEED = 3, 11


@dataclass(frozen=True)
class Steady:
    """Every cut is pushed at `speed_m_s`, and commanded the last of `EXITS_M_S` in the last of its `positions`."""

    speed_m_s: float
    positions: int

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        return np.full(memory.crest_s.shape[0], self.speed_m_s)

    def command(self, asked: Asked) -> Floats:
        return np.full(len(asked.lanes), EXITS_M_S[asked.position - self.positions])


def three_metres(arrivals: Arrivals) -> Floats:
    """Energy head of every brake."""
    return np.full(len(arrivals), 3.0)


@dataclass(frozen=True)
class HumpedTrains:
    """What a trace is made of."""

    entry: HumpEntry
    hump: Hump
    trains: TrainCuts
    memory: TrainMemory


@cache
def humped_trains(speed_m_s: float = 2.8, name: str = "large") -> HumpedTrains:
    """`TRAINS` trains from number `FIRST` on; light cars against the wind, some of which stop on the way."""
    entry = load_hump(name)
    routes = hump_routes(entry.graph, entry.graph.leads[0])
    tracks = dict.fromkeys(routes.tracks.tolist(), 1.0)
    listed = TrainPopulation(MIX, CATEGORIES, {1: 0.5, 3: 0.2, 5: 0.3}, tracks, 2.0, 8)
    people = population(MIX, weather=Weather(temperature_c=-20.0, head_wind_mean_m_s=3.0, head_wind_std_m_s=3.0))
    trains = drawn_trains(listed, people, routes.routes, SEED, FIRST, TRAINS, CUTS)
    position = NormalHumpPosition(0.3, three_metres)
    hump = Hump(
        routes, (position,) * routes.positions, route_rolling(trains.population, routes.routes, trains.drawn, 1)
    )
    rng = np.random.default_rng(3)
    free_m = np.array([route.length_m for route in routes.routes]) - rng.uniform(50.0, 450.0, (TRAINS, len(tracks)))
    steady = Steady(speed_m_s, routes.positions)
    return HumpedTrains(entry, hump, trains, humped(hump, trains, free_m, steady, steady))
