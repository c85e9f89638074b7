"""Switching lines from what commands save, and with which chance a line has each command given.

At a decision the gain of a command over holding is averaged over what the regulator does not see, and over the error of
the measured speed. T targets stand side by side, whole packs of eight.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import part
from synth.kernels.sweep.commands import normal_cdf
from synth.kernels.sweep.thresholds import find_lines
from synth.kernels.vector.packs import EIGHT, choose, load8, magnitude, store


class Readings(NamedTuple):
    """`reading` (E,): what is measured of the speeds, with errors of std `noise`; `heard` (R, T): probability that
    there is one at a decision, else the stage is held.

    `smear_start` (E,), `smear` (E, W): probability of true speeds given a measured one.
    """

    reading: Floats
    noise: float
    heard: Floats
    smear_start: Ints
    smear: NDArray[Any]


class Gains(NamedTuple):
    """What commands save at one node: `saved` (C, K + 1, E·T), `possible` (2, K + 1) stages down and up."""

    saved: NDArray[Any]
    possible: Ints


class Drawing(NamedTuple):
    """Memory to draw lines with: `best`, `chosen` as of `find_lines`; `chance` (C, E·T), `undecided` (E,)."""

    best: Floats
    chosen: Ints
    chance: NDArray[Any]
    undecided: NDArray[np.bool_]


@part
def add_gains(hold, changed, weight, rounding, width, gain):
    """Add the cost saved by a change, times `weight`, to `gain` (E·T,).

    What is less than the part `rounding` of the cost itself may be saved by rounding alone, and is not added.
    """
    for at in range(width, gain.shape[0], EIGHT):
        cost = load8(hold, at)
        saved = cost - load8(changed, at)
        counted = choose(magnitude(saved) > cost * rounding, saved, 0.0)
        store(gain, at, load8(gain, at) + counted * weight)


@part
def draw_lines(decision, k, gains, readings, tolerance, spent, drawing, gain, lines):
    """Gains and lines of stage `k` at a decision, and with which chance each command is given."""
    width = spent.shape[0] // readings.reading.shape[0]
    for command in range(lines.shape[0]):
        spread(gains.saved[command, k], readings.smear_start, readings.smear, width, spent)
        apart(spent, width, gain[command, decision, k])
    here = lines[:, decision, k]
    find_lines(
        gain[:, decision, k], gains.possible[:, k], readings.reading, tolerance, drawing.best, drawing.chosen, here
    )
    command_chances(here, readings, decision, width, drawing.chance, drawing.undecided)


@part
def spread(gain, start, weights, width, out):
    """`out` (E·T,) = `gain` averaged over the true speeds behind every measured speed."""
    for j in range(start.shape[0]):
        for t in range(0, width, EIGHT):
            found = load8(gain, start[j] * width + t) * weights[j, 0]
            for m in range(1, weights.shape[1]):
                found = found + load8(gain, (start[j] + m) * width + t) * weights[j, m]
            store(out, j * width + t, found)


@part
def apart(row, width, out):
    """`row` (E·T,), with targets padded, as `out` (T, E)."""
    for t in range(out.shape[0]):
        for j in range(out.shape[1]):
            out[t, j] = row[j * width + t]


@part
def command_chances(lines, readings, decision, width, out, undecided):
    """Probability of each command at every true speed and target, `out` (C, E·T); `lines` (C, T) in readings.

    `undecided` (E,): whether any target may get another command than holding.
    """
    reading, noise, heard = readings.reading, readings.noise, readings.heard[decision]
    out[:] = 0.0
    for j in range(reading.shape[0]):
        undecided[j] = False
        for t in range(lines.shape[1]):
            further_down, further_up = 0.0, 0.0
            for command in range(lines.shape[0] - 2, -1, -2):
                down = normal_cdf((lines[command, t] - reading[j]) / noise)
                up = normal_cdf((reading[j] - lines[command + 1, t]) / noise)
                out[command, j * width + t] = (down - further_down) * heard[t]
                out[command + 1, j * width + t] = (up - further_up) * heard[t]
                further_down, further_up = down, up
            undecided[j] = undecided[j] or (heard[t] > 0.0 and (further_down > 0.0 or further_up > 0.0))
