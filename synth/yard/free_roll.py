"""Drawn cuts on a track: forwards over stations, and backwards from the place of coupling (method of rolling)."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from plant_models.rolling.car_mix import CarMix
from plant_models.rolling.random_cuts import CutPopulation, DrawnCuts
from plant_models.rolling.roll_track import RollTrack
from synth.kernels.roll import free_roll as kernel

Floats = NDArray[np.float64]

STEP_M = 5.0
"""Longest step of a roll; its error is in the tests and in `study rolling`."""

NODE_M = 0.25
"""Distance of the nodes at which the fall of a type of car is worked out; between them it is linear."""

TOGETHER = 512
"""Cuts that one thread takes at a time."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Rolled:
    """How n cuts rolled over k stations: `speed_m_s` and `time_s` (n, k), 0 and infinite behind a stop; `stop_m` (n,):
    where the head stopped, infinite where it rolls at the last station."""

    speed_m_s: Floats
    time_s: Floats
    stop_m: Floats


@dataclass(frozen=True, eq=False)
class RollingCuts:
    """Cuts made ready for the kernel on one track. Build it with `rolling_cuts`."""

    cuts: DrawnCuts
    way: kernel.Way
    arrays: kernel.Cuts

    def __len__(self) -> int:
        return len(self.cuts)

    def roll_on(self, start_m: Floats, speed_m_s: Floats, stations_m: Floats, step_m: float = STEP_M) -> Rolled:
        """Roll each cut from the head position `start_m` (n,) with `speed_m_s` (n,) over `stations_m` (n, k), which
        increase from there on."""
        count, stations = stations_m.shape
        energy, time, stop = np.empty((count, stations)), np.empty((count, stations)), np.empty(count)
        start, begins, at = flat(start_m), flat(0.5 * speed_m_s**2), flat(stations_m)

        def part(first: int, last: int) -> None:
            kernel.roll_on(self.way, self.arrays, start, begins, at, step_m, energy, time, stop, first, last)

        side_by_side(part, count)
        return Rolled(np.sqrt(2.0 * energy), time, stop)

    def roll_back(self, arrival_m: Floats, speed_m_s: float, start_m: Floats, step_m: float = STEP_M) -> Floats:
        """The highest speeds (n,) at `start_m` (n,) with which the cuts have at most `speed_m_s` at `arrival_m` (n,), or
        stop before; 0 where even a cut from rest arrives faster."""
        count = len(self)
        energy = np.empty(count)
        arrival, start, ends = flat(arrival_m), flat(start_m), np.full(count, 0.5 * speed_m_s**2)

        def part(first: int, last: int) -> None:
            kernel.roll_back(self.way, self.arrays, arrival, ends, start, step_m, energy, first, last)

        side_by_side(part, count)
        return np.asarray(np.sqrt(2.0 * energy))


def rolling_cuts(population: CutPopulation, track: RollTrack, yard_from_m: float, cuts: DrawnCuts) -> RollingCuts:
    """`cuts` of `population` on `track`; behind `yard_from_m` they roll in the yard, where snow lies and no extra
    resistance of the slope counts."""
    return RollingCuts(cuts, way_of(population, track, yard_from_m, cuts.mix), arrays_of(population, cuts))


def way_of(population: CutPopulation, track: RollTrack, yard_from_m: float, mix: CarMix) -> kernel.Way:
    """The track as each type of `mix` feels it, from its length before the crest to the end."""
    longest = max(car.car.length_m for car in mix.cars)
    first = -np.ceil(longest)
    nodes = first + NODE_M * np.arange(int(np.ceil((track.end_m - first) / NODE_M)) + 2)
    fall = np.empty((len(mix.cars), len(nodes)))
    for row, mixed in enumerate(mix.cars):
        car = mixed.car
        overhang = (car.length_m - car.axle_offsets_m[-1]) / 2.0
        axles = nodes[:, None] - overhang - np.asarray(car.axle_offsets_m)
        extra = population.law.slope_extra_n_per_kn * np.minimum(axles, yard_from_m)
        snow = population.weather.snow_n_per_kn * np.maximum(axles - yard_from_m, 0.0)
        fall[row] = (track.fall_m(axles) - 1e-3 * (extra + snow)).mean(axis=1)
    bends = np.array([(bend.from_m, bend.to_m) for bend in track.bends]).reshape(-1, 2)
    return kernel.Way(float(first), 1.0 / NODE_M, fall, bends)


def arrays_of(population: CutPopulation, cuts: DrawnCuts) -> kernel.Cuts:
    """What the kernel needs of `cuts`."""
    return kernel.Cuts(
        types=np.ascontiguousarray(cuts.types, dtype=np.int64),
        shares=flat(cuts.shares),
        fronts_m=flat(cuts.car_fronts_m),
        lengths_m=flat(cuts.car_lengths_m),
        gravity_m_s2=flat(cuts.reduced_gravity_m_s2),
        constant=flat(cuts.resistance_n_per_kn),
        linear=float(population.law.linear_n_per_kn),
        air=flat(cuts.air_n_per_kn),
        wind_m_s=flat(cuts.head_wind_m_s),
        bend_v2=flat(cuts.bend_v2_m_s2),
        bend_head=flat(cuts.bend_head_m),
    )


def flat(values: Floats) -> Floats:
    """A contiguous copy, which may be written: the kernel is compiled for such arrays alone."""
    return np.array(values, dtype=np.float64, order="C")


def side_by_side(part: Callable[[int, int], None], count: int) -> None:
    """Call `part(first, last)` for all cuts, some at a time; each cut is worked out alone, so threads change nothing."""
    starts = range(0, count, TOGETHER)
    with ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        list(pool.map(lambda start: part(start, min(start + TOGETHER, count)), starts))
