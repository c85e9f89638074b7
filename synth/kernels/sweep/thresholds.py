"""Switching lines from gains: the threshold with the largest total gain beyond it."""

from __future__ import annotations

import numpy as np

from synth.kernels.vector.borrowing import borrowing


@borrowing
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


@borrowing
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


@borrowing
def beyond(gain, tolerance):
    """The part of a gain or loss that exceeds the tolerance."""
    if gain > tolerance:
        return gain - tolerance
    if gain < -tolerance:
        return gain + tolerance
    return 0.0


@borrowing
def crossing(a, b, low, high):
    """Where the line through (low, a) and (high, b) is zero, kept within [low, high]."""
    if (a < 0.0) == (b < 0.0):
        return 0.5 * (low + high)
    return low + (high - low) * a / (a - b)
