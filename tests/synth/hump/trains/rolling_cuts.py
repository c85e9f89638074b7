"""Cuts made ready to roll on routes that are made ready for them alone."""

from __future__ import annotations

from plant_models.hump import Route
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from synth.hump.trains.route_rolling import RouteRolling, rolling_on
from synth.hump.trains.route_ways import route_ways


def route_rolling(
    population: CutPopulation, routes: tuple[Route, ...], cuts: DrawnCuts, threads: int = 0
) -> RouteRolling:
    """`cuts` on `routes`, by the law of resistance and the weather of `population`."""
    return rolling_on(route_ways(population, routes, cuts.mix), population, cuts, threads)
