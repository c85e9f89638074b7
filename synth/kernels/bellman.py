"""Backward induction: one common policy of switching lines for all hidden scenarios, for several targets at once.

At every path node and stage the gain of a change over holding is averaged over what the regulator does not
see (scenario, noise level, resting pressure) and over the error of the measured speed; the switching line is
the threshold with the largest total gain beyond it, so islands in the map of best commands cannot tear it.
Targets share the motion; they differ in the terminal cost and so in values and lines, and stand side by
side in memory.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.commands import normal_cdf
from synth.kernels.flow import mix_values, pull, quanta_to_next_sample, shifts
from synth.kernels.thresholds import lower_threshold, upper_threshold
from synth.kernels.transient_sweep import transient_values


@njit(cache=True, nogil=True, error_model="numpy")
def sweep(
    terminal, stalled, change_cost, tolerance, noise, smear_start, smear, prior,
    speed, stage, pressure, lower_chain, upper_chain, chain_mode,
    ends, factors, probability, mean, std, levels, transition,
    drive, brake, factor, extra, path_step, energy_step, period, reach,
    values, lower, upper, gain_down, gain_up,
):  # fmt: skip
    """One backward sweep over all path quanta.

    `terminal` (E·T,) cost by exit energy and target, `stalled` (T,) cost of a stall, `change_cost` (T,) of a
    command, `tolerance` below which a gain is rounding. I scenarios: `factor`, `extra` (I,); `prior` (1 or N, I, H, L,
    1 or E) weights of what is hidden;
    `smear_start` (E,), `smear` (E, W): probability of true speeds given a measured one. Outputs: `values`
    (I, N + 1, H, L, E·T), `lower`, `upper` (N, K + 1, T), `gain_down`, `gain_up` (N, K + 1, T, E): averaged cost
    saved by the change, by measured speed.
    """
    count, nodes, width = factor.shape[0], drive.shape[0], stalled.shape[0]
    modes, size, points = pressure.shape[0], levels.shape[0], speed.shape[0]
    ahead = np.empty((count, reach, modes, size, points * width))
    mixed = np.empty((count, nodes + 1, modes, size, points * width))
    holds = np.empty((count, modes, size, points * width))
    downs = np.empty((count, modes, size, points * width))
    ups = np.empty((count, modes, size, points * width))
    shift = np.empty((count, modes, size))
    scratch = np.empty(points * width)
    values[:, nodes] = terminal
    mixed[:, nodes] = terminal
    ahead[:] = terminal
    for n in range(nodes - 1, -1, -1):
        for i in range(count):
            shifts(n, factor[i], levels, drive, brake, pressure, extra[i], path_step, energy_step, shift[i])
            for r in range(reach - 2, -1, -1):
                pull(ahead[i, r], transition, shift[i], stalled, 1, points, ahead[i, r + 1], scratch)
            for h in range(modes):
                for q in range(size):
                    a = shift[i, h, q] * energy_step / path_step
                    hold_values(ahead[i, :, h, q], speed, a, period, path_step, width, holds[i, h, q])
                    downs[i, h, q] = holds[i, h, q]
                    ups[i, h, q] = holds[i, h, q]
                    for side in range(2):
                        c = upper_chain[h] if side == 1 else lower_chain[h]
                        if c < 0:
                            continue
                        changed = ups[i, h, q] if side == 1 else downs[i, h, q]
                        transient_values(
                            n, nodes, c, q, factor[i], chain_mode[c], ends, factors, probability, mean,
                            std, drive, brake, pressure, levels, extra[i], path_step, energy_step,
                            values[i], mixed[i], stalled, changed,
                        )  # fmt: skip
                        for j in range(points):
                            for t in range(width):
                                changed[j * width + t] += change_cost[t]
        average_gains(holds, downs, ups, stage, prior[min(n, prior.shape[0] - 1)], width, gain_down[n], gain_up[n])
        for k in range(lower.shape[1]):
            for t in range(width):
                spread(gain_down[n, k, t], smear_start, smear, scratch)
                spread(gain_up[n, k, t], smear_start, smear, scratch)
                lower[n, k, t] = lower_threshold(gain_down[n, k, t], speed, tolerance)
                upper[n, k, t] = max(upper_threshold(gain_up[n, k, t], speed, tolerance), lower[n, k, t])
        for h in range(modes):
            k = stage[h]
            for j in range(1, points):
                for t in range(width):
                    down = normal_cdf((lower[n, k, t] - speed[j]) / noise)
                    up = normal_cdf((speed[j] - upper[n, k, t]) / noise)
                    at = j * width + t
                    for i in range(count):
                        for q in range(size):
                            changed = down * downs[i, h, q, at] + up * ups[i, h, q, at]
                            values[i, n, h, q, at] = sampled_value(
                                1.0 - down - up, changed, ahead[i, 1, h, q, at], holds[i, h, q, at],
                                speed[j], shift[i, h, q] * energy_step / path_step, period, path_step,
                            )  # fmt: skip
            values[:, n, h, :, :width] = stalled
        for i in range(count):
            mix_values(values[i, n], transition, 1, points, stalled, mixed[i, n])
            ahead[i, 0] = values[i, n]


@njit(cache=True, nogil=True, error_model="numpy")
def hold_values(ahead, speed, acceleration, period, path_step, width, out):
    """Value of holding until the next sample; `ahead` (M + 1, E·T), `out` (E·T,).

    Where the next sample falls into the same quantum, holding means going on to the next node.
    """
    last = ahead.shape[0] - 2
    for j in range(speed.shape[0]):
        f = quanta_to_next_sample(speed[j], acceleration, period, path_step)
        step = min(int(f), last)
        x = 1.0 if step == 0 else min(f - step, 1.0)
        for at in range(j * width, (j + 1) * width):
            out[at] = (1.0 - x) * ahead[step, at] + x * ahead[step + 1, at]


@njit(cache=True, nogil=True, error_model="numpy")
def sampled_value(hold, changed, value_next, value_hold, speed, acceleration, period, path_step):
    """Value at a sample: `hold` probability of holding, `changed` the changes' values times probabilities."""
    f = quanta_to_next_sample(speed, acceleration, period, path_step)
    if f < 1.0:  # the next sample may be at this node again: sum the geometric series
        return (hold * f * value_next + changed) / (1.0 - hold * (1.0 - f))
    return hold * value_hold + changed


