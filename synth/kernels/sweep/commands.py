"""Probabilities of the regulator's commands under a noisy speed measurement."""

from __future__ import annotations

import math

import numpy as np

from synth.kernels.compiling import borrowing, part

CERTAIN = 6.0
"""So many standard deviations from a line a command is certain, or certainly not given."""


@borrowing
def command_probabilities(lines, reading, noise, out):
    """Probability of each command at every decision, stage and true speed.

    Commands: 2·d − 2 goes down, 2·d − 1 up by d stages. `lines` (C, R, K + 1): what is measured below or above the line
    of a command makes the regulator go so far or farther; `reading` (E,), ascending, what is measured of the true
    speeds, with errors of std `noise`; output (C, R, K + 1, E).
    """
    scale = 1.0 / max(noise, 1e-6)
    for command, n, k in np.ndindex(lines.shape):
        line, row, up = lines[command, n, k], out[command, n, k], command % 2
        begin, end = uncertain(reading, line, scale)
        row[:begin], row[end:] = 1.0 - up, float(up)
        for j in range(begin, end):
            row[j] = normal_cdf((reading[j] - line) * scale) if up else normal_cdf((line - reading[j]) * scale)
    for command in range(lines.shape[0] - 2):  # what goes farther goes not just so far
        for n, k in np.ndindex(lines.shape[1:]):
            for j in range(reading.shape[0]):
                out[command, n, k, j] -= out[command + 2, n, k, j]


@borrowing
def command_slopes(lines, reading, noise, out):
    """Derivatives by the line of the probability to go so far or farther; arguments as of `command_probabilities`."""
    scale = 1.0 / max(noise, 1e-6)
    out[:] = 0.0
    for command, n, k in np.ndindex(lines.shape):
        line, up = lines[command, n, k], command % 2
        begin, end = uncertain(reading, line, scale)
        for j in range(begin, end):
            if up:
                out[command, n, k, j] = -normal_density((reading[j] - line) * scale) * scale
            else:
                out[command, n, k, j] = normal_density((line - reading[j]) * scale) * scale


@part
def uncertain(speed, line, scale):
    """Range of `speed` (E,), ascending, that lies within `CERTAIN` standard deviations 1/`scale` of `line`."""
    return first_above(speed, line, scale, -CERTAIN, False), first_above(speed, line, scale, CERTAIN, True)


@part
def first_above(speed, line, scale, far, beyond):
    """First index of `speed` that is `far` standard deviations above `line` or, if `beyond`, more than that."""
    low, high = 0, speed.shape[0]
    while low < high:
        middle = (low + high) // 2
        z = (speed[middle] - line) * scale
        if z > far or (z == far and not beyond):
            high = middle
        else:
            low = middle + 1
    return low


@part
def normal_cdf(z):
    """Φ(z), exactly 0 or 1 beyond six standard deviations."""
    if z > CERTAIN:
        return 1.0
    if z < -CERTAIN:
        return 0.0
    return 0.5 * math.erfc(-z * 0.7071067811865476)


@part
def normal_density(z):
    """φ(z), zero beyond six standard deviations."""
    if abs(z) > CERTAIN:
        return 0.0
    return 0.3989422804014327 * math.exp(-0.5 * z * z)
