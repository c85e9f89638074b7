"""Probabilities of the regulator's commands under a noisy speed measurement."""

from __future__ import annotations

import math

from synth.kernels.vector.borrowing import borrowing


@borrowing
def command_probabilities(lower, upper, speed, noise, down, up, down_slope, up_slope):
    """P(measured < lower), P(measured > upper) and their derivatives by the line, at every node.

    `lower`, `upper` (N, K + 1); `speed` (E,); `noise` std of the measured speed; outputs (N, K + 1, E).
    """
    scale = 1.0 / max(noise, 1e-6)
    for n in range(lower.shape[0]):
        for k in range(lower.shape[1]):
            for j in range(speed.shape[0]):
                a = (lower[n, k] - speed[j]) * scale
                b = (speed[j] - upper[n, k]) * scale
                down[n, k, j] = normal_cdf(a)
                up[n, k, j] = normal_cdf(b)
                down_slope[n, k, j] = normal_density(a) * scale
                up_slope[n, k, j] = -normal_density(b) * scale


@borrowing
def normal_cdf(z):
    """Φ(z), exactly 0 or 1 beyond six standard deviations."""
    if z > 6.0:
        return 1.0
    if z < -6.0:
        return 0.0
    return 0.5 * math.erfc(-z * 0.7071067811865476)


@borrowing
def normal_density(z):
    """φ(z), zero beyond six standard deviations."""
    if abs(z) > 6.0:
        return 0.0
    return 0.3989422804014327 * math.exp(-0.5 * z * z)
