"""Switching lines from gains: the thresholds with the largest total gain beyond them."""

from __future__ import annotations

import numpy as np

from synth.kernels.compiling import part


@part
def find_lines(gain, possible, reading, tolerance, best, chosen, lines):
    """The lines (C, T) of one stage from the gains (C, T, E) of its commands, 2·d − 2 down and 2·d − 1 up by d stages.

    `possible` (2,): by how many stages it can go down and up. A line of a command to go farther lies no nearer than
    that of the next one: together they have the largest total gain that ordered lines can have. `best` (E + 1,) and
    `chosen` (C/2, E + 1) are memory.
    """
    lines[0::2], lines[1::2] = -np.inf, np.inf
    for t in range(lines.shape[1]):
        if lines.shape[0] == 2:
            lines[0, t] = lower_threshold(gain[0, t], reading, tolerance)
            lines[1, t] = max(upper_threshold(gain[1, t], reading, tolerance), lines[0, t])
            continue
        ordered_thresholds(gain[0::2, t], possible[0], reading, tolerance, -1, best, chosen, lines[0::2, t])
        ordered_thresholds(gain[1::2, t], possible[1], reading, tolerance, 1, best, chosen, lines[1::2, t])
        for up in range(1, lines.shape[0], 2):
            lines[up, t] = max(lines[up, t], lines[0, t])


@part
def upper_threshold(gain, speed, tolerance):
    """Speed above which the change pays most in total; +inf if nowhere. Ties go to holding."""
    best, total, at = 0.0, 0.0, -1
    for j in range(gain.shape[0] - 1, 1, -1):
        total += beyond(gain[j], tolerance) * (speed[j] - speed[j - 1])
        if total > best * (1.0 + 1e-12):
            best, at = total, j
    if at < 0:
        return np.inf
    return crossing(gain[at - 1] - tolerance, gain[at] - tolerance, speed[at - 1], speed[at])


@part
def lower_threshold(gain, speed, tolerance):
    """Speed below which the change pays most in total; −inf if nowhere. Ties go to holding."""
    best, total, at = 0.0, 0.0, -1
    for j in range(1, gain.shape[0] - 1):
        total += beyond(gain[j], tolerance) * (speed[j + 1] - speed[j])
        if total > best * (1.0 + 1e-12):
            best, at = total, j
    if at < 0:
        return -np.inf
    return crossing(gain[at] - tolerance, gain[at + 1] - tolerance, speed[at], speed[at + 1])


@part
def ordered_thresholds(gain, count, reading, tolerance, side, best, chosen, out):
    """Thresholds `out` of the first `count` commands of one side (1: up, −1: down), ordered; `gain` (D, E).

    Command d pays over command d − 1 what its gain exceeds that one's by. The thresholds maximise the total, each no
    nearer than the one before: dynamic programming over the readings, from the farthest command to the nearest.
    """
    points = reading.shape[0]
    best[:] = 0.0
    for d in range(count - 1, -1, -1):
        total, top, at = 0.0, best[points], points
        chosen[d, points], best[points] = points, top
        for place in range(points - 1, 1, -1):  # counted from where the side begins
            j = place if side > 0 else points - place
            k = j - side
            total += beyond(excess(gain, d, d, j), tolerance) * abs(reading[j] - reading[k])
            if total + best[place] > top + 1e-12 * abs(top):
                top, at = total + best[place], place
            best[place], chosen[d, place] = top, at
    places, place, first = chosen[:, 0], 2, 0
    for d in range(count):
        place = chosen[d, place]
        places[d] = place
    while first < count and places[first] < points:
        last = first
        while last + 1 < count and places[last + 1] == places[first]:
            last += 1
        j = places[first] if side > 0 else points - places[first]
        k = j - side
        a, b = excess(gain, first, last, k) - tolerance, excess(gain, first, last, j) - tolerance
        line = crossing(a, b, reading[k], reading[j]) if side > 0 else crossing(b, a, reading[j], reading[k])
        out[first : last + 1] = line
        first = last + 1
    for d in range(1, count):
        out[d] = max(out[d], out[d - 1]) if side > 0 else min(out[d], out[d - 1])


@part
def excess(gain, first, last, j):
    """What command `last` pays over the one before `first`, which is holding if there is none."""
    return gain[last, j] - (gain[first - 1, j] if first > 0 else 0.0)


@part
def beyond(gain, tolerance):
    """The part of a gain or loss that exceeds the tolerance."""
    if gain > tolerance:
        return gain - tolerance
    if gain < -tolerance:
        return gain + tolerance
    return 0.0


@part
def crossing(a, b, low, high):
    """Where the line through (low, a) and (high, b) is zero, kept within [low, high]."""
    if (a < 0.0) == (b < 0.0):
        return 0.5 * (low + high)
    return low + (high - low) * a / (a - b)
