"""Where a change of stage lands, for neighbouring energies at once: places and weights instead of values.

The landing point of a transient lies between two path nodes; the value there is interpolated along the path on which
the cut would roll on at the stage reached, so that interpolation shifts the phase of the sampling a little but never
the speed. The same landings serve values backward (`transient_sweep` for many targets, `transient` for one) and masses
forward (`transient`). So a landing is worked out as a *plan*: two groups of four neighbouring places and their weights.
Group a lies at the node before the landing, among values at a sample; group b at the node after it, among values
before the noise level changes.

Arguments shared by all: `ends` (N, C, F, 2, E') path and energy at the end of a transient over the equally spaced
`factors` (F,), see `landing.land`; noise tables `probability`, `mean`, `std` (C, R, L, L); `drive` (N,) acceleration
without brakes, `brake` (N,) = β; `factor` ξ_cut, `extra` acceleration of the scenario (its w).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.borrowing import borrowing
from synth.kernels.flow import LINEAR_CELLS
from synth.kernels.packs import (
    EIGHT,
    choose,
    fraction,
    gather,
    greatest,
    holds_anywhere,
    least,
    load8,
    store,
    transposed_store,
    whole,
)

STALLED = -1
"""Stands for the place of a landing that is none: the cut stops in the transient. Its share is its first weight."""


@borrowing
def factor_weights(f, factors):
    """Quadratic interpolation in the friction factor: (nearest node, centre node, three weights)."""
    width = factors[1] - factors[0]
    centre = min(max(int((f - factors[0]) / width + 0.5), 1), factors.shape[0] - 2)
    x = min(max((f - factors[centre]) / width, -1.5), 1.5)
    nearest = centre - 1 if x < -0.5 else (centre + 1 if x > 0.5 else centre)
    return nearest, centre, 0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)


@borrowing
def end_of_transient(ends, at, width, j, weights):
    """(path, energy, path of the nearest node) of a pack of energies; `at`: flat index of this node and transient.

    Quadratic in the friction factor through three nodes; if one of them stalls, the nearest node decides.
    """
    nearest, centre, low, middle, high = weights
    at = at + j
    before, here, after = at + 2 * (centre - 1) * width, at + 2 * centre * width, at + 2 * (centre + 1) * width
    t0, t1, t2 = load8(ends, before), load8(ends, here), load8(ends, after)
    path = t0 * low + t1 * middle + t2 * high
    energy = load8(ends, before + width) * low + load8(ends, here + width) * middle
    energy = energy + load8(ends, after + width) * high
    stalls = least(least(t0, t1), t2) < 0.0
    if holds_anywhere(stalls):
        alone = at + 2 * nearest * width
        path = choose(stalls, load8(ends, alone), path)
        energy = choose(stalls, load8(ends, alone + width), energy)
    return path, energy


@njit(cache=True, nogil=True, error_model="numpy")
def landing_scratch(points):
    """`crossed`, `place`, `weight` for `points` E' energies."""
    return np.empty(points, np.int64), np.empty((2, points), np.int64), np.empty((2, points, 4))


@borrowing
def quanta_crossed(n, c, begin, end, factor, ends, factors, path_step, longest, crossed):
    """`crossed`[begin:end]: path quanta crossed in transient `c` from node `n` at ξ_cut itself, −1 for a stall."""
    points = ends.shape[4]
    at = (n * ends.shape[1] + c) * ends.shape[2] * 2 * points
    weights = factor_weights(factor, factors)
    quanta = 1.0 / path_step
    for j in range(begin, end, EIGHT):
        path, _ = end_of_transient(ends, at, points, j, weights)
        store(crossed, j, choose(path < 0.0, -1, least(whole(path * quanta + 1e-9), longest)))


