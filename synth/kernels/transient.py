"""A change of stage as one step of the chain: from the deciding sample to the first unlocked one.

The landing point lies between two path nodes; the value there is interpolated along the path on which the
cut would roll on at the stage reached, so that interpolation shifts the phase of the sampling a little but
never the speed. `put_transient` is the exact transpose of `transient_value`.

Values and masses live in rings over the path: node n is at index n mod ring length, the exit node N too.

Arguments shared by both: `n`, `c`, `l`, `j` node, transient, noise level, energy point; `factor` ξ_cut;
`mode` reached; landing table `ends` (N, C, E, F, 2), path and energy over `factors` (F,), equally spaced;
noise tables `probability`, `mean`, `std` (C, R, L, L); `drive` (N,) acceleration without brakes, `brake` (N,)
= β; `pressure` (H,) over-pressure of modes; `levels` (L,); `extra` added acceleration of this scenario (its w).
"""

from __future__ import annotations

from numba import njit

from synth.kernels.flow import put_at, value_at


@njit(cache=True, nogil=True, error_model="numpy")
def factor_weights(f, factors):
    """Quadratic interpolation in the friction factor: (nearest node, centre node, three weights)."""
    width = factors[1] - factors[0]
    centre = min(max(int((f - factors[0]) / width + 0.5), 1), factors.shape[0] - 2)
    x = min(max((f - factors[centre]) / width, -1.5), 1.5)
    nearest = centre - 1 if x < -0.5 else (centre + 1 if x > 0.5 else centre)
    return nearest, centre, 0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)


@njit(cache=True, nogil=True, error_model="numpy")
def landing(n, c, j, f, ends, factors):
    """(path in m, energy) at the end of transient `c` from (n, j) for friction factor `f`; path −1: stall.

    Quadratic in f through the three nearest nodes; if one of them stalls, the nearest node decides.
    """
    nearest, i, low, middle, high = factor_weights(f, factors)
    t0, t1, t2 = ends[n, c, j, i - 1, 0], ends[n, c, j, i, 0], ends[n, c, j, i + 1, 0]
    if min(t0, t1, t2) < 0.0:
        return ends[n, c, j, nearest, 0], ends[n, c, j, nearest, 1]
    e0, e1, e2 = ends[n, c, j, i - 1, 1], ends[n, c, j, i, 1], ends[n, c, j, i + 1, 1]
    return low * t0 + middle * t1 + high * t2, low * e0 + middle * e1 + high * e2


@njit(cache=True, nogil=True, error_model="numpy")
def transient_value(
    n, last, c, q, j, factor, mode, ends, factors, probability, mean, std,
    drive, brake, pressure, levels, extra, path_step, energy_step, values, mixed, stalled,
):  # fmt: skip
    """Expected value after transient `c`; `values` (ring, H, L, E), `mixed` the same after level mixing, `last` = N."""
    ring = values.shape[0]
    total = 0.0
    quanta, cells = 1.0 / path_step, 1.0 / energy_step
    nominal, _ = landing(n, c, j, factor, ends, factors)
    if nominal < 0.0:
        return stalled
    crossed = min(int(nominal * quanta + 1e-9), probability.shape[1] - 1)
    for m in range(levels.shape[0]):
        p = probability[c, crossed, q, m]
        if p < 1e-12:
            continue
        spread = std[c, crossed, q, m]
        held = factor * (1.0 + levels[m]) * pressure[mode]
        for side in range(2):
            f = factor * (1.0 + mean[c, crossed, q, m] + (spread if side == 1 else -spread))
            path, e = landing(n, c, j, f, ends, factors)
            if path < 0.0:
                total += 0.5 * p * stalled
                continue
            e += extra * path
            ahead = path * quanta
            crossed_whole = int(ahead + 1e-9)
            cell = n + crossed_whole
            x = max(ahead - crossed_whole, 0.0)
            whole = 1.0 if cell == n else x  # a landing in its own quantum is decided on at the quantum's end
            if cell >= last:
                total += 0.5 * p * value_at(values[last % ring, mode, m], e * cells)
                continue
            slope = (drive[cell] + extra - held * brake[cell]) * path_step
            back = (e - slope * x) * cells
            forth = (e + slope * (1.0 - x)) * cells
            if cell > n:
                total += 0.5 * p * (1.0 - whole) * value_at(values[cell % ring, mode, m], back)
            total += 0.5 * p * whole * value_at(mixed[(cell + 1) % ring, mode, m], forth)
    return total


@njit(cache=True, nogil=True, error_model="numpy")
def put_transient(
    mass, n, last, c, q, j, factor, mode, ends, factors, probability, mean, std,
    drive, brake, pressure, levels, extra, path_step, energy_step, arriving, mixing,
):  # fmt: skip
    """Spread `mass` over `arriving` and `mixing` (ring, H, L, E), `last` = N; returns the mass that stalls."""
    ring = arriving.shape[0]
    stalled = 0.0
    quanta, cells = 1.0 / path_step, 1.0 / energy_step
    nominal, _ = landing(n, c, j, factor, ends, factors)
    if nominal < 0.0:
        return mass
    crossed = min(int(nominal * quanta + 1e-9), probability.shape[1] - 1)
    for m in range(levels.shape[0]):
        p = probability[c, crossed, q, m]
        if p < 1e-12:
            continue
        spread = std[c, crossed, q, m]
        held = factor * (1.0 + levels[m]) * pressure[mode]
        for side in range(2):
            f = factor * (1.0 + mean[c, crossed, q, m] + (spread if side == 1 else -spread))
            path, e = landing(n, c, j, f, ends, factors)
            share = 0.5 * p * mass
            if path < 0.0:
                stalled += share
                continue
            e += extra * path
            ahead = path * quanta
            crossed_whole = int(ahead + 1e-9)
            cell = n + crossed_whole
            x = max(ahead - crossed_whole, 0.0)
            whole = 1.0 if cell == n else x  # a landing in its own quantum is decided on at the quantum's end
            if cell >= last:
                put_at(arriving[last % ring, mode, m], e * cells, share)
                continue
            slope = (drive[cell] + extra - held * brake[cell]) * path_step
            back = (e - slope * x) * cells
            forth = (e + slope * (1.0 - x)) * cells
            if cell > n:
                put_at(arriving[cell % ring, mode, m], back, (1.0 - whole) * share)
            put_at(mixing[(cell + 1) % ring, mode, m], forth, whole * share)
    return stalled
