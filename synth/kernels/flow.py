"""Motion at a held stage over one path quantum, on the uniform energy grid, and its transpose.

In e = v²/2 a held stage shifts every speed by the same amount, so a quantum is a four-point stencil with
constant weights on contiguous arrays, after mixing the levels of the path noise. `push` is the exact
transpose of `pull`, so forward densities and backward values agree to rounding.
"""

from __future__ import annotations

import numpy as np
from numba import njit

LINEAR_CELLS = 2
"""Cells above a stall with linear interpolation: there the value falls so steeply that a cubic would promise costs
below zero, and the policy would brake towards them."""

NO_MASS = 1e-25
"""Probabilities below this are dropped: the tails of a density would otherwise run into slow denormal numbers."""


@njit(cache=True, nogil=True, error_model="numpy")
def pull(values, transition, shift, stalled, first, last, out, mixed):
    """`out`[h, q, j] = Σ_m transition[q, m]·values[h, m](j + shift[h, q]) for first ≤ j < last.

    `values`, `out` (H, L, E·T): T targets side by side at every energy; `stalled` (T,) values at and below cell 0;
    `shift` (H, L) in cells of the energy grid; above the grid the last value holds. `mixed` (E·T,) is scratch.
    """
    modes, levels, size = values.shape
    width = stalled.shape[0]
    points = size // width
    for h in range(modes):
        for q in range(levels):
            base = int(np.floor(shift[h, q]))
            x = shift[h, q] - base
            c0, c1, c2, c3 = stencil(x)
            begin = max(min(first + base - 1, points - 4), 0) * width
            end = min(max(last + base + 3, 4), points) * width
            for j in range(begin, end):
                mixed[j] = transition[q, 0] * values[h, 0, j]
            for m in range(1, levels):
                p = transition[q, m]
                for j in range(begin, end):
                    mixed[j] += p * values[h, m, j]
            mixed[:width] = stalled
            out[h, q, :width] = stalled
            low = min(max(LINEAR_CELLS - base, first), last)
            high = max(min(points - 2 - base, last), low)
            for j in range(low * width, high * width):
                i = j + base * width
                out[h, q, j] = c0 * mixed[i - width] + c1 * mixed[i] + c2 * mixed[i + width] + c3 * mixed[i + 2 * width]
            for j in range(first, low):
                take(mixed, j + base + x, points, width, out[h, q], j)
            for j in range(high, last):
                take(mixed, j + base + x, points, width, out[h, q], j)


@njit(cache=True, nogil=True, error_model="numpy")
def take(row, position, points, width, out, j):
    """`out` at energy j = `row` interpolated at `position`, for all targets; rows (E·T,)."""
    i, c0, c1, c2, c3 = interpolation(position, points)
    for t in range(width):
        at = i * width + t
        out[j * width + t] = c0 * row[at - width] + c1 * row[at] + c2 * row[at + width] + c3 * row[at + 2 * width]


@njit(cache=True, nogil=True, error_model="numpy")
def push(mass, transition, shift, first, last, out, moved):
    """Transpose of `pull`: mass in first ≤ j < last at the start of a quantum goes to its end, added to `out`.

    Returns (stalled, escaped): mass that stopped, and mass that ran into the top of the grid (it is kept in
    the last cell). `moved` (E,) is scratch.
    """
    modes, levels, points = mass.shape
    stalled, escaped = 0.0, 0.0
    for h in range(modes):
        for q in range(levels):
            begin, end = extent(mass[h, q], first, last)
            if begin >= end:
                continue
            base = int(np.floor(shift[h, q]))
            x = shift[h, q] - base
            c0, c1, c2, c3 = stencil(x)
            low = min(max(LINEAR_CELLS - base, begin), end)
            high = max(min(points - 2 - base, end), low)
            bottom = max(min(begin + base - 1, points - 4), 0)
            top = min(max(end + base + 3, 4), points)
            moved[bottom:top] = 0.0
            for j in range(begin, low):
                put_at(moved, j + base + x, mass[h, q, j])
            spread_by_stencil(mass[h, q], low, high, base, c0, c1, c2, c3, moved)
            for j in range(high, end):
                put_at(moved, j + base + x, mass[h, q, j])
                escaped += abs(mass[h, q, j])
            if bottom == 0:
                stalled += moved[0]
                moved[0] = 0.0
            for m in range(levels):
                p = transition[q, m]
                for j in range(bottom, top):
                    out[h, m, j] += p * moved[j]
    return stalled, escaped


