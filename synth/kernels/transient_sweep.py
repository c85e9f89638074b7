"""The value of one change of stage from all energies and for all targets (`transient.transient_value`).

Where a cut lands does not depend on the target speed; only the value there does. So the landing is worked out
once and the targets, side by side in memory, are interpolated with the same weights. Energies that cross
equally many path quanta share the noise and so the interpolation in the friction factor: they are done in runs.
"""

from __future__ import annotations

from numba import njit

from synth.kernels.flow import weights_at
from synth.kernels.transient import factor_weights, landing


@njit(cache=True, nogil=True, error_model="numpy")
def transient_values(
    n, last, c, q, factor, mode, ends, factors, probability, mean, std,
    drive, brake, pressure, levels, extra, path_step, energy_step, values, mixed, stalled, out,
):  # fmt: skip
    """`out` (E·T,) = expected value after transient `c` from node `n` and noise level `l`.

    `values`, `mixed` (N + 1, H, L, E·T) hold every node; `stalled` (T,); the rest as in `transient_value`.
    """
    width = stalled.shape[0]
    points = out.shape[0] // width
    longest = probability.shape[1] - 1
    out[:] = 0.0
    begin = 0
    while begin < points:
        crossed = quanta_crossed(n, c, begin, factor, ends, factors, path_step, longest)
        end = begin + 1
        while end < points:
            if quanta_crossed(n, c, end, factor, ends, factors, path_step, longest) != crossed:
                break
            end += 1
        if crossed < 0:
            for j in range(begin, end):
                out[j * width : (j + 1) * width] = stalled
            begin = end
            continue
        for m in range(levels.shape[0]):
            p = probability[c, crossed, q, m]
            if p < 1e-12:
                continue
            held = factor * (1.0 + levels[m]) * pressure[mode]
            for side in range(2):
                spread = std[c, crossed, q, m] * (2 * side - 1)
                f = factor * (1.0 + mean[c, crossed, q, m] + spread)
                add_landings(
                    n, last, m, f, 0.5 * p, begin, end, mode, ends[n, c], factors,
                    drive, brake, held, extra, path_step, energy_step, values, mixed, stalled, out,
                )  # fmt: skip
        begin = end


@njit(cache=True, nogil=True, error_model="numpy")
def quanta_crossed(n, c, j, factor, ends, factors, path_step, longest):
    """Path quanta crossed in the transient at the nominal friction of the scenario, −1 for a stall."""
    path, _ = landing(n, c, j, factor, ends, factors)
    return -1 if path < 0.0 else min(int(path / path_step + 1e-9), longest)


@njit(cache=True, nogil=True, error_model="numpy")
def add_landings(
    n, last, m, f, share, begin, end, mode, ends, factors,
    drive, brake, held, extra, path_step, energy_step, values, mixed, stalled, out,
):  # fmt: skip
    """Add `share` of the values at the landings with friction factor `f` to `out`[begin:end].

    `ends` (E, F, 2) of this node and transient; `held` = ξ·(1 + η)·over-pressure after it.
    """
    width = stalled.shape[0]
    points = out.shape[0] // width
    nearest, centre, low, middle, high = factor_weights(f, factors)
    quanta, cells = 1.0 / path_step, 1.0 / energy_step
    for j in range(begin, end):
        t0, t1, t2 = ends[j, centre - 1, 0], ends[j, centre, 0], ends[j, centre + 1, 0]
        path = low * t0 + middle * t1 + high * t2
        e = low * ends[j, centre - 1, 1] + middle * ends[j, centre, 1] + high * ends[j, centre + 1, 1]
        if min(t0, t1, t2) < 0.0:
            path, e = ends[j, nearest, 0], ends[j, nearest, 1]
            if path < 0.0:
                for t in range(width):
                    out[j * width + t] += share * stalled[t]
                continue
        e += extra * path
        ahead = path * quanta
        whole = int(ahead + 1e-9)
        cell, x = n + whole, max(ahead - whole, 0.0)
        if cell >= last:
            add(values[last, mode, m], e * cells, points, share, width, out, j)
            continue
        slope = (drive[cell] + extra - held * brake[cell]) * path_step
        forth = (e + slope * (1.0 - x)) * cells
        if whole == 0:  # see `transient`: decided on at the quantum's end
            add(mixed[cell + 1, mode, m], forth, points, share, width, out, j)
            continue
        add(values[cell, mode, m], (e - slope * x) * cells, points, share * (1.0 - x), width, out, j)
        add(mixed[cell + 1, mode, m], forth, points, share * x, width, out, j)


@njit(cache=True, nogil=True, error_model="numpy")
def add(row, position, points, weight, width, out, j):
    """Add `weight` times `row` (E·T,) interpolated at `position` to `out` at energy j, for all targets."""
    i, c0, c1, c2, c3 = weights_at(position, points)
    c0, c1, c2, c3 = weight * c0, weight * c1, weight * c2, weight * c3
    at, to = (i - 1) * width, j * width
    for t in range(width):
        value = c0 * row[at + t] + c1 * row[at + width + t]
        out[to + t] += value + c2 * row[at + 2 * width + t] + c3 * row[at + 3 * width + t]
