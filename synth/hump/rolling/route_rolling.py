"""Cuts of different numbers of cars, each on its own route, rolled side by side: routes as the cars of a mix feel them,
falls worked out once for routes that fall alike; and cuts that roll on as one, coupled.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from plant_models.cut import GRAVITY_M_S2
from plant_models.frozen_arrays import Floats, Ints, read_only
from plant_models.hump import Route
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts, bend_scales_m
from synth.kernels.roll.felt_track import LANES, Cuts, Way
from synth.kernels.roll.lane_cuts import CutRows, RouteRows, lay_in_lanes
from synth.simulation.free_roll import STEP_M, Rolled, in_lanes, long_steps, roll_lanes, way_of

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


Number = TypeVar("Number", bound=np.generic)


def coupled_rows(cuts: CutRows, members: Ints, mass_t: Floats, nodes_per_m: float) -> CutRows:
    """The cuts `members` (n, k), rows of `cuts` with the first ahead, −1 behind the last one, as n cuts; `mass_t`
    (rows,).

    Every force is the sum of those of the members, but the air is taken to be met with one head wind: the one that
    gives the right force as far as it grows with the speed. One bend holds all of it up alike.
    """
    there, of = members >= 0, np.maximum(members, 0)
    weights = np.where(there, mass_t[of], 0.0)
    total = in_turn(weights)
    shares = weights / total[:, None]
    lengths = np.where(there, cuts.length_m[of], 0.0)
    offsets = np.concatenate((np.zeros((len(of), 1)), np.cumsum(lengths, axis=1)[:, :-1]), axis=1)
    air = shares * cuts.air[of]
    alone = ~there[:, 1:].any(axis=1)
    first = of[:, 0]
    met = in_turn(air * (cuts.wind_m_s[of] - cuts.wind_m_s[first][:, None]))
    gravity = 1.0 / in_turn(shares / cuts.gravity_m_s2[of])
    number = np.where(there, cuts.cars[of], 0).sum(axis=1)
    behind = (offsets * nodes_per_m)[:, :, None]
    real = (np.arange(cuts.shares.shape[1]) < cuts.cars[of][:, :, None]) & there[:, :, None]
    order = np.argsort(~real.reshape(len(of), -1), axis=1, kind="stable")[:, : int(number.max(initial=1))]

    def of_cars(values: NDArray[Number]) -> NDArray[Number]:
        return np.take_along_axis(values.reshape(len(of), -1), order, axis=1)

    return CutRows(
        cars=number,
        rows=of_cars(np.where(real, cuts.rows[of], 0)),
        shares=of_cars(np.where(real, cuts.shares[of] * shares[:, :, None], 0.0)),
        nodes=of_cars(np.where(real, cuts.nodes[of] + behind, cuts.nodes[first][:, :1, None])),
        middles_m=of_cars(np.where(real, cuts.middles_m[of] + offsets[:, :, None], 0.0)),
        length_m=in_turn(lengths),
        long_steps=long_steps(number),
        gravity_m_s2=np.where(alone, cuts.gravity_m_s2[first], gravity),
        constant=in_turn(shares * cuts.constant[of]),
        air=in_turn(air),
        # Read-only as those of single cuts: kernels are compiled once for both.
        wind_m_s=read_only(cuts.wind_m_s[first] + met / np.maximum(in_turn(air), 1e-300)),
        v2_draws=read_only(in_turn(shares[:, :, None] * cuts.v2_draws[of])),
        head_draws=read_only(in_turn(shares[:, :, None] * cuts.head_draws[of])),
    )


def in_turn(values: Floats) -> Floats:
    """Sums over the second axis, first to last: members that are not there change no bit."""
    total = values[:, 0].copy()
    for k in range(1, values.shape[1]):
        total += values[:, k]
    return total


@dataclass(frozen=True, eq=False)
class RouteRolling:
    """`cuts` made ready for the kernel on any of the routes of `ways`; from `rolling_on`.

    The bends of `cuts` are draws (`DrawnCuts.on_bends`): draw b is that of bend b of whichever route a cut takes. So a
    cut meets the bends ahead of a parting in the same way on both routes. Each cut is worked out alone, and threads
    change nothing. `linear_n_per_kn`: of the law of resistance.
    """

    ways: RouteWays
    cuts: DrawnCuts
    rows: CutRows
    linear_n_per_kn: float
    threads: int = 0

    def __len__(self) -> int:
        return len(self.cuts)

    def roll_on(
        self,
        rows: Ints,
        routes: Ints,
        start_m: Floats,
        speed_m_s: Floats,
        stations_m: Floats,
        resistance_n_per_kn: Floats | None = None,
    ) -> Rolled:
        """Roll the cuts `rows` (m,), which may repeat, on `routes` (m,), from the head positions `start_m` (m,) with
        `speed_m_s` (m,) over `stations_m` (m, k), which increase. With `resistance_n_per_kn` (m,) they have that w0.

        A station beyond the end of the route counts as the end; at one that is not ahead of the last, or of the start,
        nothing changes. A cut of speed 0 stands. `ValueError` for a start or speed that is not finite.
        """
        if not (np.isfinite(start_m).all() and np.isfinite(speed_m_s).all()):
            raise ValueError("roll: start_m and speed_m_s must be finite")
        if len(rows) == 0:
            return Rolled(np.empty(stations_m.shape), np.empty(stations_m.shape), np.empty(0))
        order = np.argsort(-self.rows.cars[rows].astype(np.int16), kind="stable")
        constant = self.rows.constant[rows] if resistance_n_per_kn is None else 1e-3 * resistance_n_per_kn
        cut_of, route_of = in_lanes(rows[order]), in_lanes(routes[order])
        lanes = self._lanes(len(cut_of), int(self.rows.cars[cut_of[0]]), in_lanes(constant[order]))

        def lay(first: int, last: int) -> None:
            lay_in_lanes(self.rows, self.ways.rows, cut_of, route_of, lanes, first, last)

        stations = np.minimum(stations_m, self.ways.rows.ends_m[routes][:, None])
        sorted_roll = roll_lanes(
            self.ways.way, lanes, start_m[order], speed_m_s[order], stations[order], STEP_M, self.threads, lay
        )
        back = np.empty_like(order)
        back[order] = np.arange(len(order))
        return Rolled(sorted_roll.speed_m_s[back], sorted_roll.time_s[back], sorted_roll.stop_m[back])

    def coupled(self, members: Ints) -> RouteRolling:
        """The cuts `members` (n, k), the first ahead, −1 behind the last one, coupled to n cuts."""
        rows = coupled_rows(self.rows, members, self.cuts.cut_mass_t, float(self.ways.way.nodes_per_m))
        return replace(self, rows=rows)

    def inertia_t(self, rows: Ints) -> Floats:
        """Mass of the cuts `rows` (m,) with that of their wheels as they turn."""
        return np.asarray(self.cuts.cut_mass_t[rows] * GRAVITY_M_S2 / self.rows.gravity_m_s2[rows])

    def fall_m(self, rows: Ints, routes: Ints, head_m: Floats) -> Floats:
        """How far the cuts `rows` (m,) on `routes` (m,) have fallen when their heads are at `head_m` (m,), as the
        kernel takes it: cars by their mass, less the heads that snow and the slope's extra resistance take."""
        place = head_m[:, None] * self.ways.way.nodes_per_m - self.rows.nodes[rows]
        node = np.clip(place, 0.0, self.ways.way.fall_m.shape[1] - 1.5).astype(np.int64)
        at = self.ways.rows.rows_from[routes][:, None] + self.rows.rows[rows] + node
        falls = self.ways.way.fall_m.reshape(-1)
        return np.asarray(
            (self.rows.shares[rows] * (falls[at] + (place - node) * (falls[at + 1] - falls[at]))).sum(axis=1)
        )

    def _lanes(self, count: int, cars: int, constant: Floats) -> Cuts:
        """Lanes to be laid."""
        of_cars, of_bends = (cars, count), (self.ways.bends, count)
        return Cuts(
            cars_of_pack=np.empty(count // LANES, dtype=np.int64),
            rows=np.empty(of_cars, dtype=np.int64),
            shares=np.empty(of_cars),
            nodes=np.empty(of_cars),
            middles_m=np.empty(of_cars),
            length_m=np.empty(count),
            long_steps=np.empty(count),
            gravity_m_s2=np.empty(count),
            constant=constant,
            linear=self.linear_n_per_kn,
            air=np.empty(count),
            wind_m_s=np.empty(count),
            bends_from_m=np.empty(of_bends),
            bends_to_m=np.empty(of_bends),
            bends_per_m=np.empty(of_bends),
            bend_v2=np.empty(of_bends),
            bend_head=np.empty(of_bends),
        )


def rolling_on(ways: RouteWays, population: CutPopulation, cuts: DrawnCuts, threads: int = 0) -> RouteRolling:
    """`cuts` on `ways`, by the law of resistance and the weather of `population`.

    Behind the yard's beginning of its route a cut rolls in the yard. `threads` roll them, 0: one a processor.
    """
    if cuts.mix != ways.mix or cuts.bend_v2_m_s2.shape[1] < ways.bends:
        raise ValueError(f"roll: the cuts must be of the mix of the routes, and have draws for {ways.bends} bends")
    fronts, lengths = cuts.car_fronts_m, cuts.car_lengths_m
    rows = CutRows(
        cars=cuts.cars_of_cut,
        rows=cuts.types * ways.way.fall_m.shape[1],
        shares=cuts.shares,
        nodes=(fronts + ways.first_m) * ways.way.nodes_per_m,
        middles_m=fronts + 0.5 * lengths,
        length_m=lengths.sum(axis=1),
        long_steps=long_steps(cuts.cars_of_cut),
        gravity_m_s2=cuts.reduced_gravity_m_s2,
        constant=1e-3 * cuts.resistance_n_per_kn,
        air=1e-3 * cuts.air_n_per_kn,
        wind_m_s=cuts.head_wind_m_s,
        v2_draws=cuts.bend_v2_m_s2,
        head_draws=cuts.bend_head_m,
    )
    return RouteRolling(ways, cuts, rows, float(population.law.linear_n_per_kn), threads)
