"""Drawn cuts on a track: forwards over stations, and backwards from the place of coupling (method of rolling)."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from plant_models.rolling.roll_track import Bend, RollTrack
from synth.kernels.roll import free_roll as kernel
from synth.kernels.roll.felt_track import LANES, Cuts, Way

STEP_M = 6.0
"""Longest step of a single car; its error is in the tests and in `study rolling`."""

LONGEST_STEPS = 2.0
"""A cut of n cars takes √n as long steps, up to this: grades change under it bit by bit, and it meets less air."""

NODE_M = 0.1
"""Distance of the nodes at which the fall of a type of car is worked out; between them it is linear."""

TOGETHER = 512
"""Cuts that one thread takes at a time."""


@frozen_arrays
class Rolled:
    """How n cuts rolled over k stations: `speed_m_s` and `time_s` (n, k), 0 and infinite behind a stop; `stop_m` (n,):
    where the head stopped, infinite where it rolls at the last station."""

    speed_m_s: Floats
    time_s: Floats
    stop_m: Floats


@dataclass(frozen=True, eq=False)
class RollingCuts:
    """Cuts made ready for the kernel on one track, rolled by `threads`, 0: one a processor; from `rolling_cuts`."""

    cuts: DrawnCuts
    way: Way
    arrays: Cuts
    threads: int = 0

    def __len__(self) -> int:
        return len(self.cuts)

    def fall_m(self, head_m: Floats) -> Floats:
        """How far each cut has fallen when its head is at `head_m` (n,), as the kernel takes it: axle by axle, cars by
        their mass, less the heads that snow and the slope's extra resistance take."""
        nodes, rows, shares = (a[:, : len(self)] for a in (self.arrays.nodes, self.arrays.rows, self.arrays.shares))
        place = head_m * self.way.nodes_per_m - nodes
        node = np.clip(place, 0.0, self.way.fall_m.shape[1] - 1.5).astype(np.int64)
        low, high = self.way.fall_m.reshape(-1)[rows + node], self.way.fall_m.reshape(-1)[rows + node + 1]
        return np.asarray((shares * (low + (place - node) * (high - low))).sum(axis=0))

    def roll_on(self, start_m: Floats, speed_m_s: Floats, stations_m: Floats, step_m: float = STEP_M) -> Rolled:
        """Roll each cut from the head position `start_m` (n,) with `speed_m_s` (n,) over `stations_m` (n, k), which
        increase from there on."""
        return roll_lanes(self.way, self.arrays, start_m, speed_m_s, stations_m, step_m, self.threads)

    def roll_back(self, arrival_m: Floats, speed_m_s: float, start_m: Floats, step_m: float = STEP_M) -> Floats:
        """The highest speeds (n,) at `start_m` (n,) with which the cuts have at most `speed_m_s` at `arrival_m` (n,),
        or stop before; 0 where even a cut from rest arrives faster."""
        arrival, start = in_lanes(arrival_m), in_lanes(start_m)
        ends, energy = np.full_like(start, 0.5 * speed_m_s**2), np.empty_like(start)

        def part(first: int, last: int) -> None:
            kernel.roll_back(self.way, self.arrays, arrival, ends, start, step_m, energy, first, last)

        side_by_side(part, len(start), self.threads)
        return np.asarray(np.sqrt(2.0 * energy[: len(self)]))


def rolling_cuts(
    population: CutPopulation, track: RollTrack, yard_from_m: float, cuts: DrawnCuts, threads: int = 0
) -> RollingCuts:
    """`cuts` of `population` on `track`; behind `yard_from_m` they roll in the yard, where snow lies and no extra
    resistance of the slope counts."""
    way, first_m = way_of(population, track, yard_from_m, cuts.mix)
    return RollingCuts(cuts, way, arrays_of(population, track.bends, cuts, way, first_m), threads)


def roll_lanes(
    way: Way,
    lanes: Cuts,
    start_m: Floats,
    speed_m_s: Floats,
    stations_m: Floats,
    step_m: float,
    threads: int,
    prepare: Callable[[int, int], None] | None = None,
) -> Rolled:
    """Roll `lanes` from `start_m` (n,) with `speed_m_s` (n,) over `stations_m` (n, k); `prepare(first, last)` is called
    before the lanes from `first` to `last` − 1 are rolled."""
    count = len(stations_m)
    start, begins, at = in_lanes(start_m), in_lanes(0.5 * speed_m_s**2), in_lanes(stations_m.T)
    energy, time, stop = np.empty_like(at), np.empty_like(at), np.empty_like(start)

    def part(first: int, last: int) -> None:
        if prepare is not None:
            prepare(first, last)
        kernel.roll_on(way, lanes, start, begins, at, step_m, energy, time, stop, first, last)

    side_by_side(part, len(start), threads)
    return Rolled(np.sqrt(2.0 * energy[:, :count].T), time[:, :count].T.copy(), stop[:count].copy())


