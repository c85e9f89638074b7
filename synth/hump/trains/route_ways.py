"""Routes of a hump as the cars of a mix feel them: falls, worked out once for routes that fall alike, and bends."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import Ints
from plant_models.hump import Route
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation, bend_scales_m
from synth.kernels.roll.felt_track import Way
from synth.kernels.roll.lane_cuts import RouteRows
from synth.simulation.free_roll import way_of

BEYOND_M = 1e6
"""Where the bends are that a route has fewer than another: no cut comes there."""


@dataclass(frozen=True, eq=False)
class RouteWays:
    """The tables of routes for the cars of `mix`, one below the other, from `first_m` on; from `route_ways`."""

    mix: CarMix
    way: Way
    rows: RouteRows
    first_m: float

    @property
    def bends(self) -> int:
        """Bends of the route that has most."""
        return int(self.rows.bends_from_m.shape[1])


def route_ways(population: CutPopulation, routes: tuple[Route, ...], mix: CarMix | None = None) -> RouteWays:
    """`routes` for cuts of `mix` (else of the population's), by the population's law of resistance and weather."""
    tracks = [route.roll_track for route in routes]
    end = max(track.end_m for track in tracks)
    of_mix = mix or population.mix
    # A cut never comes beyond the end of its route, so falls may go on to the farthest end of all.
    falls = [(replace(track, end_m=end, bends=()), r.yard_from_m) for track, r in zip(tracks, routes, strict=True)]
    different = list(dict.fromkeys(falls))
    ways = [way_of(population, track, yard_from_m, of_mix) for track, yard_from_m in different]
    first_m, each = ways[0][1], [way for way, _ in ways]
    tables = (np.concatenate(table) for table in zip(*(way[1:] for way in each), strict=True))
    way = Way(each[0].nodes_per_m, *tables)
    places = np.array([different.index(fall) for fall in falls])
    return RouteWays(of_mix, way, rows_of(population, routes, places * each[0].fall_m.size), first_m)


def rows_of(population: CutPopulation, routes: tuple[Route, ...], rows_from: Ints) -> RouteRows:
    """What the kernel needs of `routes`, whose tables begin at `rows_from`."""
    bends = [route.roll_track.bends for route in routes]
    shape = len(routes), max(map(len, bends))
    begins, ends = np.full(shape, BEYOND_M), np.full(shape, BEYOND_M + 1.0)
    scales = np.zeros((*shape, 2))
    for row, of_route in enumerate(bends):
        begins[row, : len(of_route)] = [bend.from_m for bend in of_route]
        ends[row, : len(of_route)] = [bend.to_m for bend in of_route]
        scales[row, : len(of_route)] = bend_scales_m(population.law, of_route)
    v2, head = (np.ascontiguousarray(scales[..., place]) for place in (0, 1))
    route_ends = np.array([route.roll_track.end_m for route in routes])
    return RouteRows(rows_from, route_ends, begins, ends, 1.0 / (ends - begins), v2, head)
