"""Kernel of the free roll: cuts along the track, forwards over stations and backwards from one place.

A lane goes its own steps, whatever its neighbours do; one that has arrived or stopped waits for them.
"""

from __future__ import annotations

import math

from synth.kernels.compiling import borrowing
from synth.kernels.roll.felt_track import LANES, bends_between, fall_at, lanes_from, start_by_themselves
from synth.kernels.roll.roll_step import FINE_M, SHORT_M, even_steps, next_step, stepped
from synth.kernels.vector import packs


@borrowing
def roll_on(way, cuts, start_m, energy, stations_m, step_m, energy_at, time_at_s, stop_m, first, last):
    """Roll cuts `first` … `last` − 1, multiples of `LANES`, from `start_m` (n,) with `energy` (n,) over the increasing
    `stations_m` (k, n), by steps of `step_m` for a single car.

    Fills `energy_at` and `time_at_s` (k, n), heads at the stations: 0 and infinite behind a stop; `stop_m` (n,): where
    the cut stops, infinite if it rolls at the last station.
    """
    linear = 1e-3 * cuts.linear
    for i in range(first, last, LANES):
        lanes, x, e = lanes_from(cuts, i), packs.load16(start_m, i), packs.load16(energy, i)
        v, time = packs.root(e + e), packs.choose(x == x, 0.0, x)
        fall, total = fall_at(way, cuts, lanes, x)
        stopped = packs.choose(e <= 0.0, x, math.inf)
        for k in range(stations_m.shape[0]):
            target = packs.load16(stations_m, k * stations_m.shape[1] + i)
            longest = even_steps(target - x, lanes.long_steps * step_m)
            limit, moving = longest, (target > x) & (stopped == math.inf)
            while packs.holds_anywhere(moving):
                left = target - x
                h = next_step(longest, left, limit, e)
                beyond, total_beyond = fall_at(way, cuts, lanes, x + h)
                v2, head, early_v2, early_head = bends_between(way, cuts, lanes, x, h)
                more = (total_beyond - total) / h - 0.5 * (fall + beyond) - early_head
                later, more_e = stepped(
                    lanes, linear, h, beyond - fall - head - h * lanes.constant, more, v2, early_v2, e, v
                )
                goes = moving & packs.opposite(later <= 0.0)
                limit = longest
                if packs.holds_anywhere(moving & (later <= 0.0)):
                    stops = moving & (later <= 0.0) & (h <= SHORT_M)
                    stopped = packs.choose(stops, x + h * e / (e - later), stopped)
                    limit = packs.choose(goes, longest, packs.greatest(h * 0.25, SHORT_M))
                    later = packs.greatest(later, 0.0)
                    moving = moving & packs.opposite(stops)
                v_later = packs.root(later + later)
                slowness = 2.0 / (v + v_later)
                less = packs.least(packs.greatest(more_e * slowness * slowness, -0.5), 0.5)
                time = packs.choose(goes, time + h * slowness * (1.0 - less), time)
                e, v = packs.choose(goes, later, e), packs.choose(goes, v_later, v)
                x = packs.choose(goes, packs.choose(h == left, target, x + h), x)
                fall, total = packs.choose(goes, beyond, fall), packs.choose(goes, total_beyond, total)
                moving = moving & (x < target)
            rolls, at = stopped == math.inf, k * stations_m.shape[1] + i
            packs.store(energy_at, at, packs.choose(rolls, e, 0.0))
            packs.store(time_at_s, at, packs.choose(rolls, time, math.inf))
        packs.store(stop_m, i, stopped)


@borrowing
def roll_back(way, cuts, arrival_m, energy, start_m, step_m, energy_at_start, first, last):
    """Largest `energy_at_start` (n,) at `start_m` (n,) with which cuts have at most `energy` at `arrival_m` (n,), or
    stop before; cuts `first` … `last` − 1, multiples of `LANES`.

    Where a cut that just crawls over a hump of the track arrives faster, the hump decides; 0: even a cut that starts
    from rest arrives faster.
    """
    linear = 1e-3 * cuts.linear
    for i in range(first, last, LANES):
        lanes, x, e = lanes_from(cuts, i), packs.load16(arrival_m, i), packs.load16(energy, i)
        v, target = packs.root(e + e), packs.load16(start_m, i)
        fall, total = fall_at(way, cuts, lanes, x)
        longest = even_steps(x - target, lanes.long_steps * step_m)
        limit, moving = longest, x > target
        while packs.holds_anywhere(moving):
            left = x - target
            h = next_step(longest, left, limit, e)
            before, total_before = fall_at(way, cuts, lanes, x - h)
            v2, head, early_v2, early_head = bends_between(way, cuts, lanes, x - h, h)
            more = (total - total_before) / h - 0.5 * (fall + before) - early_head
            earlier, _ = stepped(
                lanes, linear, h * -1.0, before - fall + head + h * lanes.constant, more, v2 * -1.0, early_v2, e, v
            )
            coarse = (e == 0.0) & (earlier > 0.0) & (h > FINE_M)
            goes = moving & packs.opposite(coarse)
            limit = packs.choose(coarse, packs.greatest(h * 0.25, FINE_M), longest)
            e = packs.choose(goes, packs.greatest(earlier, 0.0), e)
            v = packs.root(e + e)
            x = packs.choose(goes, packs.choose(h == left, target, x - h), x)
            fall, total = packs.choose(goes, before, fall), packs.choose(goes, total_before, total)
            moving = moving & (x > target)
            if packs.holds_anywhere(moving & (e == 0.0)):
                moving = moving & packs.opposite((e == 0.0) & start_by_themselves(way, cuts, lanes, x, target))
        packs.store(energy_at_start, i, e)
