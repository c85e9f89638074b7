"""Probabilities of the regulator's commands under a noisy speed measurement."""

from __future__ import annotations

import math

from synth.kernels.vector.borrowing import borrowing

CERTAIN = 6.0
"""So many standard deviations from a line a command is certain, or certainly not given."""


@borrowing
def command_probabilities(lower, upper, speed, noise, down, up):
    """P(measured < lower) and P(measured > upper) at every node.

    `lower`, `upper` (N, K + 1); `speed` (E,), ascending; `noise` std of the measured speed; outputs (N, K + 1, E).
    """
    scale = 1.0 / max(noise, 1e-6)
    for n in range(lower.shape[0]):
        for k in range(lower.shape[1]):
            begin, end = uncertain(speed, lower[n, k], scale)
            down[n, k, :begin] = 1.0
            for j in range(begin, end):
                down[n, k, j] = normal_cdf((lower[n, k] - speed[j]) * scale)
            down[n, k, end:] = 0.0
            begin, end = uncertain(speed, upper[n, k], scale)
            up[n, k, :begin] = 0.0
            for j in range(begin, end):
                up[n, k, j] = normal_cdf((speed[j] - upper[n, k]) * scale)
            up[n, k, end:] = 1.0


@borrowing
def command_slopes(lower, upper, speed, noise, down, up):
    """Derivatives of `command_probabilities` by the line, arguments as there."""
    scale = 1.0 / max(noise, 1e-6)
    down[:], up[:] = 0.0, 0.0
    for n in range(lower.shape[0]):
        for k in range(lower.shape[1]):
            begin, end = uncertain(speed, lower[n, k], scale)
            for j in range(begin, end):
                down[n, k, j] = normal_density((lower[n, k] - speed[j]) * scale) * scale
            begin, end = uncertain(speed, upper[n, k], scale)
            for j in range(begin, end):
                up[n, k, j] = -normal_density((speed[j] - upper[n, k]) * scale) * scale


@borrowing
def uncertain(speed, line, scale):
    """Range of `speed` (E,), ascending, that lies within `CERTAIN` standard deviations 1/`scale` of `line`."""
    return first_above(speed, line, scale, -CERTAIN, False), first_above(speed, line, scale, CERTAIN, True)


@borrowing
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


@borrowing
def normal_cdf(z):
    """Φ(z), exactly 0 or 1 beyond six standard deviations."""
    if z > CERTAIN:
        return 1.0
    if z < -CERTAIN:
        return 0.0
    return 0.5 * math.erfc(-z * 0.7071067811865476)


@borrowing
def normal_density(z):
    """φ(z), zero beyond six standard deviations."""
    if abs(z) > CERTAIN:
        return 0.0
    return 0.3989422804014327 * math.exp(-0.5 * z * z)