@njit(cache=True, nogil=True, error_model="numpy")
def average_gains(holds, downs, ups, stage, prior, width, gain_down, gain_up):
    """Cost saved by a change, averaged over what is hidden given stage and speed; outputs (K + 1, T, E)."""
    gain_down[:] = 0.0
    gain_up[:] = 0.0
    points = holds.shape[3] // width
    for h in range(stage.shape[0]):
        k = stage[h]
        for i in range(holds.shape[0]):
            for q in range(holds.shape[2]):
                weight = prior[i, h, q, 0]
                for j in range(1, points):
                    if prior.shape[3] > 1:
                        weight = prior[i, h, q, j]
                    for t in range(width):
                        at = j * width + t
                        gain_down[k, t, j] += weight * (holds[i, h, q, at] - downs[i, h, q, at])
                        gain_up[k, t, j] += weight * (holds[i, h, q, at] - ups[i, h, q, at])


@njit(cache=True, nogil=True, error_model="numpy")
def spread(gain, start, weights, scratch):
    """Average `gain` (E,) over the true speeds behind every measured speed, in place."""
    points = gain.shape[0]
    for j in range(points):
        total = 0.0
        for m in range(weights.shape[1]):
            total += weights[j, m] * gain[start[j] + m]
        scratch[j] = total
    gain[:] = scratch[:points]
