"""Where a change of stage lands, for neighbouring energies at once: places and weights instead of values.

The landing point of a transient lies between two path nodes; the value there is interpolated along the path on which
the cut would roll on at the stage reached, so that interpolation shifts the phase of the sampling a little but never
the speed. Where the next decision is a place and not a time away, the cut rolls on to the node ahead: `least_ahead` 1.
The same landings serve values backward (`transient_sweep` for many targets, `transient` for one) and masses forward
(`transient`). So a landing is worked out as a *plan*: two groups of four neighbouring places and their weights. Group a
lies at the node before the landing, among values at a sample; group b at the node after it, among values before the
noise level changes.

Arguments as in `chain_arrays`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Ints
from synth.kernels.compiling import kernel, part, part_inline
from synth.kernels.sweep.flow import LINEAR_CELLS
from synth.kernels.vector.packs import (
    EIGHT,
    choose,
    fraction,
    gather,
    greatest,
    holds_anywhere,
    item,
    least,
    load8,
    store,
    whole,
)

STALLED = -1
"""Stands for the place of a landing that is none: the cut stops in the transient. Its share is its first weight."""


class Scratch(NamedTuple):
    """Memory for one change of stage: `crossed`, `runs` of `find_runs`; `place`, `weight` of `store_plan`.

    `runs` (E' + 1, 2): k-th run of energies, (first energy, quanta crossed or −1 for a stall), and one more that holds
    the end of the last.
    """

    crossed: Ints
    runs: Ints
    place: Ints
    weight: NDArray[Any]


class Ahead(NamedTuple):
    """The path from a node on: `left` quanta until S_exit, `extra` acceleration, `quanta`, `cells` of a unit of path
    and of energy. `least_ahead` as of a change of stage."""

    left: int
    extra: float
    quanta: float
    cells: float
    least_ahead: float


class Ring(NamedTuple):
    """Where rows of values or masses stand at the nodes ahead, `points` energies each and `row` places apart: those of
    this node, and of the mode reached, from place `first` on, `stride` between nodes; from `wrap` nodes on it is
    `wrapped` less."""

    points: int
    row: int
    stride: int
    first: int
    wrap: int
    wrapped: int


@part
def factor_weights(f, factors):
    """Quadratic interpolation in the friction factor: (nearest node, centre node, three weights)."""
    width = factors[1] - factors[0]
    centre = min(max(int((f - factors[0]) / width + 0.5), 1), factors.shape[0] - 2)
    x = min(max((f - factors[centre]) / width, -1.5), 1.5)
    nearest = centre - 1 if x < -0.5 else (centre + 1 if x > 0.5 else centre)
    return nearest, centre, 0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)


@kernel
def landing_tables(chain, factor, extra):
    """What every plan of the scenarios `factor`, `extra` (I,) needs, worked out once: (met, slope).

    `met` (I, ·, r, L, L, 2, 6): share of each side of the two-point law of the friction met, and where its factor lies
    among those of the landings (`factor_weights`); `slope` (I, H, L, N) energy gained in a path quantum at a mode and
    level.
    """
    factors, (drive, brake) = chain.landings.factors, chain.track
    probability, mean, std = chain.transient_noise
    levels, pressure, path_step = chain.noise.levels, chain.modes.pressure, chain.grid.path_step
    met = np.empty((factor.shape[0], *mean.shape, 2, 6))
    slope = np.empty((factor.shape[0], pressure.shape[0], levels.shape[0], drive.shape[0]))
    for i in range(factor.shape[0]):
        for c, r, q, m in np.ndindex(mean.shape):
            for side in range(2):
                f = factor[i] * (1.0 + mean[c, r, q, m] + (2 * side - 1) * std[c, r, q, m])
                nearest, centre, low, middle, high = factor_weights(f, factors)
                out = met[i, c, r, q, m, side]
                out[0], out[1], out[2] = 0.5 * probability[c, r, q, m], nearest, centre
                out[3], out[4], out[5] = low, middle, high
        for h, m in np.ndindex(slope.shape[1:3]):
            held = factor[i] * (1.0 + levels[m]) * pressure[h]
            for n in range(drive.shape[0]):
                slope[i, h, m, n] = (drive[n] + extra[i] - brake[n] * held) * path_step
    return met, slope


@kernel
def landing_scratch(points, levels, kind):
    """Scratch for `points` E' energies and 2·L plans; `kind` of the weights is that of the numbers to be weighted."""
    return Scratch(
        np.empty(points, np.int64), np.empty((points + 1, 2), np.int64),
        np.empty((2 * levels, 2, EIGHT), np.int64), np.empty((2 * levels, 2, 4, EIGHT), kind),
    )  # fmt: skip


@part_inline
def law_met(met, change, r, m, side):
    """The numbers of `landing_tables` for one side of the law of the friction met over `r` quanta to level `m`."""
    c, q = change.transient, change.level
    at = ((((c * met.shape[1] + r) * met.shape[2] + q) * met.shape[3] + m) * 2 + side) * 6
    nearest, centre = int(item(met, at + 1)), int(item(met, at + 2))
    return item(met, at), nearest, centre, item(met, at + 3), item(met, at + 4), item(met, at + 5)


@part_inline
def first_end(ends, change):
    """Flat index in `ends` of the first energy of a change of stage, at the first friction factor."""
    return (change.decision * ends.shape[1] + change.transient) * ends.shape[2] * 2 * ends.shape[4]


@part_inline
def ahead_of(change, grid, scenario):
    """The path that lies ahead of a change of stage."""
    return Ahead(change.left, scenario.extra, 1.0 / grid.path_step, 1.0 / grid.energy_step, change.least_ahead)


@part_inline
def ring_from(change, rows, row, points):
    """Where `rows` (ring, H, L, ·) stand for a change of stage; node n is at index n mod ring length."""
    ring, modes, levels = rows.shape[0], rows.shape[1], rows.shape[2]
    start, stride = change.node % ring, modes * levels * row
    return Ring(points, row, stride, start * stride + change.mode * levels * row, ring - start, ring * stride)


@part_inline
def end_of_transient(ends, at, nearest, centre, low, middle, high):
    """(path, energy) of a pack of energies; `at`: flat index of its decision, transient and first energy in `ends`.

    Quadratic in the friction factor through three nodes; if one of them stalls, the nearest node decides.
    """
    width = ends.shape[4]
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


@part
def find_runs(change, begin, end, landings, grid, scenario, scratch):
    """Runs of energies begin ≤ j < `end` that cross equally many path quanta at ξ_cut, in `scratch`; returns how many.

    The level that the change is at plays no part.
    """
    crossed, runs, longest = scratch.crossed, scratch.runs, scenario.met.shape[1] - 1
    at, quanta = first_end(landings.ends, change), 1.0 / grid.path_step
    nearest, centre, low, middle, high = factor_weights(scenario.factor, landings.factors)
    for j in range(begin, end, EIGHT):
        path, _ = end_of_transient(landings.ends, at + j, nearest, centre, low, middle, high)
        store(crossed, j, choose(path < 0.0, -1, least(whole(path * quanta + 1e-9), longest)))
    count = 0
    for j in range(begin, end):
        if j == begin or crossed[j] != crossed[j - 1]:
            runs[count, 0], runs[count, 1] = j, crossed[j]
            count += 1
    runs[count, 0] = end
    return count


@part_inline
def landing_of_pack(ends, at, law, stalls, level, slope, on_path, ring):
    """Plan the landings of a pack of energies: (place a, place b, weights a, weights b, quanta, lowest, highest).

    `at`: flat index of decision, transient and energy in `ends`; `law` from `law_met`; `stalls`: whatever it says;
    `level` reached; `slope` (·,) from this node on at the mode and level reached; `on_path` from `ahead_of`.
    The landings lie between `lowest` and `highest` in cells, at the node after so many `quanta` and at the next one.
    """
    left, extra, quanta, cells, least_ahead = on_path
    points, row, stride, first, wrap, wrapped = ring
    share, nearest, centre, low, middle, high = law
    path, e = end_of_transient(ends, at, nearest, centre, low, middle, high)
    e = e + path * extra
    ahead = path * quanta
    crossed = whole(ahead + 1e-9)
    stopped = (crossed < 1) | (crossed >= left)
    if stalls or holds_anywhere(stopped):
        stopped = path < (np.inf if stalls else 0.0)
        crossed = least(greatest(crossed, 0), left)
        x = greatest(ahead - fraction(crossed), 0.0)
        gained = gather(slope, least(crossed, left - 1))
        leaves = crossed >= left
        own = crossed < 1  # a landing in its own quantum is decided on at the quantum's end
        back = choose(leaves, e, e - gained * x) * cells
        forth = (e + gained * (1.0 - x)) * cells
        part = greatest(x, least_ahead)
        share_b = choose(leaves | stopped, 0.0, choose(own, 1.0, part) * share)
        share_a = choose(leaves | stopped, share, choose(own, 0.0, 1.0 - part) * share)
    else:
        x = greatest(ahead - fraction(crossed), 0.0)
        gained = gather(slope, crossed)
        back = (e - gained * x) * cells
        forth = (e + gained * (1.0 - x)) * cells
        part = greatest(x, least_ahead)
        share_b = part * share
        share_a = (1.0 - part) * share
    row_a = crossed * stride + (first + level * row)
    row_b = choose(crossed >= wrap - 1, row_a - (wrapped - stride), row_a + stride)
    row_a = choose(crossed >= wrap, row_a - wrapped, row_a)
    lowest, highest = least(back, forth), greatest(back, forth)
    if holds_anywhere((lowest < LINEAR_CELLS) | (highest >= points - 3.0) | stopped):
        i, a0, a1, a2, a3 = interpolation_of_pack(back, stopped, points)
        k, b0, b1, b2, b3 = interpolation_of_pack(forth, stopped, points)
        row_a = choose(stopped, STALLED - (i - 1), row_a)
    else:
        i, k = whole(back), whole(forth)
        a0, a1, a2, a3 = stencil_of_pack(back - fraction(i))
        b0, b1, b2, b3 = stencil_of_pack(forth - fraction(k))
    a = a0 * share_a, a1 * share_a, a2 * share_a, a3 * share_a
    b = b0 * share_b, b1 * share_b, b2 * share_b, b3 * share_b
    return row_a + (i - 1), row_b + (k - 1), a, b, crossed, lowest, highest


@part_inline
def store_plan(at_a, at_b, a, b, plan, place, weight):
    """Write the places and weights of a pack as number `plan` of `place` (·, 2, 8) and `weight` (·, 2, 4, 8)."""
    store(place, 2 * plan * EIGHT, at_a)
    store(place, (2 * plan + 1) * EIGHT, at_b)
    for i in range(4):
        store(weight, (8 * plan + i) * EIGHT, a[i])
        store(weight, (8 * plan + 4 + i) * EIGHT, b[i])


@part_inline
def planned(plan, lane, place, weight):
    """What `store_plan` wrote for one energy: (place a, place b, flat index of the first weight a, and of b).

    The four weights of a group are `EIGHT` apart.
    """
    at = 2 * plan * EIGHT + lane
    first = 8 * plan * EIGHT + lane
    return item(place, at), item(place, at + EIGHT), first, first + 4 * EIGHT


@part_inline
def stencil_of_pack(x):
    """`flow.stencil` for a pack."""
    up, down, two = x + 1.0, x - 1.0, x - 2.0
    c0, c1 = x * down * two * (-1.0 / 6.0), up * down * two * 0.5
    c2, c3 = up * x * two * -0.5, up * x * down * (1.0 / 6.0)
    return c0, c1, c2, c3


@part_inline
def interpolation_of_pack(position, stopped, points):
    """`flow.interpolation` for a pack; what `stopped` has its first weight alone."""
    inside = least(greatest(position, 0.0), points - 1.0)
    i = least(greatest(whole(inside), 1), points - 3)
    x = inside - fraction(i)
    c0, c1, c2, c3 = stencil_of_pack(x)
    before, after, low = x < 0.0, x > 1.0, inside < LINEAR_CELLS
    c0 = choose(before, x * -1.0, choose(after | low, 0.0, c0))
    c1 = choose(before, x + 1.0, choose(after, 0.0, choose(low, 1.0 - x, c1)))
    c2 = choose(before, 0.0, choose(after, 2.0 - x, choose(low, x, c2)))
    c3 = choose(after, x - 1.0, choose(before | low, 0.0, c3))
    return i, choose(stopped, 1.0, c0), c1, c2, c3
