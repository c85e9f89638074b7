"""Backward induction where a command may be given at every sample: one common policy, a pair of lines for each mode.

As in `kernels.sweep.bellman`: the gain of a command over holding is averaged over what the regulator does not see
(scenario, noise level, true speed behind the measured one), and a line is the threshold with the largest total gain
beyond it. All states are valued, in all scenarios at once.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.any_time.occupancy import DOWN, HOLD, UP, chances
from synth.kernels.any_time.period import NEAREST, ROOM, longer_quanta, look_ahead, pull_period
from synth.kernels.any_time.value import change_levels_back
from synth.kernels.sweep.flow import interpolation
from synth.kernels.sweep.thresholds import lower_threshold, upper_threshold
from synth.kernels.vector.borrowing import borrowing, borrowing_inline


@njit(cache=True, nogil=True, error_model="numpy")
def induce(
    reading, noise, smear_start, smear, tolerance, periods, kpa, way, target, share, prior, mixing, factor, extra,
    motion, path, terminal, stalled, change_cost, rough_m2_s2, allowed, lines,
):  # fmt: skip
    """Fills `lines` (2, N, M) in readings; ∓inf: no command.

    `smear_start` (E,), `smear` (E, W): true speeds behind a measured one; a gain below `tolerance` is rounding. `prior`
    (I, L) weights of scenario and noise level, `factor` (I, L) of the friction, `extra` (I,) acceleration. Where
    values bend by more than `rough_m2_s2`, interpolated ones are kept between those that they come from. `allowed`
    (2, N, M): whether a mode may be left downward and upward. The rest as of `occupancy.occupy` and `value.value`.
    """
    nodes, modes, (count, levels) = lines.shape[1], lines.shape[2], factor.shape
    points, ways, ring = terminal.shape[0], target.shape[0], motion[4].shape[0] + 1
    row, scale = points + ROOM, 1.0 / noise
    rows = np.zeros((count, ways, levels, ring, row))
    values, led = np.zeros((count, modes, levels, row)), np.zeros((count, levels, kpa.shape[0], row))
    gain, chance, scratch = np.zeros(points), np.zeros((3, row)), np.zeros((3, row))
    of_node, rough = np.zeros(motion[4].shape[0], np.int64), np.zeros((count, ways, levels, ring), np.int64)
    free, braking = np.zeros(of_node.shape[0]), np.zeros(of_node.shape[0])
    rows[:, :, :, nodes % ring, :points] = terminal
    rows[:, :, :, nodes % ring, 0] = stalled
    rough[:, :, :, nodes % ring] = rough_until(rows[0, 0, 0, nodes % ring], points, rough_m2_s2)
    for n in range(nodes - 1, -1, -1):
        for i in range(count):
            look_ahead(n, extra[i], motion, path, ring, of_node, free, braking)
            ahead = of_node, free, braking
            for d in range(kpa.shape[0]):
                for q in range(levels):
                    taken, of_way = kpa[d] * factor[i, q], rows[i, way[d], q]
                    pull_period(ahead, taken, motion, of_way, 1, points, led[i, q, d], scratch)
                    smooth_from = np.max(rough[i, way[d], q]) + int(taken * braking[-1]) + 4
                    pull_kept_between(ahead, taken, motion, of_way, 1, min(smooth_from, points), led[i, q, d])
        for m in range(modes):
            for side in range(2):
                lines[side, n, m] = np.inf if side == 1 else -np.inf
                if allowed[side, n, m]:
                    average_gain(led, periods[m, HOLD], periods[m, 2 * side], prior, change_cost, gain)
                    behind_measured(gain, smear_start, smear, scratch[0])
                    if side == 0:
                        lines[0, n, m] = lower_threshold(gain, reading[:points], tolerance)
                    else:
                        lines[1, n, m] = upper_threshold(gain, reading[:points], tolerance)
            lines[1, n, m] = max(lines[1, n, m], lines[0, n, m])
            chances(lines[0, n, m], lines[1, n, m], reading, scale, periods[m], 0, points, chance)
            for i in range(count):
                for q in range(levels):
                    decide(led[i, q], periods[m], chance, change_cost, stalled, values[i, m, q])
                change_levels_back(values[i, m], 1, points, mixing, scratch)
        for i in range(count):
            for w in range(ways):
                for q in range(levels):
                    to = rows[i, w, q, n % ring]
                    at_way(values[i, :, q], target[w], share[w], points, stalled, to)
                    rough[i, w, q, n % ring] = rough_until(to, points, rough_m2_s2)


@borrowing
def at_way(values, target, share, points, stalled, out):
    """`out` (E',): values of modes (M, E') as the value of a way that leads to some, kept between theirs."""
    for j in range(1, points):
        total = low = high = values[target[0], j]
        total *= share[0]
        for b in range(1, 4):
            if share[b] != 0.0:
                other = values[target[b], j]
                total += share[b] * other
                low, high = min(low, other), max(high, other)
        out[j] = min(max(total, low), high)
    out[0] = stalled


@borrowing
def rough_until(row, points, least):
    """The first energy from which on `row` bends less than `least` within three cells."""
    for j in range(points - 2, 0, -1):
        if abs(row[j - 1] - 2.0 * row[j] + row[j + 1]) > least:
            return j + 2
    return 0


@borrowing
def pull_kept_between(ahead, kpa, motion, rows, begin, end, out):
    """As `pull_period`, every interpolated value kept between those that it is interpolated from.

    Beside a stall the cost jumps by thousands of times what is to be gained elsewhere. A polynomial across the jump
    would promise costs below zero, and the policy would brake towards them.
    """
    of_node, free, braking = ahead
    bands, points = motion[4], motion[0].shape[0] - ROOM
    for middle in range(NEAREST, bands.shape[0] - 1):
        bend = longer_quanta(free[middle] - kpa * braking[middle], middle, motion)
        for j in range(max(begin, bands[middle]), min(end, bands[middle + 1])):
            total, low, high = 0.0, np.inf, -np.inf
            for side in range(3):
                to = middle + side - 1
                found = kept_between(rows[of_node[to]], j + free[to] - kpa * braking[to], points)
                total += found * parabola_at(motion[0][j] + bend, middle, side)
                low, high = min(low, found), max(high, found)
            out[j] = min(max(total, low), high)


@borrowing_inline
def parabola_at(quanta, middle, side):
    """Weight of node `middle` + `side` − 1 at the end of a period that is so many quanta long."""
    x = max(quanta, 1.0) - middle
    return 1.0 - x * x if side == 1 else 0.5 * x * (x + (side - 1.0))


@borrowing
def kept_between(row, position, points):
    """`row` at `position` in cells, kept between the four values around it."""
    i, c0, c1, c2, c3 = interpolation(position, points)
    low = min(min(row[i - 1], row[i]), min(row[i + 1], row[i + 2]))
    high = max(max(row[i - 1], row[i]), max(row[i + 1], row[i + 2]))
    return min(max(c0 * row[i - 1] + c1 * row[i] + c2 * row[i + 1] + c3 * row[i + 2], low), high)


@borrowing
def average_gain(led, hold, command, prior, change_cost, gain):
    """Cost saved by a command, averaged over scenario and noise level, `gain` (E,)."""
    gain[:] = 0.0
    for i in range(prior.shape[0]):
        for q in range(prior.shape[1]):
            for j in range(1, gain.shape[0]):
                gain[j] += prior[i, q] * (led[i, q, hold, j] - led[i, q, command, j] - change_cost)


@borrowing
def behind_measured(gain, start, weights, scratch):
    """Average `gain` (E,) over the true speeds behind every measured speed, in place."""
    for j in range(gain.shape[0]):
        scratch[j] = 0.0
        for w in range(weights.shape[1]):
            scratch[j] += weights[j, w] * gain[start[j] + w]
    for j in range(gain.shape[0]):
        gain[j] = scratch[j]


@borrowing
def decide(led, periods, chance, change_cost, stalled, out):
    """Value at a sample under the chances of the commands, `out` (E',)."""
    for j in range(1, chance.shape[1] - ROOM):
        held = led[periods[HOLD], j]
        out[j] = held
        if periods[DOWN] >= 0:
            out[j] += chance[DOWN, j] * (led[periods[DOWN], j] + change_cost - held)
        if periods[UP] >= 0:
            out[j] += chance[UP, j] * (led[periods[UP], j] + change_cost - held)
    out[0] = stalled
