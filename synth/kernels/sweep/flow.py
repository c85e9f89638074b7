"""Motion at a held stage over one path quantum, on the uniform energy grid, and its transpose.

In e = v²/2 a held stage shifts every speed by the same amount, so a quantum is a four-point stencil with
constant weights on contiguous arrays, after mixing the levels of the path noise. `push` is the exact
transpose of `pull`, so forward densities and backward values agree to rounding.
"""

from __future__ import annotations

import numpy as np

from synth.kernels.compiling import part, part_inline
from synth.kernels.vector.packs import EIGHT, eight, first_lane, last_lane, load8, magnitude, store

LINEAR_CELLS = 8
"""Cells above a stall with linear interpolation. The value falls there within a cell or two by the whole cost of a
stall. By the negative weights of a cubic a negative share of the cuts would stall, at a cost below zero, and policies
would brake towards it. Each quantum adds to that share: it grows with the length of a pass, and with finer steps of
path. Eight cells leave nothing of it, and sixteen change nothing more (docs/explanation/method-solver.md)."""

NO_MASS = 1e-25
"""Probabilities below this are dropped: the tails of a density would otherwise run into slow denormal numbers."""


@part
def in_every_state(row, points, out):
    """The first `points` of `out` (·, H, L, ·) = those of `row`, in every mode and level.

    A loop, for `out[...] = row` makes numba compile the message for shapes that differ: seconds in every kernel.
    """
    for i in range(out.shape[0]):
        for h in range(out.shape[1]):
            for q in range(out.shape[2]):
                for j in range(points):
                    out[i, h, q, j] = row[j]


@part
def pull(values, points, transition, shift, stalled, first, last, out, mixed):
    """`out`[h, q, j] = Σ_m transition[q, m]·values[h, m](j + shift[h, q]) for first ≤ j < last.

    `values`, `out` (H, L, E·T): T targets side by side at each of `points` E energies, then room; `stalled` (T,) values
    at and below cell 0; `shift` (H, L) in cells of the energy grid; above the grid the last value holds. `mixed`
    (E·T,) is scratch.
    """
    modes, levels, _ = values.shape
    width = stalled.shape[0]
    for h in range(modes):
        for q in range(levels):
            base = int(np.floor(shift[h, q]))
            x = shift[h, q] - base
            c0, c1, c2, c3 = stencil(x)
            begin = max(min(first + base - 1, points - 4), 0) * width
            end = min(max(last + base + 3, 4), points) * width
            mix_row(values, h, transition[q], begin, end, mixed)
            for t in range(width):
                mixed[t] = out[h, q, t] = stalled[t]
            low = min(max(LINEAR_CELLS - base, first), last)
            high = max(min(points - 2 - base, last), low)
            stencil_row(mixed, base * width, width, c0, c1, c2, c3, low * width, high * width, out[h, q])
            for j in range(first, low):
                take(mixed, j + base + x, points, width, out[h, q], j)
            for j in range(high, last):
                take(mixed, j + base + x, points, width, out[h, q], j)


@part
def mix_row(values, h, share, begin, end, out):
    """`out`[begin:end] = Σ_m share[m]·values[h, m, begin:end], `values` (H, L, E·T)."""
    levels, size = values.shape[1], values.shape[2]
    row = h * levels * size
    stop = begin + (end - begin) // EIGHT * EIGHT
    for j in range(begin, stop, EIGHT):
        found = load8(values, row + j) * share[0]
        for m in range(1, levels):
            found = found + load8(values, row + m * size + j) * share[m]
        store(out, j, found)
    for j in range(stop, end):
        out[j] = share[0] * values[h, 0, j]
        for m in range(1, levels):
            out[j] += share[m] * values[h, m, j]


@part
def stencil_row(row, ahead, width, c0, c1, c2, c3, begin, end, out):
    """`out`[j] = the four of `row` around j + `ahead`, a distance of `width` apart, for begin ≤ j < end."""
    stop = begin + (end - begin) // EIGHT * EIGHT
    for j in range(begin, stop, EIGHT):
        i = j + ahead
        near = load8(row, i - width) * c0 + load8(row, i) * c1
        store(out, j, near + load8(row, i + width) * c2 + load8(row, i + 2 * width) * c3)
    for j in range(stop, end):
        i = j + ahead
        out[j] = c0 * row[i - width] + c1 * row[i] + c2 * row[i + width] + c3 * row[i + 2 * width]


