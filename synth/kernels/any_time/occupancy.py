"""Forward density of a fixed policy that decides at every sample, in one scenario (Chapman–Kolmogorov equation).

At a sample the drive is in a mode, the cut at a path node with a level of the path noise. A command leads through a
period of known pressure to a *way*: the few modes that stand for the drive at its end.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.any_time.period import ROOM, ahead_m2_s2, push_period, push_row
from synth.kernels.sweep.commands import CERTAIN, first_above, normal_cdf
from synth.kernels.sweep.flow import add_row, clear, extent, widen
from synth.kernels.vector.borrowing import borrowing
from synth.kernels.vector.packs import EIGHT

DOWN, HOLD, UP = 0, 1, 2
"""Commands at a sample, by their place among the periods of a mode."""

NEGLIGIBLE_MASS = 1e-12
"""Energies of a state beyond which no mass is larger are left out."""


@njit(cache=True, nogil=True, error_model="numpy")
def occupy(
    lines, reading, noise, periods, kpa, way, target, share, entry, entry_way, entry_kpa, stationary,
    mixing, factor, extra, motion, path, density, band, way_band, exits, totals,
):  # fmt: skip
    """One forward pass.

    `lines` (2, N, M): below and above them the command is down and up, in readings; `reading` (E,) of the true speeds,
    with errors of std `noise` (N,). `periods` (M, 3): period that follows a command in a mode, −1 where it is none; of
    each period `kpa` (D,) mean overpressure and `way` (D,); of each way `target`, `share` (W, 4) modes and shares.
    `entry` (A, E): probability of entering with energy j and having the first sample at node r, `entry_way` and the
    pressure `entry_kpa` until then. `stationary` (L,), `mixing` (E, L, L) of the path noise after a period; `factor`
    (L,) of the friction by level; `extra` acceleration; `motion`, `path` as in `pull_period`.
    Outputs: `density` (N, M, L, E), or of length 0; `band` (N, M, 2), `way_band` (N, W, 2): ranges of energies met;
    `exits` (E,) by energy; `totals` (4,): stalled, escaped, changes down, changes up.
    """
    nodes, modes, levels = lines.shape[1], lines.shape[2], factor.shape[0]
    points, ways, ring = reading.shape[0], target.shape[0], max(motion[4].shape[0] + 1, entry.shape[0] + 1)
    row = points + ROOM
    heading, spans = np.zeros((ways, levels, ring, row)), np.zeros((ways, levels, ring, 2), np.int64)
    spans[:, :, :, 0] = points
    here, moved, scratch = np.zeros((modes, levels, row)), np.zeros((levels, row)), np.zeros(row)
    span, chance = np.zeros((modes, 2), np.int64), np.zeros((3, row))
    of_node = np.zeros(motion[4].shape[0], np.int64)
    totals[:], exits[:] = 0.0, 0.0
    for r in range(entry.shape[0]):
        for q in range(levels):
            for j in range(points):
                scratch[j] = entry[r, j] * stationary[q]
            shift = ahead_m2_s2(0, r, entry_kpa, factor[q], extra, motion, path) / motion[3]
            push_row(scratch, shift, points, 1, points, heading[entry_way, q, r], spans[entry_way, q, r])
    for n in range(nodes):
        for r in range(of_node.shape[0]):
            of_node[r] = min(n + r, nodes) % ring
        gather_arrivals(n % ring, points, heading, spans, target, share, here, span, way_band[n], totals)
        for m in range(modes):
            band[n, m] = 0
            if span[m, 0] >= span[m, 1]:
                continue
            first, last = change_levels(here[m], span[m, 0], span[m, 1], points, mixing, moved)
            span[m] = 0
            band[n, m, 0], band[n, m, 1] = first, last
            if density.shape[0] > 0:
                density[n, m, :, first:last] = moved[:, first:last]
            scale = 1.0 / noise[n]
            chances(lines[0, n, m], lines[1, n, m], reading, scale, periods[m], first, last, chance)
            for command in range(3):
                d = periods[m, command]
                begin, end = extent(chance[command], first, last, 1e-300)
                if d < 0 or begin >= end:
                    continue
                for q in range(levels):
                    for j in range(begin, end):
                        here[m, q, j] = moved[q, j] * chance[command, j]
                        if command != HOLD:
                            totals[2 + command // 2] += here[m, q, j]
                    push_period(
                        n, kpa[d], factor[q], extra, motion, path, of_node, here[m, q], begin, end,
                        heading[way[d], q], spans[way[d], q], scratch,
                    )  # fmt: skip
            for q in range(levels):
                clear(here[m, q], first, last)
                totals[1] += abs(moved[q, points - 1]) if last == points else 0.0
    for w in range(ways):
        for q in range(levels):
            last_row = heading[w, q, nodes % ring]
            totals[0] += last_row[0]
            for j in range(1, points):
                exits[j] += last_row[j]


@borrowing
def gather_arrivals(slot, points, heading, spans, target, share, here, span, way_band, totals):
    """Bring what heads for this node from ways to modes, `here` (M, L, E'), and leave their rows empty."""
    for w in range(target.shape[0]):
        way_band[w, 0], way_band[w, 1] = points, 0
        for q in range(heading.shape[1]):
            begin, end = spans[w, q, slot]
            if begin >= end:
                continue
            row = heading[w, q, slot]
            totals[0] += row[0]
            row[0] = 0.0
            way_band[w, 0], way_band[w, 1] = min(way_band[w, 0], begin), max(way_band[w, 1], end)
            for b in range(4):
                if share[w, b] != 0.0:
                    m = target[w, b]
                    add_row(row, share[w, b], begin, end, here, (m * heading.shape[1] + q) * here.shape[2])
                    widen(span[m], begin, end)
            clear(row, begin, end + EIGHT)
            spans[w, q, slot, 0], spans[w, q, slot, 1] = points, 0


@borrowing
def change_levels(arrived, begin, end, points, mixing, out):
    """`out` (L, E'): the mass `arrived` after the level's change at the end of a period, which is emptied.

    Returns the range of energies that matter.
    """
    levels = arrived.shape[0]
    first, last = points, 0
    for q in range(levels):
        clear(out[q], begin, end + EIGHT)
        for j in range(max(begin, 1), end):
            for k in range(levels):
                out[q, j] += arrived[k, j] * mixing[j, k, q]
        a, b = extent(out[q], max(begin, 1), end, NEGLIGIBLE_MASS)
        if a < b:
            first, last = min(first, a), max(last, b)
    for q in range(levels):
        clear(arrived[q], begin, end + EIGHT)
    return first, max(first, last)


@borrowing
def chances(lower, upper, reading, scale, periods, first, last, out):
    """`out` (3, E'): probability of every command for first ≤ j < last; of a command that there is not, 0."""
    down_end = first_above(reading, lower, scale, CERTAIN, True) if periods[DOWN] >= 0 else 0
    up_begin = first_above(reading, upper, scale, -CERTAIN, False) if periods[UP] >= 0 else reading.shape[0]
    for j in range(first, last):
        down = normal_cdf((lower - reading[j]) * scale) if j < down_end else 0.0
        up = normal_cdf((reading[j] - upper) * scale) if j >= up_begin else 0.0
        out[DOWN, j], out[HOLD, j], out[UP, j] = down, 1.0 - down - up, up
