"""Cost of a fixed policy that decides at every sample, backward through one scenario, and its slopes by the lines.

The transpose of `occupancy.occupy`: both give the same cost to rounding. Only states that the forward density meets are
valued.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.any_time.occupancy import DOWN, HOLD, UP, chances
from synth.kernels.any_time.period import ROOM, ahead_m2_s2, pull_period, pull_row
from synth.kernels.sweep.commands import CERTAIN, first_above, normal_density
from synth.kernels.sweep.flow import add_row, clear
from synth.kernels.vector.borrowing import borrowing
from synth.kernels.vector.packs import EIGHT


@njit(cache=True, nogil=True, error_model="numpy")
def value(
    lines, reading, noise, periods, kpa, way, target, share, entry, entry_way, entry_kpa, stationary,
    mixing, factor, extra, motion, path, terminal, stalled, change_cost, density, band, way_band, slopes, bends,
):  # fmt: skip
    """The expected cost of a pass; arguments up to `path` and `density`, `band`, `way_band` as of `occupy`.

    `terminal` (E,) cost by exit energy, `stalled` of a stall, `change_cost` of a command. Outputs (2, N, M):
    `slopes`, derivatives of the cost by the lines, and `bends`, its second derivatives by each line alone.
    """
    nodes, modes, levels = lines.shape[1], lines.shape[2], factor.shape[0]
    points, ways, ring = reading.shape[0], target.shape[0], max(motion[4].shape[0] + 1, entry.shape[0] + 1)
    row = points + ROOM
    rows, values = np.zeros((ways, levels, ring, row)), np.zeros((modes, levels, row))
    commanded, chance, scratch = np.zeros((3, row)), np.zeros((3, row)), np.zeros(row)
    of_node = np.zeros(motion[4].shape[0], np.int64)
    rows[:, :, nodes % ring, :points] = terminal
    rows[:, :, nodes % ring, 0] = stalled
    slopes[:], bends[:] = 0.0, 0.0
    for n in range(nodes - 1, -1, -1):
        scale = 1.0 / noise[n]
        for r in range(of_node.shape[0]):
            of_node[r] = min(n + r, nodes) % ring
        for m in range(modes):
            first, last = band[n, m]
            for q in range(levels if n + 1 < nodes else 0):
                clear(values[m, q], band[n + 1, m, 0], band[n + 1, m, 1])
            if first >= last:
                continue
            chances(lines[0, n, m], lines[1, n, m], reading, scale, periods[m], first, last, chance)
            down_end = first_above(reading, lines[0, n, m], scale, CERTAIN, True) if periods[m, DOWN] >= 0 else 0
            up_begin = first_above(reading, lines[1, n, m], scale, -CERTAIN, False) if periods[m, UP] >= 0 else last
            begins, ends = (first, first, max(first, up_begin)), (min(last, down_end), last, last)
            for q in range(levels):
                for command in range(3):
                    d = periods[m, command]
                    if d >= 0:
                        pull_period(
                            n, kpa[d], factor[q], extra, motion, path, of_node, rows[way[d], q],
                            begins[command], ends[command], commanded[command], scratch,
                        )  # fmt: skip
                for j in range(first, last):
                    values[m, q, j] = commanded[HOLD, j]
                for command in (DOWN, UP):
                    side = command // 2
                    for j in range(begins[command], ends[command]):
                        saved = commanded[command, j] + change_cost - commanded[HOLD, j]
                        values[m, q, j] += chance[command, j] * saved
                        add_slopes(
                            density[n, m, q, j] * saved, (lines[side, n, m] - reading[j]) * scale, scale,
                            side, n, m, slopes, bends,
                        )  # fmt: skip
            change_levels_back(values[m], first, last, mixing, scratch)
        at_ways(n % ring, way_band[n], values, target, share, stalled, rows)
    cost = 0.0
    for r in range(entry.shape[0]):
        for q in range(levels):
            shift = ahead_m2_s2(0, r, entry_kpa, factor[q], extra, motion, path) / motion[3]
            pull_row(rows[entry_way, q, r], shift, points, 1, points, scratch)
            for j in range(1, points):
                cost += entry[r, j] * stationary[q] * scratch[j]
    return cost


@borrowing
def add_slopes(weight, z, scale, side, n, m, slopes, bends):
    """Of a line `z` standard deviations above what is read; `weight`: density times what the command costs more."""
    slope = normal_density(z) * scale * (1.0 if side == 0 else -1.0)
    slopes[side, n, m] += weight * slope
    bends[side, n, m] -= weight * slope * z * scale


@borrowing
def change_levels_back(values, first, last, mixing, scratch):
    """Values (L, E') before the level's change at the end of a period, of those after it, in place."""
    levels = values.shape[0]
    for j in range(first, last):
        for q in range(levels):
            scratch[q] = 0.0
            for k in range(levels):
                scratch[q] += mixing[j, q, k] * values[k, j]
        for q in range(levels):
            values[q, j] = scratch[q]


@borrowing
def at_ways(slot, way_band, values, target, share, stalled, rows):
    """Values of modes as values of the ways that lead to them, where mass arrives."""
    for w in range(target.shape[0]):
        begin, end = way_band[w]
        if begin >= end:
            continue
        for q in range(values.shape[1]):
            row = rows[w, q, slot]
            clear(row, begin, end + EIGHT)
            for b in range(4):
                if share[w, b] != 0.0:
                    add_row(values[target[w, b], q], share[w, b], begin, end, row, 0)
            row[0] = stalled