@part
def take(row, position, points, width, out, j):
    """`out` at energy j = `row` interpolated at `position`, for all targets; rows (E·T,)."""
    i, c0, c1, c2, c3 = interpolation(position, points)
    for t in range(width):
        at = i * width + t
        out[j * width + t] = c0 * row[at - width] + c1 * row[at] + c2 * row[at + width] + c3 * row[at + 2 * width]


@part
def push(mass, spans, transition, shift, points, first, last, out, reached, moved):
    """Transpose of `pull`: mass in first ≤ j < last at the start of a quantum goes to its end, added to `out`.

    `mass`, `out` (H, L, E') hold `points` energies and zeros up to whole packs; `spans` (H, L, 2) ranges of energies
    out of which `mass` is zero, `reached` those of `out`, widened. Returns (stalled, escaped): mass that stopped, and
    mass that ran into the top of the grid (it is kept in the last cell). `moved` (E',) is scratch.
    """
    modes, levels, width = mass.shape
    stalled, escaped = 0.0, 0.0
    for h in range(modes):
        for q in range(levels):
            row = mass[h, q]
            begin, end = extent(row, max(spans[h, q, 0], first), min(spans[h, q, 1], last), NO_MASS)
            if begin >= end:
                continue
            base = int(np.floor(shift[h, q]))
            x = shift[h, q] - base
            low = min(max(LINEAR_CELLS - base, begin), end)
            high = max(min(points - 2 - base, end), low)
            bottom = max(min(begin + base - 1, points - 4), 0)
            top = min(max(end + base + 3, 4), points)
            clear(moved, bottom, top + EIGHT)
            for j in range(begin, low):
                put_at(moved, points, j + base + x, row[j])
            spread_by_stencil(row, low, high, base, stencil(x), moved)
            for j in range(high, end):
                put_at(moved, points, j + base + x, row[j])
                escaped += abs(row[j])
            if bottom == 0:
                stalled += moved[0]
                moved[0] = 0.0
            for m in range(levels):
                add_row(moved, transition[q, m], bottom, top, out, (h * levels + m) * width)
                widen(reached[h, m], bottom, top)
    return stalled, escaped


@part
def widen(span, begin, end):
    """Make the range `span` (2,), empty where it does not end beyond its beginning, hold begin ≤ j < end too."""
    if span[0] < span[1]:
        begin, end = min(begin, span[0]), max(end, span[1])
    span[0], span[1] = begin, end


@part
def add_row(row, share, begin, end, out, at):
    """Add `share` of `row`[begin:end] to `out` from flat index `at` + begin on; beyond it stand zeros."""
    for j in range(begin, end, EIGHT):
        store(out, at + j, load8(out, at + j) + load8(row, j) * share)


@part
def clear(rows, first, last):
    """Set the flat indices first ≤ j < `last` of `rows` to zero, and what whole packs need beyond, within `rows`."""
    last = min(last, rows.size)
    stop = first + (last - first) // EIGHT * EIGHT
    for j in range(first, stop, EIGHT):
        store(rows, j, eight(0.0))
    for j in range(stop, last):
        rows[j] = 0.0


