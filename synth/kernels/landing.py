"""Where a cut stands when a transient ends: integration of the motion through a pressure history."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True, error_model="numpy")
def land(path_step, work, gravity, overpressure, samples, substeps, dt, factors, speed, ends):
    """Integrate every transient from every node; results into `ends`.

    Shapes: `work` (W + 1,) = ∫β ds at equal steps from 0 to S_exit, `gravity` (W,) means of g'(i − w)·1e-3;
    `overpressure` (C, ·) per substep of `dt` seconds; `samples` (C,); `factors` (F,) friction factors;
    `speed` (E,). `ends` (N, C, E, F, 2): path until the end of the transient, or to S_exit, −1 for a stall; and
    v²/2 there. Factors are next to each other because they are interpolated together.
    """
    cells = gravity.shape[0]
    fine = (ends.shape[0] * path_step) / cells
    exit_m = cells * fine
    points = speed.shape[0]
    s, v, w0 = np.empty(points), np.empty(points), np.empty(points)
    for n in range(ends.shape[0]):
        start = n * path_step
        for c in range(samples.shape[0]):
            for f in range(factors.shape[0]):
                for j in range(points):
                    s[j], v[j], w0[j] = start, speed[j], -1.0
                for step in range(samples[c] * substeps):
                    brake = factors[f] * overpressure[c, step]
                    advance(s, v, w0, work, gravity, fine, cells, exit_m, brake, dt)
                for j in range(points):
                    if w0[j] >= 0.0:
                        ends[n, c, j, f, 0], ends[n, c, j, f, 1] = exit_m - start, w0[j]
                    elif v[j] <= 0.0:
                        ends[n, c, j, f, 0], ends[n, c, j, f, 1] = -1.0, 0.0
                    else:
                        ends[n, c, j, f, 0], ends[n, c, j, f, 1] = s[j] - start, 0.5 * v[j] * v[j]


@njit(cache=True, nogil=True, error_model="numpy")
def advance(s, v, left_with, work, gravity, fine, cells, exit_m, brake, dt):
    """One time step for all speeds at once (structure of arrays, so that it vectorises).

    The brake work is taken from the integral of β over the step's own path, so a jump of N(s) costs no
    accuracy; `left_with` becomes the energy at S_exit in the step in which it is crossed.
    """
    scale = 1.0 / fine
    for j in range(s.shape[0]):
        reach = v[j] * dt
        x0 = min(s[j] * scale, cells - 1e-9)
        x1 = min((s[j] + reach) * scale, cells - 1e-9)
        i0, i1 = int(x0), int(x1)
        a = work[i0] + (x0 - i0) * (work[i0 + 1] - work[i0])
        b = work[i1] + (x1 - i1) * (work[i1 + 1] - work[i1])
        mean = (b - a) / max(reach, 1e-9)
        change = gravity[i0] - brake * mean
        faster = v[j] + change * dt
        ahead = s[j] + 0.5 * (v[j] + max(faster, 0.0)) * dt
        crosses = left_with[j] < 0.0 and ahead >= exit_m and v[j] > 0.0
        left = gravity[i0] * (exit_m - s[j]) - brake * (work[cells] - a)
        at_exit = max(0.5 * v[j] * v[j] + left, 0.0)
        left_with[j] = at_exit if crosses else left_with[j]
        moves = v[j] > 0.0
        s[j] = min(ahead, exit_m) if moves else s[j]
        v[j] = max(faster, 0.0) if moves else 0.0
