"""The value of one change of stage from all energies at once (`transient.transient_value`, vectorised).

Backward induction needs every state, so here the loop over energies is innermost and free of branches: the
compiler turns it into vector instructions with gathers. Same formulas, same order of terms.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.flow import interpolation


@njit(cache=True, nogil=True, error_model="numpy")
def transient_values(
    n, last, c, l, factor, mode, travel, energy, factors, probability, mean, std,
    drive, brake, pressure, levels, extra, path_step, energy_step, values, mixed, stalled, cells, out,
):  # fmt: skip
    """`out` (E,) = expected value after transient `c` from node `n` and noise level `l`.

    `cells` (E,) int64 is scratch; everything else as in `transient_value`, but `values`, `mixed`
    (N + 1, H, L, E) hold every node.
    """
    points = out.shape[0]
    longest = probability.shape[1] - 1
    half, centre, low, middle, high = factor_weights(factor, factors)
    out[:] = 0.0
    for j in range(points):
        path = low * travel[n, c, centre - 1, j] + middle * travel[n, c, centre, j] + high * travel[n, c, centre + 1, j]
        stops = min(travel[n, c, centre - 1, j], travel[n, c, centre, j], travel[n, c, centre + 1, j]) < 0.0
        path = travel[n, c, centre + half, j] if stops else path
        cells[j] = min(int(path / path_step + 1e-9), longest) if path >= 0.0 else -1
    for m in range(levels.shape[0]):
        begin = 0
        while begin < points:  # runs of energies that cross equally many quanta share the noise weights
            crossed = cells[begin]
            end = begin + 1
            while end < points and cells[end] == crossed:
                end += 1
            if crossed < 0:
                for j in range(begin, end):
                    out[j] = stalled
            elif probability[c, crossed, l, m] >= 1e-12:
                share = 0.5 * probability[c, crossed, l, m]
                for side in range(2):
                    spread = std[c, crossed, l, m] * (2 * side - 1)
                    add_landings(
                        n, last, c, m, factor, factor * (1.0 + mean[c, crossed, l, m] + spread), share, begin, end,
                        mode, travel, energy, factors, drive, brake, pressure, levels, extra, path_step,
                        energy_step, values, mixed, stalled, out,
                    )  # fmt: skip
            begin = end


@njit(cache=True, nogil=True, error_model="numpy")
def factor_weights(f, factors):
    """Nodes and weights of quadratic interpolation in the friction factor.

    Returns (offset of the nearest node from the centre, centre index, three weights); see `transient.landing`.
    """
    width = factors[1] - factors[0]
    centre = min(max(int((f - factors[0]) / width + 0.5), 1), factors.shape[0] - 2)
    x = min(max((f - factors[centre]) / width, -1.5), 1.5)
    nearest = -1 if x < -0.5 else (1 if x > 0.5 else 0)
    return nearest, centre, 0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)


@njit(cache=True, nogil=True, error_model="numpy")
def add_landings(
    n, last, c, m, factor, f, share, begin, end, mode, travel, energy, factors,
    drive, brake, pressure, levels, extra, path_step, energy_step, values, mixed, stalled, out,
):  # fmt: skip
    """Add `share` of the values at the landings with friction factor `f` to `out`[begin:end]."""
    nearest, centre, low, middle, high = factor_weights(f, factors)
    t0, t1, t2 = travel[n, c, centre - 1], travel[n, c, centre], travel[n, c, centre + 1]
    e0, e1, e2 = energy[n, c, centre - 1], energy[n, c, centre], energy[n, c, centre + 1]
    t_near, e_near = travel[n, c, centre + nearest], energy[n, c, centre + nearest]
    _, modes, size, points = values.shape
    flat, flat_mixed = values.reshape(-1), mixed.reshape(-1)
    held = factor * (1.0 + levels[m]) * pressure[mode]
    quanta, cells = 1.0 / path_step, 1.0 / energy_step
    row = mode * size + m
    for j in range(begin, end):
        stops = min(t0[j], t1[j], t2[j]) < 0.0
        path = t_near[j] if stops else low * t0[j] + middle * t1[j] + high * t2[j]
        e = (e_near[j] if stops else low * e0[j] + middle * e1[j] + high * e2[j]) + extra * path
        ahead = path * quanta
        whole = int(max(ahead + 1e-9, 0.0))
        cell = min(n + whole, last)
        inside = cell < last
        x = max(ahead - whole, 0.0) if inside else 0.0
        at = min(cell, last - 1)
        slope = drive[at] + extra - held * brake[at]
        back = (e - slope * x * path_step) * cells
        forth = (e + slope * (1.0 - x) * path_step) * cells
        x = 1.0 if whole == 0 and inside else x
        known = cell if whole > 0 else last  # node n itself is not valued yet
        here = interpolated(flat, (known * modes * size + row) * points, back, points)
        there = interpolated(flat_mixed, (min(cell + 1, last) * modes * size + row) * points, forth, points)
        value = (1.0 - x) * here + x * there if inside else here
        out[j] += share * (stalled if path < 0.0 else value)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def interpolated(flat, row, position, points):
    """`flow.value_at` on a flat array whose row starts at index `row`."""
    i, c0, c1, c2, c3 = interpolation(position, points)
    at = np.uint64(row + i)
    one, two = np.uint64(1), np.uint64(2)
    return c0 * flat[at - one] + c1 * flat[at] + c2 * flat[at + one] + c3 * flat[at + two]
