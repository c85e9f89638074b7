"""Where a cut stands when a transient ends: integration of the motion through a pressure history."""

from __future__ import annotations

import numpy as np
from numba import njit

from synth.kernels.vector.borrowing import borrowing
from synth.kernels.vector.packs import (
    SIXTEEN,
    choose,
    fraction,
    gather,
    greatest,
    holds_anywhere,
    least,
    load16,
    root,
    store,
    whole,
)


@njit(cache=True, nogil=True, error_model="numpy")
def land(starts, lead, held, fine, work, gravity, overpressure, samples, substeps, dt, factors, speed, ends):
    """Integrate every transient from every decision; results into `ends`.

    Shapes: `starts` (R,) path of the decisions and `lead` (R,) path from there at the overpressure `held` (C,) before
    the transient begins; `work` (W + 1,) = ∫β ds at steps of `fine` from 0 to S_exit, `gravity` (W,) means of
    g'(i − w)·1e-3; `overpressure` (C, ·) per substep of `dt` seconds; `samples` (C,); `factors` (F,) friction factors;
    `speed` (E',), whole packs. `ends` (R, C, F, 2, E'): path until the end of the transient, or to S_exit, −1 for a
    stall; and v²/2 there.
    """
    cells, points = gravity.shape[0], speed.shape[0]
    rise = np.empty(cells)
    for i in range(cells):
        rise[i] = work[i + 1] - work[i]
    count, numbers = samples.shape[0], factors.shape[0]
    for n in range(ends.shape[0]):
        start = starts[n]
        for c in range(count):
            for f in range(numbers):
                at = ((n * count + c) * numbers + f) * 2 * points
                for j in range(0, points, SIXTEEN):
                    v, ahead = load16(speed, j), lead[n]
                    if ahead != 0.0:
                        v = rolled_on(start, ahead, v, work, rise, gravity, fine, factors[f] * held[c])
                    path, energy = landing_of_pack(
                        start + ahead, v, work, rise, gravity, fine, overpressure[c], samples[c] * substeps,
                        factors[f], dt,
                    )  # fmt: skip
                    if ahead != 0.0:
                        path = choose(path < 0.0, -1.0, path + ahead)
                    store(ends, at + j, path)
                    store(ends, at + points + j, energy)


@borrowing
def rolled_on(start, ahead, v, work, rise, gravity, fine, brake):
    """Speeds a path `ahead` of `start`, behind it if that is negative, at the constant overpressure times friction."""
    here, there = max(start, 0.0) / fine, max(start + ahead, 0.0) / fine
    i, k = min(int(here), gravity.shape[0] - 1), min(int(there), gravity.shape[0] - 1)
    done = work[k] + min(there - k, 1.0) * rise[k] - work[i] - (here - i) * rise[i]
    square = v * v + 2.0 * (gravity[i] * ahead - brake * done)
    return choose(v > 0.0, root(greatest(square, 0.0)), 0.0)


@borrowing
def landing_of_pack(start, v, work, rise, gravity, fine, overpressure, steps, factor, dt):
    """(path, v²/2) at the end of one transient for a pack of speeds at `start`.

    The brake work is taken from the integral of β over the step's own path, so a jump of N(s) costs no
    accuracy; where S_exit is crossed inside a step, the energy there is kept. No pack is followed further than that
    all its speeds have left or stopped.
    """
    cells = gravity.shape[0]
    exit_m, scale, top = cells * fine, 1.0 / fine, cells - 1e-9
    s = v * 0.0 + start
    left_with = v * 0.0 - 1.0
    for step in range(steps):
        brake = factor * overpressure[step]
        reach = v * dt
        x0, x1 = least(s * scale, top), least((s + reach) * scale, top)
        i0, i1 = whole(x0), whole(x1)
        a = gather(work, i0) + (x0 - fraction(i0)) * gather(rise, i0)
        b = gather(work, i1) + (x1 - fraction(i1)) * gather(rise, i1)
        pull = gather(gravity, i0)
        faster = v + (pull - brake * ((b - a) / greatest(reach, 1e-9))) * dt
        ahead = s + (v + greatest(faster, 0.0)) * 0.5 * dt
        moves = v > 0.0
        crosses = (left_with < 0.0) & (ahead >= exit_m) & moves
        if holds_anywhere(crosses):
            left = pull * (exit_m - s) - brake * (work[cells] - a)
            left_with = choose(crosses, greatest(v * v * 0.5 + left, 0.0), left_with)
        s = choose(moves, least(ahead, exit_m), s)
        v = choose(moves, greatest(faster, 0.0), 0.0)
        if not holds_anywhere((v > 0.0) & (left_with < 0.0)):
            break
    left = left_with >= 0.0
    stopped = v <= 0.0
    path = choose(left, exit_m - start, choose(stopped, -1.0, s - start))
    return path, choose(left, left_with, choose(stopped, 0.0, v * v * 0.5))