def way_of(
    population: CutPopulation, track: RollTrack, yard_from_m: float, mix: CarMix, node_m: float = NODE_M
) -> tuple[Way, float]:
    """The track as each type of `mix` feels it, from its length before the crest to its length behind the end, and the
    place of the front coupler at the first node."""
    longest = max(car.car.length_m for car in mix.cars)
    first = -float(np.ceil(longest))
    nodes = first + node_m * np.arange(int(np.ceil((track.end_m + longest - first) / node_m)) + 3)
    fall, gentlest = np.empty((len(mix.cars), len(nodes))), np.empty((len(mix.cars), len(nodes)))
    for row, mixed in enumerate(mix.cars):
        car = mixed.car
        overhang = (car.length_m - car.axle_offsets_m[-1]) / 2.0
        axles = nodes[:, None] - overhang - np.asarray(car.axle_offsets_m)
        extra = population.law.slope_extra_n_per_kn * np.clip(axles, 0.0, yard_from_m)
        snow = population.weather.snow_n_per_kn * np.maximum(axles - yard_from_m, 0.0)
        fall[row] = (track.fall_m(axles) - 1e-3 * (extra + snow)).mean(axis=1)
        slopes = np.where(nodes[:-1] >= car.length_m, np.diff(fall[row]) / node_m, np.inf)
        gentlest[row] = np.minimum.accumulate(np.append(slopes, np.inf))
    summed = np.cumsum(fall, axis=1) - 0.5 * (fall + fall[:, :1])
    return Way(1.0 / node_m, fall, node_m * summed, gentlest), first


def arrays_of(population: CutPopulation, bends: tuple[Bend, ...], cuts: DrawnCuts, way: Way, first_m: float) -> Cuts:
    """What the kernel needs of `cuts` and of the bends on their track."""
    ends = np.array([(bend.from_m, bend.to_m) for bend in bends]).reshape(-1, 2)
    cars = in_lanes(cuts.cars_of_cut)
    return Cuts(
        cars_of_pack=cars.reshape(-1, LANES).max(axis=1),
        rows=in_lanes(cuts.types.T * way.fall_m.shape[1]),
        shares=in_lanes(cuts.shares.T),
        nodes=in_lanes((cuts.car_fronts_m.T + first_m) * way.nodes_per_m),
        middles_m=in_lanes((cuts.car_fronts_m + 0.5 * cuts.car_lengths_m).T),
        length_m=in_lanes(cuts.car_lengths_m.sum(axis=1)),
        long_steps=long_steps(cars),
        gravity_m_s2=in_lanes(cuts.reduced_gravity_m_s2),
        constant=in_lanes(1e-3 * cuts.resistance_n_per_kn),
        linear=float(population.law.linear_n_per_kn),
        air=in_lanes(1e-3 * cuts.air_n_per_kn),
        wind_m_s=in_lanes(cuts.head_wind_m_s),
        bends_from_m=ends[:, :1].repeat(LANES, axis=1),
        bends_to_m=ends[:, 1:].repeat(LANES, axis=1),
        bends_per_m=(1.0 / (ends[:, 1:] - ends[:, :1])).repeat(LANES, axis=1),
        bend_v2=in_lanes(cuts.bend_v2_m_s2.T),
        bend_head=in_lanes(cuts.bend_head_m.T),
    )


def long_steps(cars: Ints) -> Floats:
    """Longest steps of cuts of so many cars, over that of a single car."""
    return np.asarray(np.minimum(np.sqrt(cars), LONGEST_STEPS))


def in_lanes(values: NDArray[Any]) -> NDArray[Any]:
    """A contiguous copy whose last axis is filled up to whole packs with its last element; it may be written."""
    short = -values.shape[-1] % LANES
    return np.ascontiguousarray(np.concatenate((values, values[..., values.shape[-1] - 1 :].repeat(short, -1)), -1))


def side_by_side(part: Callable[[int, int], None], count: int, threads: int) -> None:
    """Call `part(first, last)` for all cuts, some at a time. Each is worked out alone, so threads change nothing."""
    if count <= TOGETHER or threads == 1:
        part(0, count)
        return
    starts = range(0, count, TOGETHER)
    with ThreadPoolExecutor(max_workers=threads or os.cpu_count() or 1) as pool:
        list(pool.map(lambda start: part(start, min(start + TOGETHER, count)), starts))
