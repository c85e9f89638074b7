"""Backward induction where a command may be given at every sample: one common policy, a pair of lines for each mode.

A mode is what the regulator knows of its drive at a sample (stage, pressure, wait); each has its own thresholds, taken
as in `kernels.bellman`: the gain of a command over holding is averaged over what the regulator does not see (scenario,
noise level, true speed behind the measured one), and the threshold is the one with the largest total gain beyond it.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.sweep.commands import normal_cdf
from synth.kernels.sweep.thresholds import lower_threshold, upper_threshold
from synth.studies.unlocked.kernels.unlocked_step import landed_value, move

HOLD = 1
"""Place of the hold among the commands down, hold, up."""


@njit(cache=True, nogil=True, error_model="numpy")
def unlocked_sweep(
    terminal, stalled, change_cost, tolerance, noise, smear_start, smear, weight, stationary,
    speed, allowed, target, share, over, end_over, levels, transitions, factor, extra,
    lift, work, per_metre, path_step, energy_step, part, extract, lower, upper, first,
):  # fmt: skip
    """One backward sweep over all path quanta.

    `terminal` (E,) cost by exit energy, `stalled` of a stall, `change_cost` of a command, `tolerance` below which a
    gain is rounding; `smear_start` (E,), `smear` (E, W) true speeds behind a measured one; `weight`, `factor`, `extra`
    (I,) scenarios, `stationary`, `levels` (L,) of η, `transitions` (A + 1, L, L) over 0 … A quanta; modes as in
    `unlocked.drive_modes`; `lift`, `work` (W + 1,) see `kernels.unlocked_step`. `lower`, `upper` (N, M): found if
    `extract`, else the policy that is evaluated. `first` (A + 1, I, L, E): value of mode 0 at the nodes 0 … A.
    """
    nodes, modes = lower.shape
    reach = transitions.shape[0] - 1
    points, size, count = speed.shape[0], levels.shape[0], factor.shape[0]
    exit_m = nodes * path_step
    ring = np.empty((reach + 1, count, modes, size, points))
    ring[:] = terminal  # beyond the exit nothing brakes: the value is that of the exit energy
    mixed = np.empty((reach + 1, modes, size, points))
    rows = np.empty((reach + 1, points))
    values = np.empty((3, count, modes, size, points))
    gain = np.empty((2, points))
    scratch = np.empty(points)
    for n in range(nodes - 1, -1, -1):
        for i in range(count):
            for r in range(1, reach + 1):
                mix(ring[(n + r) % (reach + 1), i], transitions[r], mixed[r])
            for m in range(modes):
                for a in range(3):
                    for q in range(size):
                        out = values[a, i, m, q]
                        if not allowed[m, a]:
                            out[:] = 0.0
                            continue
                        combine(mixed, target[m, a], share[m, a], q, rows)
                        f = factor[i] * (1.0 + levels[q])
                        price = 0.0 if a == HOLD else change_cost
                        period_values(
                            n, speed, f, extra[i], over[m, a], end_over[m, a], part, rows, price, stalled,
                            path_step, energy_step, lift, work, per_metre, exit_m, out,
                        )  # fmt: skip
        for m in range(modes):
            if extract:
                average(values, m, weight, stationary, gain)
                lower[n, m], upper[n, m] = -np.inf, np.inf
                if allowed[m, 0]:
                    behind_measured(gain[0], smear_start, smear, scratch)
                    lower[n, m] = lower_threshold(gain[0], speed, tolerance)
                if allowed[m, 2]:
                    behind_measured(gain[1], smear_start, smear, scratch)
                    upper[n, m] = max(upper_threshold(gain[1], speed, tolerance), lower[n, m])
            decide(values, m, lower[n, m], upper[n, m], speed, noise, stalled, ring[n % (reach + 1)])
    for r in range(reach + 1):
        for i in range(count):
            first[r, i] = ring[r % (reach + 1), i, 0]


@njit(cache=True, nogil=True, error_model="numpy")
def mix(values, transition, out):
    """`out`[m, q] = Σ_k transition[q, k]·values[m, k]; shapes (M, L, E)."""
    for m in range(values.shape[0]):
        for q in range(values.shape[1]):
            for j in range(values.shape[2]):
                total = transition[q, 0] * values[m, 0, j]
                for k in range(1, values.shape[1]):
                    total += transition[q, k] * values[m, k, j]
                out[m, q, j] = total


@njit(cache=True, nogil=True, error_model="numpy")
def combine(mixed, target, share, q, rows):
    """`rows` (A + 1, E): the values at the nodes ahead, interpolated in pressure; row 0 is not used.

    Kept between the values it was interpolated from: a pressure more or less may be what stops a cut.
    """
    for r in range(1, mixed.shape[0]):
        for j in range(rows.shape[1]):
            value = low = high = mixed[r, target[0], q, j]
            value *= share[0]
            for b in range(1, target.shape[0]):
                if share[b] != 0.0:
                    other = mixed[r, target[b], q, j]
                    value += share[b] * other
                    low, high = min(low, other), max(high, other)
            rows[r, j] = min(max(value, low), high)


@njit(cache=True, nogil=True, error_model="numpy")
def period_values(
    n, speed, f, extra, over, end_over, part, rows, price, stalled,
    path_step, energy_step, lift, work, per_metre, exit_m, out,
):  # fmt: skip
    """Value of one command at node `n` for every speed, `out` (E,)."""
    out[0] = stalled
    for j in range(1, speed.shape[0]):
        s, e = move(n * path_step, 0.5 * speed[j] * speed[j], f, extra, over, part, lift, work, per_metre, exit_m)
        if e <= 0.0:
            out[j] = stalled
        else:
            out[j] = price + landed_value(
                rows, n, s, e, f * end_over, extra, path_step, energy_step, lift, work, per_metre, exit_m, stalled
            )


@njit(cache=True, nogil=True, error_model="numpy")
def average(values, m, weight, stationary, gain):
    """Cost saved by going down and up at mode `m`, averaged over scenario and noise level, `gain` (2, E)."""
    gain[:] = 0.0
    for i in range(weight.shape[0]):
        for q in range(stationary.shape[0]):
            w = weight[i] * stationary[q]
            for j in range(1, gain.shape[1]):
                hold = values[HOLD, i, m, q, j]
                gain[0, j] += w * (hold - values[0, i, m, q, j])
                gain[1, j] += w * (hold - values[2, i, m, q, j])


@njit(cache=True, nogil=True, error_model="numpy")
def decide(values, m, lower, upper, speed, noise, stalled, out):
    """Expected value at mode `m` under its lines and the noise of the measured speed; `out` (I, M, L, E)."""
    for j in range(1, speed.shape[0]):
        down = normal_cdf((lower - speed[j]) / noise)
        up = normal_cdf((speed[j] - upper) / noise)
        for i in range(out.shape[0]):
            for q in range(out.shape[2]):
                out[i, m, q, j] = (
                    down * values[0, i, m, q, j] + up * values[2, i, m, q, j]
                    + (1.0 - down - up) * values[HOLD, i, m, q, j]
                )  # fmt: skip
    out[:, m, :, 0] = stalled


@njit(cache=True, nogil=True, error_model="numpy")
def behind_measured(gain, start, weights, scratch):
    """Average `gain` (E,) over the true speeds behind every measured speed, in place; `scratch` (E,)."""
    for j in range(gain.shape[0]):
        total = 0.0
        for m in range(weights.shape[1]):
            total += weights[j, m] * gain[start[j] + m]
        scratch[j] = total
    gain[:] = scratch
