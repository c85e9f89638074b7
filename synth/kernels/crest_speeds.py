"""Kernel of hump speeds: the dynamic programme over the steps of the signal, train by train."""

from __future__ import annotations

import math

from synth.kernels.compiling import borrowing, part_inline


@borrowing
def soonest_over_the_crest(apart_m, headway_s, steps_m_s, most_change_per_m, short_costs, known, came, speeds_m_s):
    """Fill `speeds_m_s` (trains, cuts) with the steps with which each train is over the crest the soonest.

    `apart_m` (trains, cuts), `headway_s` (trains, cuts, leaders): see `SpeedMethod`. v² changes by at most
    `most_change_per_m` on a metre, but to a neighbouring step always. A second of a headway that is not kept counts
    like `short_costs` seconds. Work: `known` (2, steps, leaders + 1), of a cut and the next one, by its step: times
    from the cut 0, 1, … ahead of it, then what the way to it costs; `came` (cuts, steps), the step before each.
    """
    count, leaders = len(steps_m_s), headway_s.shape[2]
    for train in range(len(apart_m)):
        for step in range(count):
            for leader in range(leaders + 1):
                known[0, step, leader] = 0.0
        for cut in range(1, apart_m.shape[1]):
            apart = apart_m[train, cut]
            for to in range(count):
                least, best = math.inf, 0
                for at in range(count):
                    change = abs(steps_m_s[at] * steps_m_s[at] - steps_m_s[to] * steps_m_s[to])
                    if abs(at - to) > 1 and change > most_change_per_m * apart:
                        continue
                    time, short = apart / (0.5 * (steps_m_s[at] + steps_m_s[to])), 0.0
                    for leader in range(min(leaders, cut)):
                        short = max(short, headway_s[train, cut, leader] - time - known[0, at, leader])
                    total = known[0, at, leaders] + (time + short_costs * short)
                    if total < least:
                        least, best = total, at
                came[cut, to] = best
                go_on(known, to, best, apart / (0.5 * (steps_m_s[best] + steps_m_s[to])), least)
            for step in range(count):
                for leader in range(leaders + 1):
                    known[0, step, leader] = known[1, step, leader]
        trace_back(known, came, steps_m_s, train, speeds_m_s)


@part_inline
def go_on(known, to, best, took_s, costs_s):
    """What is known of the next cut with the step `to`, which comes `took_s` behind the last one with `best`."""
    leaders = known.shape[2] - 1
    known[1, to, 0], known[1, to, leaders] = 0.0, costs_s
    for leader in range(leaders - 1):
        known[1, to, leader + 1] = known[0, best, leader] + took_s


@part_inline
def trace_back(known, came, steps_m_s, train, speeds_m_s):
    """Fill the speeds of a train, from its last cut, with the cheapest step, back to its first one."""
    at, costs = 0, known.shape[2] - 1
    for step in range(1, len(steps_m_s)):
        if known[0, step, costs] < known[0, at, costs]:
            at = step
    for cut in range(speeds_m_s.shape[1] - 1, -1, -1):
        speeds_m_s[train, cut] = steps_m_s[at]
        at = came[cut, at]
