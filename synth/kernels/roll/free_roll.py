"""Kernel of the free roll: de/dx of a cut along the track, by Heun's rule on its energy e = v²/2 (method of rolling).

What the track gives and what does not depend on speed enters by exact differences along a step; the rule's error comes
from air and bends alone. Near e = 0, where the root of e has no slope, steps are made anew in PARTS parts.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synth.kernels.vector.borrowing import borrowing, borrowing_inline

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

PARTS = 16
"""Of a step in which the energy changes by more than UNEVEN of itself: there the root of e bends."""

UNEVEN = 0.3
"""Such a step is made anew in parts: it is the last one before a stop, or the first one after a start."""


class Way(NamedTuple):
    """The track as each type of car feels it: `fall_m` (types, nodes) is the mean fall of its axles, less the head that
    resistance beyond that of the cut takes there, when its front coupler is at `first_m` + node / `nodes_per_m`.
    `bends_m` (bends, 2): where they begin and end."""

    first_m: float
    nodes_per_m: float
    fall_m: Floats
    bends_m: Floats


class Cuts(NamedTuple):
    """n cuts, as `plant_models.rolling.DrawnCuts`: `places` (types × nodes, flat) of each car's row in `fall_m`; arrays
    of cars (n, cars), of cuts (n,), of bends (n, bends)."""

    types: Ints
    shares: Floats
    fronts_m: Floats
    lengths_m: Floats
    gravity_m_s2: Floats
    constant: Floats
    linear: float
    air: Floats
    wind_m_s: Floats
    bend_v2: Floats
    bend_head: Floats


@borrowing_inline
def fall_at(way, cuts, i, x):
    """Fall of cut `i` when its head is at `x`, metres; beyond the table as at its ends."""
    nodes, total = way.fall_m.shape[1], 0.0
    for j in range(cuts.types.shape[1]):
        place = (x - cuts.fronts_m[i, j] - way.first_m) * way.nodes_per_m
        place = min(max(place, 0.0), nodes - 1.000001)
        node = int(place)
        kind = cuts.types[i, j]
        low, high = way.fall_m[kind, node], way.fall_m[kind, node + 1]
        total += cuts.shares[i, j] * (low + (place - node) * (high - low))
    return total


@borrowing_inline
def bends_between(way, cuts, i, x, h):
    """Head that the bends take while the head of cut `i` goes from `x` to `x` + `h`: (per (m/s)², whatever the speed).

    Each car meets a bend with its middle.
    """
    v2, head = 0.0, 0.0
    for b in range(way.bends_m.shape[0]):
        begins, ends = way.bends_m[b, 0], way.bends_m[b, 1]
        for j in range(cuts.types.shape[1]):
            middle = x - cuts.fronts_m[i, j] - 0.5 * cuts.lengths_m[i, j]
            inside = min(middle + h, ends) - max(middle, begins)
            if inside > 0.0:
                part = cuts.shares[i, j] * inside / (ends - begins)
                v2 += part * cuts.bend_v2[i, b]
                head += part * cuts.bend_head[i, b]
    return v2, head


@borrowing_inline
def speed_head(cuts, i, e, h, bend_v2):
    """Head that whatever depends on the speed takes on `h` metres at the energy `e`, metres."""
    v = math.sqrt(2.0 * e)
    against = v + cuts.wind_m_s[i]
    return 1e-3 * h * (cuts.linear * v + cuts.air[i] * against * abs(against)) + bend_v2 * v * v


@borrowing_inline
def ahead(way, cuts, i, x, h, fall, e):
    """(energy, fall) `h` metres on from `x`, where the fall is `fall` and the energy `e`; the energy may come out
    negative: then the cut stops on the way."""
    beyond = fall_at(way, cuts, i, x + h)
    v2, head = bends_between(way, cuts, i, x, h)
    steady = beyond - fall - head - 1e-3 * h * cuts.constant[i]
    g = cuts.gravity_m_s2[i]
    here = speed_head(cuts, i, e, h, v2)
    there = speed_head(cuts, i, max(e + g * (steady - here), 0.0), h, v2)
    return e + g * (steady - 0.5 * (here + there)), beyond


@borrowing_inline
def behind(way, cuts, i, x, h, fall, e):
    """(energy, fall) `h` metres before `x` of the cut that has `e` at `x`; negative where it would not have reached `x`
    with so little."""
    before = fall_at(way, cuts, i, x - h)
    v2, head = bends_between(way, cuts, i, x - h, h)
    steady = fall - before - head - 1e-3 * h * cuts.constant[i]
    g = cuts.gravity_m_s2[i]
    here = speed_head(cuts, i, e, h, v2)
    there = speed_head(cuts, i, max(e - g * (steady - here), 0.0), h, v2)
    return e - g * (steady - 0.5 * (here + there)), before


@borrowing_inline
def mean_time_s(h, e, later):
    """Time for `h` metres at an even acceleration between two energies, one of them positive."""
    return 2.0 * h / (math.sqrt(2.0 * e) + math.sqrt(2.0 * later))


@borrowing_inline
def ahead_in_parts(way, cuts, i, x, h, fall, e):
    """(energy, time, stop) as `ahead`, in parts; `stop`: where the cut stops, infinite if it does not."""
    time, part = 0.0, h / PARTS
    for _ in range(PARTS):
        later, beyond = ahead(way, cuts, i, x, part, fall, e)
        if later <= 0.0:
            return 0.0, math.inf, x + part * e / (e - later)
        time += mean_time_s(part, e, later)
        x, fall, e = x + part, beyond, later
    return e, time, math.inf


@borrowing
def roll_on(way, cuts, start_m, energy, stations_m, step_m, energy_at, time_at_s, stop_m, first, last):
    """Roll cuts `first` … `last` − 1 from `start_m` (n,) with `energy` (n,) over the increasing `stations_m` (n, k).

    Fills `energy_at` and `time_at_s` (n, k), heads at the stations: 0 and infinite behind a stop; `stop_m` (n,): where
    the cut stops, infinite if it rolls at the last station.
    """
    for i in range(first, last):
        x, e, time, stopped = start_m[i], energy[i], 0.0, math.inf
        if e <= 0.0:
            stopped = x
        fall = fall_at(way, cuts, i, x)
        for k in range(stations_m.shape[1]):
            gap = stations_m[i, k] - x
            steps = max(1, int(math.ceil(gap / step_m - 1e-9)))
            h, from_m = gap / steps, x
            if stopped == math.inf and gap > 0.0:
                for n in range(steps):
                    x = from_m + n * h
                    later, beyond = ahead(way, cuts, i, x, h, fall, e)
                    if abs(later - e) > UNEVEN * min(e, later):
                        later, part_s, stopped = ahead_in_parts(way, cuts, i, x, h, fall, e)
                        time += part_s
                        if stopped != math.inf:
                            break
                    else:
                        time += mean_time_s(h, e, later)
                    e, fall = later, beyond
                x = stations_m[i, k]
            energy_at[i, k] = e if stopped == math.inf else 0.0
            time_at_s[i, k] = time if stopped == math.inf else math.inf
        stop_m[i] = stopped


@borrowing
def roll_back(way, cuts, arrival_m, energy, start_m, step_m, energy_at_start, first, last):
    """Largest `energy_at_start` (n,) at `start_m` (n,) with which cuts have at most `energy` at `arrival_m` (n,), or stop before.

    Where a cut that just crawls over a hump of the track arrives faster, the hump decides; 0: even a cut that starts
    from rest arrives faster.
    """
    for i in range(first, last):
        x, e, gap = arrival_m[i], energy[i], arrival_m[i] - start_m[i]
        steps = max(1, int(math.ceil(gap / step_m - 1e-9)))
        h, fall = gap / steps, fall_at(way, cuts, i, x)
        for n in range(steps):
            x = arrival_m[i] - n * h
            earlier, before = behind(way, cuts, i, x, h, fall, e)
            if abs(earlier - e) > UNEVEN * min(e, earlier):
                earlier = back_in_parts(way, cuts, i, x, h, fall, e)
            e, fall = earlier, before
        energy_at_start[i] = e


@borrowing_inline
def back_in_parts(way, cuts, i, x, h, fall, e):
    """As `behind`, in PARTS parts, none of which ends below 0."""
    part = h / PARTS
    for n in range(PARTS):
        e, fall = behind(way, cuts, i, x - n * part, part, fall, e)
        e = max(e, 0.0)
    return e