@njit(cache=True, nogil=True, error_model="numpy")
def spread_by_stencil(row, low, high, base, c0, c1, c2, c3, out):
    """Add every row[j], low ≤ j < high, to out[j + base − 1 … j + base + 2] with weights c0 … c3.

    Written as a gather, one pass with four products; its two ends, where terms are missing, apart.
    """
    if high - low < 4:
        for j in range(low, high):
            out[j + base - 1] += c0 * row[j]
            out[j + base] += c1 * row[j]
            out[j + base + 1] += c2 * row[j]
            out[j + base + 2] += c3 * row[j]
        return
    for j in range(low + 2, high - 1):
        out[j + base] += c0 * row[j + 1] + c1 * row[j] + c2 * row[j - 1] + c3 * row[j - 2]
    first, last = low + base, high + base
    out[first - 1] += c0 * row[low]
    out[first] += c0 * row[low + 1] + c1 * row[low]
    out[first + 1] += c0 * row[low + 2] + c1 * row[low + 1] + c2 * row[low]
    out[last - 1] += c1 * row[high - 1] + c2 * row[high - 2] + c3 * row[high - 3]
    out[last] += c2 * row[high - 1] + c3 * row[high - 2]
    out[last + 1] += c3 * row[high - 1]


@njit(cache=True, nogil=True, error_model="numpy")
def extent(row, first, last):
    """Smallest range of indices within [first, last) that holds all entries of `row` above `NO_MASS`."""
    while first < last and abs(row[first]) < NO_MASS:
        first += 1
    while last > first and abs(row[last - 1]) < NO_MASS:
        last -= 1
    return first, last


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def stencil(x):
    """Weights of cubic Lagrange interpolation at fraction x between the second and third of four points."""
    c0 = -x * (x - 1.0) * (x - 2.0) / 6.0
    c1 = (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0
    c2 = -(x + 1.0) * x * (x - 2.0) / 2.0
    c3 = (x + 1.0) * x * (x - 1.0) / 6.0
    return c0, c1, c2, c3


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
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


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def weights_at(position, points):
    """`interpolation`, with a short cut for positions away from both ends."""
    if LINEAR_CELLS <= position < points - 3.0:
        i = int(position)
        c0, c1, c2, c3 = stencil(position - i)
        return i, c0, c1, c2, c3
    return interpolation(position, points)


@njit(cache=True, nogil=True, error_model="numpy")
def value_at(row, position):
    """`row` (E,) interpolated at `position` in cells."""
    i, c0, c1, c2, c3 = weights_at(position, row.shape[0])
    return c0 * row[i - 1] + c1 * row[i] + c2 * row[i + 1] + c3 * row[i + 2]


@njit(cache=True, nogil=True, error_model="numpy")
def put_at(row, position, mass):
    """Transpose of `value_at`; what arrives at or below cell 0 is found in `row`[0]."""
    i, c0, c1, c2, c3 = weights_at(position, row.shape[0])
    row[i - 1] += c0 * mass
    row[i] += c1 * mass
    row[i + 1] += c2 * mass
    row[i + 2] += c3 * mass


@njit(cache=True, nogil=True, error_model="numpy")
def quanta_to_next_sample(speed, acceleration, period, path_step):
    """Path until the next sample at a held stage, in quanta, never below a small positive number."""
    reach = speed * period + 0.5 * acceleration * period * period
    if speed + acceleration * period < 0.0:
        reach = -0.5 * speed * speed / acceleration
    return max(reach / path_step, 0.01)


@njit(cache=True, nogil=True, error_model="numpy")
def shifts(n, factor, levels, drive, brake, pressure, extra, path_step, energy_step, out):
    """Energy change over quantum `n` at every mode and level, in cells of the grid; `out` (H, L)."""
    for h in range(pressure.shape[0]):
        for q in range(levels.shape[0]):
            slope = drive[n] + extra - factor * (1.0 + levels[q]) * brake[n] * pressure[h]
            out[h, q] = slope * path_step / energy_step


@njit(cache=True, nogil=True, error_model="numpy")
def mix_values(values, transition, first, last, stalled, out):
    """`out`[h, q, j] = Σ_m transition[q, m]·values[h, m, j] for first ≤ j < last; shapes (H, L, E·T)."""
    modes, levels, _ = values.shape
    width = stalled.shape[0]
    for h in range(modes):
        for q in range(levels):
            out[h, q, :width] = stalled
            for j in range(first * width, last * width):
                out[h, q, j] = transition[q, 0] * values[h, 0, j]
            for m in range(1, levels):
                p = transition[q, m]
                for j in range(first * width, last * width):
                    out[h, q, j] += p * values[h, m, j]
