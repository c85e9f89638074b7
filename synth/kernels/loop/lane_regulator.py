"""Kernel of the regulator for passes side by side: what `regulator` says, for eight lanes at a time.

The rule itself is only asked where it has a command to give: its branches are dear, and commands are few.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import part_inline
from synth.kernels.loop.drive import Pieces
from synth.kernels.loop.lane_estimator import Observed, estimated
from synth.kernels.loop.lane_places import (
    BEFORE,
    LANES,
    LEFT_S,
    PASS,
    PIECE,
    SAMPLE,
    SLOPE,
    STAGE,
    SWITCHINGS,
    S,
    V,
    Work,
)
from synth.kernels.loop.regulator import Rule, Sensor, admitted, stage_by_lines, stage_by_table
from synth.kernels.vector import packs


@part_inline
def listen(
    work: Work, count: int, pieces: Pieces, sensor: Sensor, law: Rule, noise_z: NDArray[np.float32], observed: Observed
) -> int:
    """Measured speed of the first `count` lanes of `waiting`; returns how many have a command, those in `told`."""
    x, n, waiting = work.floats, work.ints, work.waiting
    told = 0
    for k in range(0, count, packs.EIGHT):
        lane = packs.load8(waiting, k)
        s, stage = packs.gather(x, lane + S), packs.gather(n, lane + STAGE)
        read = measured(x, n, lane, sensor, noise_z)
        speed, there, piece = read, lane < LANES, packs.gather(n, lane + PIECE)
        if law.table.breaks > 0:
            i = packs.gather(n, lane + PASS)
            speed = estimated(observed, law.table, there, i, s, read)
            speed = packs.choose(piece < pieces.resting, speed, math.nan)  # compared, and noted, only at rest
            packs.scatter(observed.passed_kpa, i, there, packs.gather(pieces.mean_kpa, piece))  # if without a command
        packs.store(work.read, k, speed)
        if law.table.stages > 0:
            speaks = speaks_by_table(law.table, stage, s, speed, 0.0, 0.0)
        else:
            speed = foretold(x, lane, speed, read, sensor, law)
            speaks = speaks_by_lines(law, stage, s, speed)
        if law.lead_s != 0.0 or law.table.breaks > 0:
            # These look at the sensor within a chain, too, but there is no command there.
            speaks = there & speaks & (piece < pieces.resting)
        packs.keep(work.heard, told, speaks, speed)
        told += packs.keep(work.told, told, speaks, lane)
    return told


@part_inline
def measured(x, n, lane, sensor, noise_z):
    """`regulator.measure` for a pack of lanes."""
    width = noise_z.shape[1]
    sample = packs.gather(n, lane + SAMPLE)
    while packs.holds_anywhere(sample >= width):
        sample = packs.choose(sample >= width, sample - width, sample)
    z = packs.wide(packs.gather(noise_z, packs.gather(n, lane + PASS) * width + packs.greatest(sample, 0)))
    value = packs.gather(x, lane + V) + sensor.noise_m_s * z
    if sensor.resolution_m_s > 0.0:
        value = packs.nearest(value / sensor.resolution_m_s) * sensor.resolution_m_s
    return packs.choose(value < 0.0, 0.0, value)


@part_inline
def foretold(x, lane, speed, sloping, sensor, law):
    """The speed that lines are compared with: `speed` and, with a lead, that times the slope of the speed `sloping`."""
    if law.lead_s != 0.0:
        speed = speed + law.lead_s * slope(x, lane, sloping, sensor.period_s, law.filter_s)
    return speed


@part_inline
def slope(x, lane, speed, period_s, filter_s):
    """Filtered slope of the measured speed, noted for the next sample."""
    change = speed - packs.gather(x, lane + BEFORE)
    past = packs.gather(x, lane + SLOPE)
    known = change == change  # neither at the first sample nor beside a missing reading
    gain = period_s / (period_s + filter_s)
    new = packs.choose(known, past + gain * (change / period_s - past), past)
    packs.scatter(x, lane + SLOPE, known, new)
    packs.scatter(x, lane + BEFORE, lane < LANES, speed)
    return new


@part_inline
def speaks_by_table(table, stage, s_m, v_m_s, lower_rise, upper_rise):
    """Whether the table has a command, by the arithmetic of `programs.decide`; a line that is not there is NaN.

    `lower_rise`, `upper_rise` float32: what the pressure adds to the lines; numbers for all lanes, or packs of them.
    For readings within the numbers of float32, which is all that the loop has; NaN: no command.
    """
    s, v = packs.narrow(s_m), packs.narrow(v_m_s)
    s = packs.least(packs.greatest(s, table.path_min_m), table.path_max_m)
    terms = table.coefficient.shape[2]
    below, above = stage * (2 * terms), stage * (2 * terms) + terms
    lower = packs.gather(table.coefficient, below + (terms - 1))
    upper = packs.gather(table.coefficient, above + (terms - 1))
    for power in range(terms - 2, -1, -1):
        lower = lower * s + packs.gather(table.coefficient, below + power)
        upper = upper * s + packs.gather(table.coefficient, above + power)
    return (v < lower + lower_rise) | (v > upper + upper_rise)


@part_inline
def speaks_by_lines(law, stage, s, v):
    """Whether `regulator.line_decision` is not 0."""
    place = (s - law.start_m) / law.spacing_m
    node = packs.least(packs.whole(place), law.lower.shape[1] - 2)
    part = place - packs.fraction(node)
    at = stage * law.lower.shape[1] + node
    lower, upper = packs.gather(law.lower, at), packs.gather(law.upper, at)
    below = v < lower + part * (packs.gather(law.lower, at + 1) - lower)
    above = v > upper + part * (packs.gather(law.upper, at + 1) - upper)
    return below | above


@part_inline
def regulate(x: Floats, n: Ints, lane: int, speed_m_s: float, pieces: Pieces, law: Rule, observed: Observed) -> None:
    """What the regulator does where it has a command."""
    s, stage, top = x[S + lane], n[STAGE + lane], pieces.command.shape[1] - 1
    if law.table.stages > 0:
        wanted = stage_by_table(law.table, stage, s, speed_m_s, math.nan)
    else:
        wanted = stage_by_lines(
            law.lower, law.upper, law.start_m, law.spacing_m, law.farthest, stage, top, s, speed_m_s
        )
    wanted = admitted(stage, wanted, s, pieces.entrance_stage)
    if wanted != stage:
        first = pieces.command[np.uint64(n[PIECE + lane] - 1), np.uint64(wanted)]
        n[STAGE + lane], n[PIECE + lane] = wanted, first
        n[SWITCHINGS + lane] += 1
        x[LEFT_S + lane] = pieces.duration_s[first]
        if law.table.breaks > 0:
            observed.passed_kpa[n[PASS + lane]] = pieces.mean_kpa[first]
