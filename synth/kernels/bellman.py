"""Backward induction: one common policy of switching lines for all hidden scenarios.

At every path node and stage the gain of a change over holding is averaged over what the regulator does not
see (scenario, noise level, resting pressure) and over the error of the measured speed; the switching line is
the threshold with the largest total gain beyond it, so islands in the map of best commands cannot tear it.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.commands import normal_cdf
from synth.kernels.flow import pull, quanta_to_next_sample, shifts
from synth.kernels.policy_value import mix_values
from synth.kernels.transient_sweep import transient_values


@njit(cache=True, nogil=True)
def sweep(
    terminal, stalled, change_cost, tolerance, noise, smear_start, smear, occupancy, prior,
    speed, stage, pressure, lower_chain, upper_chain, chain_mode,
    travel, energy, factors, probability, mean, std, levels, transition,
    drive, brake, factor, extra, path_step, energy_step, period, reach,
    values, lower, upper, gain_down, gain_up,
):  # fmt: skip
    """One backward sweep over all path quanta.

    I scenarios: `factor`, `extra` (I,); `prior` (I, H, L) weights; `occupancy` (I, N, H, L, E) expected samples
    under a former policy, or length 0; `smear_start` (E,), `smear` (E, W): probability of true speeds given a
    measured one. Outputs: `values` (I, N + 1, H, L, E), `lower`, `upper` (N, K + 1), `gain_down`, `gain_up`
    (N, K + 1, E): averaged cost saved by the change, by measured speed.
    """
    count, nodes = factor.shape[0], drive.shape[0]
    modes, size, points = pressure.shape[0], levels.shape[0], speed.shape[0]
    ahead = np.empty((count, reach, modes, size, points))
    mixed = np.empty((count, nodes + 1, modes, size, points))
    holds = np.empty((count, modes, size, points))
    downs = np.empty((count, modes, size, points))
    ups = np.empty((count, modes, size, points))
    shift = np.empty((count, modes, size))
    scratch = np.empty(points)
    cells = np.empty(points, dtype=np.int64)
    values[:, nodes] = terminal
    mixed[:, nodes] = terminal
    ahead[:] = terminal
    for n in range(nodes - 1, -1, -1):
        for i in range(count):
            shifts(n, factor[i], levels, drive, brake, pressure, extra[i], path_step, energy_step, shift[i])
            for r in range(reach - 2, -1, -1):
                pull(ahead[i, r], transition, shift[i], stalled, 1, points, ahead[i, r + 1], scratch)
            for h in range(modes):
                for l in range(size):
                    a = shift[i, h, l] * energy_step / path_step
                    hold_values(ahead[i, :, h, l], speed, a, period, path_step, holds[i, h, l])
                    downs[i, h, l] = holds[i, h, l]
                    ups[i, h, l] = holds[i, h, l]
                    for side in range(2):
                        c = upper_chain[h] if side == 1 else lower_chain[h]
                        if c < 0:
                            continue
                        transient_values(
                            n, nodes, c, l, factor[i], chain_mode[c], travel, energy, factors, probability, mean,
                            std, drive, brake, pressure, levels, extra[i], path_step, energy_step,
                            values[i], mixed[i], stalled, cells, scratch,
                        )  # fmt: skip
                        changed = ups[i, h, l] if side == 1 else downs[i, h, l]
                        changed[:] = scratch
                        changed += change_cost
        average_gains(n, holds, downs, ups, stage, occupancy, prior, gain_down[n], gain_up[n])
        for k in range(lower.shape[1]):
            spread(gain_down[n, k], smear_start, smear, scratch)
            spread(gain_up[n, k], smear_start, smear, scratch)
            lower[n, k] = lower_threshold(gain_down[n, k], speed, tolerance)
            upper[n, k] = max(upper_threshold(gain_up[n, k], speed, tolerance), lower[n, k])
        for h in range(modes):
            k = stage[h]
            for j in range(1, points):
                down = normal_cdf((lower[n, k] - speed[j]) / noise)
                up = normal_cdf((speed[j] - upper[n, k]) / noise)
                for i in range(count):
                    for l in range(size):
                        values[i, n, h, l, j] = chosen_value(
                            down, up, downs[i, h, l, j], ups[i, h, l, j], ahead[i, :, h, l, j], holds[i, h, l, j],
                            speed[j], shift[i, h, l] * energy_step / path_step, period, path_step,
                        )  # fmt: skip
            values[:, n, h, :, 0] = stalled
        for i in range(count):
            mix_values(values[i, n], transition, 1, points, stalled, mixed[i, n])
            ahead[i, 0] = values[i, n]


@njit(cache=True, nogil=True)
def hold_values(ahead, speed, acceleration, period, path_step, out):
    """Value of holding until the next sample; `ahead` (M + 1, E), `out` (E,).

    Where the next sample falls into the same quantum, holding means going on to the next node.
    """
    last = ahead.shape[0] - 2
    for j in range(speed.shape[0]):
        f = quanta_to_next_sample(speed[j], acceleration, period, path_step)
        step = min(int(f), last)
        x = 1.0 if step == 0 else min(f - step, 1.0)
        out[j] = (1.0 - x) * ahead[step, j] + x * ahead[step + 1, j]


@njit(cache=True, nogil=True)
def chosen_value(down, up, value_down, value_up, ahead, value_hold, speed, acceleration, period, path_step):
    """Value at a sample whose command is random because the measured speed is."""
    hold = 1.0 - down - up
    changed = down * value_down + up * value_up
    f = quanta_to_next_sample(speed, acceleration, period, path_step)
    if f < 1.0:
        return (hold * f * ahead[1] + changed) / (1.0 - hold * (1.0 - f))
    return hold * value_hold + changed


@njit(cache=True, nogil=True)
def average_gains(n, holds, downs, ups, stage, occupancy, prior, gain_down, gain_up):
    """Cost saved by a change, averaged over what is hidden given stage and speed; outputs (K + 1, E).

    Weights: the occupancy of the hidden states at this speed, plus a little of the prior where none was.
    """
    gain_down[:] = 0.0
    gain_up[:] = 0.0
    points = holds.shape[3]
    total = np.zeros((gain_down.shape[0], points))
    for h in range(stage.shape[0]):
        k = stage[h]
        for i in range(holds.shape[0]):
            for l in range(holds.shape[2]):
                for j in range(points):
                    weight = prior[i, h, l]
                    if occupancy.shape[0] > 0:
                        weight = max(occupancy[i, n, h, l, j], 0.0) + 1e-7 * weight
                    total[k, j] += weight
                    gain_down[k, j] += weight * (holds[i, h, l, j] - downs[i, h, l, j])
                    gain_up[k, j] += weight * (holds[i, h, l, j] - ups[i, h, l, j])
    for k in range(gain_down.shape[0]):
        for j in range(points):
            gain_down[k, j] /= max(total[k, j], 1e-300)
            gain_up[k, j] /= max(total[k, j], 1e-300)
        gain_down[k, 0] = 0.0
        gain_up[k, 0] = 0.0


@njit(cache=True, nogil=True)
def spread(gain, start, weights, scratch):
    """Average `gain` (E,) over the true speeds behind every measured speed, in place."""
    for j in range(gain.shape[0]):
        total = 0.0
        for m in range(weights.shape[1]):
            total += weights[j, m] * gain[start[j] + m]
        scratch[j] = total
    gain[:] = scratch


@njit(cache=True, nogil=True)
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


@njit(cache=True, nogil=True)
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


@njit(cache=True, nogil=True)
def beyond(gain, tolerance):
    """The part of a gain or loss that exceeds the tolerance."""
    if gain > tolerance:
        return gain - tolerance
    if gain < -tolerance:
        return gain + tolerance
    return 0.0


@njit(cache=True, nogil=True)
def crossing(a, b, low, high):
    """Where the line through (low, a) and (high, b) is zero, kept within [low, high]."""
    if (a < 0.0) == (b < 0.0):
        return 0.5 * (low + high)
    return low + (high - low) * a / (a - b)