@part
def spread_by_stencil(row, low, high, base, weights, out):
    """Add every row[j], low ≤ j < high, to out[j + base − 1 … j + base + 2] with its four weights.

    Written as a gather, one pass with four products; its two ends, where terms are missing, apart.
    """
    c0, c1, c2, c3 = weights
    if high - low < 4:
        for j in range(low, high):
            out[j + base - 1] += c0 * row[j]
            out[j + base] += c1 * row[j]
            out[j + base + 1] += c2 * row[j]
            out[j + base + 2] += c3 * row[j]
        return
    begin, end = low + 2, high - 1
    stop = begin + (end - begin) // EIGHT * EIGHT
    for j in range(begin, stop, EIGHT):
        added = load8(row, j + 1) * c0 + load8(row, j) * c1 + load8(row, j - 1) * c2 + load8(row, j - 2) * c3
        store(out, j + base, load8(out, j + base) + added)
    for j in range(stop, end):
        out[j + base] += c0 * row[j + 1] + c1 * row[j] + c2 * row[j - 1] + c3 * row[j - 2]
    first, last = low + base, high + base
    out[first - 1] += c0 * row[low]
    out[first] += c0 * row[low + 1] + c1 * row[low]
    out[first + 1] += c0 * row[low + 2] + c1 * row[low + 1] + c2 * row[low]
    out[last - 1] += c1 * row[high - 1] + c2 * row[high - 2] + c3 * row[high - 3]
    out[last] += c2 * row[high - 1] + c3 * row[high - 2]
    out[last + 1] += c3 * row[high - 1]


@part
def extent(row, first, last, least_mass):
    """Smallest range of indices within [first, last) that holds all entries of `row` of at least `least_mass`.

    Eight further entries of `row` may be read.
    """
    found = EIGHT
    while first < last and found == EIGHT:
        found = first_lane(magnitude(load8(row, first)) >= least_mass)
        first += found
    first, found = min(first, last), -1
    while first < last and found < 0:
        count = min(last - first, EIGHT)
        found = last_lane(magnitude(load8(row, last - count)) >= least_mass, count)
        last -= count - 1 - found
    return first, last


@part_inline
def stencil(x):
    """Weights of cubic Lagrange interpolation at fraction x between the second and third of four points."""
    c0 = -x * (x - 1.0) * (x - 2.0) / 6.0
    c1 = (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0
    c2 = -(x + 1.0) * x * (x - 2.0) / 2.0
    c3 = (x + 1.0) * x * (x - 1.0) / 6.0
    return c0, c1, c2, c3


@part_inline
def interpolation(position, points):
    """Second of the four grid points that interpolate at `position` (cells), and their weights.

    Cubic inside, held constant beyond both ends, linear in the last cell and in the first `LINEAR_CELLS`.
    """
    position = min(max(position, 0.0), points - 1.0)
    i = min(max(int(position), 1), points - 3)
    x = position - i
    c0, c1, c2, c3 = stencil(x)
    before, after, low = x < 0.0, x > 1.0, position < LINEAR_CELLS
    c0 = -x if before else (0.0 if after or low else c0)
    c1 = 1.0 + x if before else (0.0 if after else (1.0 - x if low else c1))
    c2 = 0.0 if before else (2.0 - x if after else (x if low else c2))
    c3 = x - 1.0 if after else (0.0 if before or low else c3)
    return i, c0, c1, c2, c3


@part
def put_at(row, points, position, mass):
    """Transpose of `take`, `row` of `points` energies; what arrives at or below cell 0 is found in `row`[0]."""
    i, c0, c1, c2, c3 = interpolation(position, points)
    row[i - 1] += c0 * mass
    row[i] += c1 * mass
    row[i + 1] += c2 * mass
    row[i + 2] += c3 * mass


@part
def shifts(n, chain, factor, extra, out):
    """Energy change over quantum `n` of `chain` at every mode and level, in cells of the grid; `out` (H, L)."""
    drive, brake, levels, pressure = chain.track.drive, chain.track.brake, chain.noise.levels, chain.modes.pressure
    for h in range(pressure.shape[0]):
        for q in range(levels.shape[0]):
            slope = drive[n] + extra - factor * (1.0 + levels[q]) * brake[n] * pressure[h]
            out[h, q] = slope * chain.grid.path_step / chain.grid.energy_step


@part
def mix_values(values, transition, first, last, stalled, out):
    """`out`[h, q, j] = Σ_m transition[q, m]·values[h, m, j] for first ≤ j < last; shapes (H, L, E·T)."""
    modes, levels, _ = values.shape
    width = stalled.shape[0]
    for h in range(modes):
        for q in range(levels):
            for t in range(width):
                out[h, q, t] = stalled[t]
            mix_row(values, h, transition[q], first * width, last * width, out[h, q])
