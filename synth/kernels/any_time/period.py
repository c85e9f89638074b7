"""One sampling period of motion on the grid of path and energy, as a linear map and its transpose.

From a node, a period ends between nodes. What it is worth there is interpolated by a parabola through three nodes along
the way that the cut would roll on: path and energy stay together, and neither is smeared. The energy that a node is
reached with differs from the first one by the same amount for all speeds, as the mean pressure of the period does not
depend on them. So all speeds whose periods end near the same node are three contiguous stencils of four points
(`kernels.sweep.flow`), worked out in one loop; beside a stall and at the top of the grid one after the other.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import part, part_inline
from synth.kernels.sweep.flow import LINEAR_CELLS, put_at, stencil, stencil_row, take
from synth.kernels.vector.packs import EIGHT, eight, greatest, load8, store

ROOM = 16
"""Zeros behind the energies of a row (E'), as whole packs are read."""

NEAREST = 2
"""Middle node of the nearest parabola. A period that ends in its own quantum is put on the next node: there samples
are a little slower than they are, at speeds below ΔS/T_c."""


class NodesAhead(NamedTuple):
    """What lies within a period of a node, for each node ahead (R + 2,).

    `of_node` rows of a ring that stand for the nodes, `free` cells of energy gained until there without brakes,
    `braking` cells that each kPa takes away at the mean friction.
    """

    of_node: Ints
    free: Floats
    braking: Floats


@part_inline
def look_ahead(n, extra, motion, ring, ahead):
    """Fill `ahead` for node `n`; `extra` acceleration inside the position."""
    (of_node, free, braking), drive, brake = ahead, motion.drive, motion.brake
    last = drive.shape[0] - 1
    for r in range(of_node.shape[0]):
        to = min(n + r, last)
        of_node[r] = to % ring
        free[r] = (drive[to] - drive[n] + extra * (to - n) * motion.path_step) / motion.energy_step
        braking[r] = (brake[to] - brake[n]) / motion.energy_step


@part_inline
def pull_period(ahead, kpa, motion, rows, begin, end, out, scratch):
    """`out`[j] = value at the end of a period that begins with energy j, begin ≤ j < end.

    `ahead` as of `look_ahead`; `kpa` mean overpressure over the period times the
    factor of the friction. `rows` (ring, E') values at nodes; energy 0 is a stall. `scratch` (3, E').
    """
    of_node, free, braking = ahead
    quanta, bands = motion.quanta, motion.bands
    points, width = quanta.shape[0] - ROOM, rows.shape[1]
    for middle in range(NEAREST, bands.shape[0] - 1):
        if bands[middle] >= end:
            break
        first, last = max(begin, bands[middle]), min(end, bands[middle + 1])
        if first >= last:
            continue
        cells0, cells1 = free[middle - 1] - kpa * braking[middle - 1], free[middle] - kpa * braking[middle]
        cells2, bend = free[middle + 1] - kpa * braking[middle + 1], longer_quanta(cells1, middle, motion)
        base0, base1, base2 = int(np.floor(cells0)), int(np.floor(cells1)), int(np.floor(cells2))
        if not within(base0, base1, base2, first, last, points):
            pull_row(rows[of_node[middle - 1]], cells0, points, first, last, scratch[0])
            pull_row(rows[of_node[middle]], cells1, points, first, last, scratch[1])
            pull_row(rows[of_node[middle + 1]], cells2, points, first, last, scratch[2])
            for j in range(first, last, EIGHT):
                share0, share1, share2 = parabolas(load8(quanta, j) + bend, middle)
                found = load8(scratch[0], j) * share0 + load8(scratch[1], j) * share1
                store(out, j, found + load8(scratch[2], j) * share2)
            continue
        a0, a1, a2, a3 = stencil(cells0 - base0)
        b0, b1, b2, b3 = stencil(cells1 - base1)
        c0, c1, c2, c3 = stencil(cells2 - base2)
        before, there = of_node[middle - 1] * width + base0 - 1, of_node[middle] * width + base1 - 1
        behind = of_node[middle + 1] * width + base2 - 1
        for j in range(first, last, EIGHT):  # what is written behind `last` is overwritten, or does not count
            share0, share1, share2 = parabolas(load8(quanta, j) + bend, middle)
            found0 = load8(rows, before + j) * a0 + load8(rows, before + j + 1) * a1
            found1 = load8(rows, there + j) * b0 + load8(rows, there + j + 1) * b1
            found2 = load8(rows, behind + j) * c0 + load8(rows, behind + j + 1) * c1
            found0 = found0 + load8(rows, before + j + 2) * a2 + load8(rows, before + j + 3) * a3
            found1 = found1 + load8(rows, there + j + 2) * b2 + load8(rows, there + j + 3) * b3
            found2 = found2 + load8(rows, behind + j + 2) * c2 + load8(rows, behind + j + 3) * c3
            store(out, j, share0 * found0 + share1 * found1 + share2 * found2)


@part_inline
def push_period(ahead, kpa, motion, mass, chance, begin, end, rows, spans, scratch):
    """Transpose of `pull_period`: `mass`[j]·`chance`[j] is added to `rows`.

    `spans` (ring, 2) are widened to what it reaches; `scratch` (3, E' + 2·`ROOM`).
    """
    of_node, free, braking = ahead
    quanta, bands = motion.quanta, motion.bands
    points, width = quanta.shape[0] - ROOM, scratch.shape[1]
    for middle in range(NEAREST, bands.shape[0] - 1):
        if bands[middle] >= end:
            break
        first, last = max(begin, bands[middle]), min(end, bands[middle + 1])
        if first >= last:
            continue
        cells0, cells1 = free[middle - 1] - kpa * braking[middle - 1], free[middle] - kpa * braking[middle]
        cells2, bend = free[middle + 1] - kpa * braking[middle + 1], longer_quanta(cells1, middle, motion)
        count, from_first = last - first, EIGHT - first
        for j in range(first, last, EIGHT):
            share0, share1, share2 = parabolas(load8(quanta, j) + bend, middle)
            moved = load8(mass, j) * load8(chance, j)
            store(scratch, from_first + j, share0 * moved)
            store(scratch, from_first + j + width, share1 * moved)
            store(scratch, from_first + j + 2 * width, share2 * moved)
        for side in range(3):
            cells = cells0 if side == 0 else cells1 if side == 1 else cells2
            to = of_node[middle + side - 1]
            push_shifted(scratch, side * width, count, first, cells, points, rows[to], spans[to])


@part_inline
def push_shifted(scratch, at, count, first, cells, points, row, span):
    """Add `count` masses, in `scratch` behind eight places from flat index `at` on, to `row` at `first` + `cells`.

    Far enough from both ends of the grid as a gather, from masses with zeros around them.
    """
    base, last = int(np.floor(cells)), first + count
    if first + base < LINEAR_CELLS or last + base > points - 2:
        push_row(scratch.reshape(-1)[at + EIGHT : at + EIGHT + count], first, cells, points, row, span)
        return
    store(scratch, at, eight(0.0))
    store(scratch, at + EIGHT + count, eight(0.0))
    store(scratch, at + 2 * EIGHT + count, eight(0.0))
    c0, c1, c2, c3 = stencil(cells - base)
    begin, end = first + base - 1, last + base + 2
    away = at + EIGHT - begin
    for i in range(begin, end, EIGHT):
        added = load8(scratch, i + away) * c0 + load8(scratch, i + away - 1) * c1
        added = added + load8(scratch, i + away - 2) * c2 + load8(scratch, i + away - 3) * c3
        store(row, i, load8(row, i) + added)
    span[0], span[1] = min(span[0], begin), max(span[1], end)


@part_inline
def longer_quanta(cells, middle, motion):
    """Quanta that a period is longer by than at the speed of its begin, if `cells` are gained until node `middle`."""
    return cells * motion.energy_step / (middle * motion.path_step) * motion.longer


@part_inline
def within(base0, base1, base2, first, last, points):
    """Whether all energies first ≤ j < `last` arrive far enough from both ends of the grid for the cubic stencil."""
    return first + min(base0, base1, base2) >= LINEAR_CELLS and last + max(base0, base1, base2) <= points - 2


@part_inline
def parabolas(quanta, middle):
    """Weights of the nodes around `middle` at the end of periods that are so many quanta long, three packs."""
    x = greatest(quanta, 1.0) - middle
    square, half = x * x, x * 0.5
    return square * 0.5 - half, square * -1.0 + 1.0, square * 0.5 + half


@part
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


@part
def push_row(mass, first, shift, points, row, span):
    """Transpose of `pull_row`: masses of the energies from `first` on are added to `row`; `span` (2,) is widened."""
    for i in range(mass.shape[0]):
        put_at(row, points, first + i + shift, mass[i])
    base = int(np.floor(shift))
    span[0] = min(span[0], max(min(first + base - 1, points - 4), 0))
    span[1] = max(span[1], min(max(first + mass.shape[0] + base + 3, 4), points))