@borrowing
def plan_landings(
    n, last, c, q, m, side, begin, end, crossed, held, factor, ends, factors, probability, mean, std,
    drive, brake, extra, path_step, energy_step, points, ring, stride, offset, place, weight,
):  # fmt: skip
    """Plan the landings begin ≤ j < end of transient `c` from node `n` and level `q`, reaching level `m`.

    `side` 0 or 1 of the two-point law of the friction met; `held` = ξ·(1 + η)·over-pressure after it; `last` = N.
    Places count grid points of rows of `points` energies: node, then `stride` points a node, `offset` of mode and
    level; nodes live in a ring, node n at n mod `ring`. Outputs: `place` (2, E') first of the four places of the groups
    a and b, `weight` (2, E', 4).
    """
    width = ends.shape[4]
    at = (n * ends.shape[1] + c) * ends.shape[2] * 2 * width
    arrays = ends, drive, brake, place, weight
    run = begin
    while run < end:
        over = crossed[run]
        stop = run + 1
        while stop < end and crossed[stop] == over:
            stop += 1
        r = max(over, 0)
        f = factor * (1.0 + mean[c, r, q, m] + (2 * side - 1) * std[c, r, q, m])
        plan_run(
            n, last, 0.5 * probability[c, r, q, m], over < 0, factor_weights(f, factors), at, width, run, stop, held,
            extra, path_step, energy_step, points, ring, stride, offset, arrays,
        )  # fmt: skip
        run = stop


@borrowing
def plan_run(
    n, last, share, stalls, weights, at, width, begin, end, held,
    extra, path_step, energy_step, points, ring, stride, offset, arrays,
):  # fmt: skip
    """`plan_landings` for energies that meet the same friction, `weights` of its factor; `stalls`: whatever it is.

    `at`: flat index of node and transient in `ends`, `width` = E'; `arrays`: ends, drive, brake, place and weight.
    """
    ends, drive, brake, place, weight = arrays
    quanta, cells, start = 1.0 / path_step, 1.0 / energy_step, n % ring
    no_stall_from = np.inf if stalls else 0.0
    for j in range(begin, end, EIGHT):
        path, e = end_of_transient(ends, at, width, j, weights)
        stopped = path < no_stall_from
        e = e + path * extra
        ahead = path * quanta
        crossed = greatest(whole(ahead + 1e-9), 0)
        crossed = least(crossed, last - n)
        x = greatest(ahead - fraction(crossed), 0.0)
        node = least(crossed + n, last - 1)
        slope = (gather(drive, node) + extra - gather(brake, node) * held) * path_step
        leaves = crossed >= last - n
        own = crossed < 1  # a landing in its own quantum is decided on at the quantum's end
        back = choose(leaves, e, e - slope * x) * cells
        forth = (e + slope * (1.0 - x)) * cells
        share_b = choose(leaves | stopped, 0.0, choose(own, 1.0, x) * share)
        share_a = choose(leaves | stopped, share, choose(own, 0.0, 1.0 - x) * share)
        row_a = crossed + start
        row_b = row_a + 1
        row_a = choose(row_a >= ring, row_a - ring, row_a) * stride + offset
        row_b = choose(row_b >= ring, row_b - ring, row_b) * stride + offset
        put_group(back, share_a, stopped, row_a, points, 0, width, j, place, weight)
        put_group(forth, share_b, stopped, row_b, points, width, width, j, place, weight)


@borrowing
def put_group(position, share, stopped, row, points, group, width, j, place, weight):
    """Store places and weights of cubic interpolation at `position` in cells (`flow.interpolation`, eight at once)."""
    inside = least(greatest(position, 0.0), points - 1.0)
    i = least(greatest(whole(inside), 1), points - 3)
    x = inside - fraction(i)
    up, down, two = x + 1.0, x - 1.0, x - 2.0
    c0, c1 = x * down * two * (-1.0 / 6.0), up * down * two * 0.5
    c2, c3 = up * x * two * -0.5, up * x * down * (1.0 / 6.0)
    edge = (position < LINEAR_CELLS) | (position >= points - 3.0)
    if holds_anywhere(edge | stopped):
        before, after, low = x < 0.0, x > 1.0, inside < LINEAR_CELLS
        c0 = choose(before, x * -1.0, choose(after | low, 0.0, c0))
        c1 = choose(before, x + 1.0, choose(after, 0.0, choose(low, 1.0 - x, c1)))
        c2 = choose(before, 0.0, choose(after, 2.0 - x, choose(low, x, c2)))
        c3 = choose(after, x - 1.0, choose(before | low, 0.0, c3))
        c0 = choose(stopped, 1.0, c0)
        row = choose(stopped, STALLED - (i - 1), row)
    store(place, group + j, row + (i - 1))
    transposed_store(weight, 4 * (group + j), c0 * share, c1 * share, c2 * share, c3 * share)
