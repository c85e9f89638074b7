"""One sampling period of motion on the grid of path and energy, as a linear map and its transpose.

From a node, a period ends between nodes. What it is worth there is interpolated by a parabola through three nodes along
the way that the cut would roll on: path and energy stay together, and neither is smeared. The energy that a node is
reached with differs from the first one by the same amount for all speeds, as the mean pressure of the period does not
depend on them. So all speeds whose periods end near the same node are one contiguous stencil (`kernels.sweep.flow`).
"""

from __future__ import annotations

import numpy as np

from synth.kernels.sweep.flow import LINEAR_CELLS, put_at, spread_by_stencil, stencil, stencil_row, take
from synth.kernels.vector.borrowing import borrowing, borrowing_inline
from synth.kernels.vector.packs import EIGHT, greatest, load8, store

ROOM = 16
"""Zeros behind the energies of a row (E',), as whole packs are read."""

NEAREST = 2
"""Middle node of the nearest parabola. A period that ends in its own quantum is put on the next node: there samples
are a little slower than they are, at speeds below ΔS/T_c."""


@borrowing
def pull_period(n, kpa, factor, extra, motion, path, of_node, rows, begin, end, out, scratch):
    """`out`[j] = value at the end of a period that begins at node `n` with energy j, begin ≤ j < end.

    `kpa` mean overpressure over the period, `factor` of the friction, `extra` acceleration inside the position.
    `motion` = (speed (E',) in quanta a period, period² / 2ΔS, ΔS, Δe, `bands` (R + 2,): the first energy of each middle
    node). `path` = (drive, brake), integrals over the path up to each node (N + 1,). `rows` (ring, E') values at nodes,
    of which `of_node` (R + 2,) are those ahead; row 0 of energies is a stall.
    """
    bands, points = motion[4], motion[0].shape[0] - ROOM
    for middle in range(NEAREST, bands.shape[0] - 1):
        first, last = max(begin, bands[middle]), min(end, bands[middle + 1])
        if first >= last:
            continue
        mean = ahead_m2_s2(n, middle, kpa, factor, extra, motion, path) / (middle * motion[2])
        for side in range(3):
            to = middle + side - 1
            shift = ahead_m2_s2(n, to, kpa, factor, extra, motion, path) / motion[3]
            pull_row(rows[of_node[to]], shift, points, first, last, scratch)
            for j in range(first, last, EIGHT):  # what is written behind `last` is overwritten by the next stencil
                share = parabola(load8(motion[0], j) + mean * motion[1], middle, side) * load8(scratch, j)
                store(out, j, share if side == 0 else load8(out, j) + share)


@borrowing
def push_period(n, kpa, factor, extra, motion, path, of_node, mass, begin, end, rows, spans, scratch):
    """Transpose of `pull_period`: `mass`[j] is added to `rows`; `spans` (ring, 2) are widened to what it reaches."""
    bands, points = motion[4], motion[0].shape[0] - ROOM
    for middle in range(NEAREST, bands.shape[0] - 1):
        first, last = max(begin, bands[middle]), min(end, bands[middle + 1])
        if first >= last:
            continue
        mean = ahead_m2_s2(n, middle, kpa, factor, extra, motion, path) / (middle * motion[2])
        for side in range(3):
            to = middle + side - 1
            shift = ahead_m2_s2(n, to, kpa, factor, extra, motion, path) / motion[3]
            for j in range(first, last, EIGHT):
                share = parabola(load8(motion[0], j) + mean * motion[1], middle, side)
                store(scratch, j, share * load8(mass, j))
            push_row(scratch, shift, points, first, last, rows[of_node[to]], spans[of_node[to]])


@borrowing_inline
def ahead_m2_s2(n, quanta, kpa, factor, extra, motion, path):
    """Energy gained from node `n` until `quanta` nodes on; behind the exit nothing changes it."""
    last = path[0].shape[0] - 1
    to = min(n + quanta, last)
    return path[0][to] - path[0][n] + extra * (to - n) * motion[2] - factor * kpa * (path[1][to] - path[1][n])


@borrowing_inline
def parabola(quanta, middle, side):
    """Weight of node `middle` + `side` − 1 at the end of periods that are so many quanta long, a pack."""
    x = greatest(quanta, 1.0) - middle
    if side == 1:
        return x * x * -1.0 + 1.0
    return x * (x + (side - 1.0)) * 0.5


@borrowing_inline
def parabola_at(quanta, middle, side):
    """The same for one number."""
    x = max(quanta, 1.0) - middle
    return 1.0 - x * x if side == 1 else 0.5 * x * (x + (side - 1.0))


@borrowing
def pull_row(row, shift, points, first, last, out):
    """`out`[j] = `row` at j + `shift` cells, first ≤ j < last."""
    base = int(np.floor(shift))
    x = shift - base
    c0, c1, c2, c3 = stencil(x)
    low = min(max(LINEAR_CELLS - base, first), last)
    high = max(min(points - 2 - base, last), low)
    stencil_row(row, base, 1, c0, c1, c2, c3, low, high, out)
    for j in range(first, low):
        take(row, j + shift, points, 1, out, j)
    for j in range(high, last):
        take(row, j + shift, points, 1, out, j)


@borrowing
def push_row(mass, shift, points, first, last, row, span):
    """Transpose of `pull_row`, added to `row`; `span` (2,) is widened."""
    base = int(np.floor(shift))
    low = min(max(LINEAR_CELLS - base, first), last)
    high = max(min(points - 2 - base, last), low)
    for j in range(first, low):
        put_at(row, points, j + shift, mass[j])
    spread_by_stencil(mass, low, high, base, stencil(shift - base), row)
    for j in range(high, last):
        put_at(row, points, j + shift, mass[j])
    span[0] = min(span[0], max(min(first + base - 1, points - 4), 0))
    span[1] = max(span[1], min(max(last + base + 3, 4), points))
