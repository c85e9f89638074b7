"""Where a cut stands when a transient ends: integration of the motion through a pressure history."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import kernel, part, part_inline
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

STATE = 3 * SIXTEEN
"""Numbers of the state of a pack on its way: path, speed, and the energy that it left with, −1 before."""


class Ground(NamedTuple):
    """The path in steps of `fine` from 0 to S_exit: `work` (W + 1,) = ∫β ds, `gravity` (W,) means of g'(i − w)·1e-3."""

    fine: float
    work: Floats
    gravity: Floats


class Transients(NamedTuple):
    """Changes of stage: `held` (C,) overpressure before, `overpressure` (C, ·) in the `steps` (C,) of `dt` seconds.

    `shared` (C, 3): the transients in the order in which they are integrated; for each the one of them, integrated
    before, with which it has its first steps in common, −1 for none, and how many these are.
    """

    held: Floats
    overpressure: Floats
    steps: Ints
    shared: Ints
    dt: float


@kernel
def land(starts, lead, ground, transients, factors, speed, ends):
    """Integrate every transient from every decision; results into `ends`.

    `starts` (R,) path of the decisions and `lead` (R,) path from there at the overpressure before the transient begins;
    `factors` (F,) friction factors; `speed` (E',), whole packs. `ends` (R, C, F, 2, E'): path until the end of the
    transient, or to S_exit, −1 for a stall; and v²/2 there.
    """
    fine, work, gravity = ground
    held, overpressure, steps, shared, dt = transients
    cells, points = gravity.shape[0], speed.shape[0]
    rise = np.empty(cells)
    for i in range(cells):
        rise[i] = work[i + 1] - work[i]
    count, numbers, longest = steps.shape[0], factors.shape[0], steps.max() + 1
    trail, gone = np.empty(count * longest * STATE), np.empty(count, np.int64)
    for n in range(ends.shape[0]):
        start, ahead = starts[n], lead[n]
        for f in range(numbers):
            for j in range(0, points, SIXTEEN):
                for k in range(count):
                    c, trunk, common = shared[k, 0], shared[k, 1], shared[k, 2]
                    begin = c * longest * STATE
                    if trunk < 0:
                        v = load16(speed, j)
                        if ahead != 0.0:
                            v = rolled_on(start, ahead, v, work, rise, gravity, fine, factors[f] * held[c])
                        put_state(trail, begin, v * 0.0 + (start + ahead), v, v * 0.0 - 1.0)
                    else:
                        common = min(common, gone[trunk])
                        from_trunk = (trunk * longest + common) * STATE
                        put_state(
                            trail, begin + common * STATE,
                            load16(trail, from_trunk), load16(trail, from_trunk + SIXTEEN),
                            load16(trail, from_trunk + 2 * SIXTEEN),
                        )  # fmt: skip
                    gone[c] = drive_on(
                        trail, begin, common, steps[c], work, rise, gravity, fine, overpressure[c], factors[f], dt
                    )
                    path, energy = end_of_drive(trail, begin + gone[c] * STATE, start + ahead, cells * fine)
                    if ahead != 0.0:
                        path = choose(path < 0.0, -1.0, path + ahead)
                    at = ((n * count + c) * numbers + f) * 2 * points
                    store(ends, at + j, path)
                    store(ends, at + points + j, energy)


@part_inline
def put_state(trail, at, s, v, left_with):
    """Write the state of a pack to flat index `at` of `trail`."""
    store(trail, at, s)
    store(trail, at + SIXTEEN, v)
    store(trail, at + 2 * SIXTEEN, left_with)


@part
def rolled_on(start, ahead, v, work, rise, gravity, fine, brake):
    """Speeds a path `ahead` of `start`, behind it if that is negative, at the constant overpressure times friction."""
    here, there = max(start, 0.0) / fine, max(start + ahead, 0.0) / fine
    i, k = min(int(here), gravity.shape[0] - 1), min(int(there), gravity.shape[0] - 1)
    done = work[k] + min(there - k, 1.0) * rise[k] - work[i] - (here - i) * rise[i]
    square = v * v + 2.0 * (gravity[i] * ahead - brake * done)
    return choose(v > 0.0, root(greatest(square, 0.0)), 0.0)


@part
def drive_on(trail, begin, first, last, work, rise, gravity, fine, overpressure, factor, dt):
    """Drive a pack on from step `first` of a transient to its step `last`; returns the step after which none moved.

    `trail`: the state of the pack after every step, from flat index `begin` on; that after `first` is known. The brake
    work is taken from the integral of β over the step's own path, so a jump of N(s) costs no accuracy; where S_exit is
    crossed inside a step, the energy there is kept. No pack is followed further than that all its speeds have left or
    stopped.
    """
    cells = gravity.shape[0]
    exit_m, scale, top = cells * fine, 1.0 / fine, cells - 1e-9
    at = begin + first * STATE
    s, v, left_with = load16(trail, at), load16(trail, at + SIXTEEN), load16(trail, at + 2 * SIXTEEN)
    for step in range(first, last):
        if not holds_anywhere((v > 0.0) & (left_with < 0.0)):
            return step
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
        put_state(trail, begin + (step + 1) * STATE, s, v, left_with)
    return last


@part
def end_of_drive(trail, at, start, exit_m):
    """(path, v²/2) of a pack in the state at flat index `at` of `trail`, driven on from `start`."""
    s, v, left_with = load16(trail, at), load16(trail, at + SIXTEEN), load16(trail, at + 2 * SIXTEEN)
    left, stopped = left_with >= 0.0, v <= 0.0
    path = choose(left, exit_m - start, choose(stopped, -1.0, s - start))
    return path, choose(left, left_with, choose(stopped, 0.0, v * v * 0.5))
