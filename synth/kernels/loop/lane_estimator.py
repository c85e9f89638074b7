"""Kernel of the estimator for passes side by side: what `tuning_tables.programs.observe` computes, for eight lanes."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import part, part_inline
from synth.kernels.vector import packs
from tuning_tables.programs.held import (
    BEGUN,
    BELIEVED,
    CROSS_COVARIANCE,
    DOUBTED,
    EXCESS,
    EXCESS_COVARIANCE,
    EXCESS_VARIANCE,
    FACTOR,
    FACTOR_COVARIANCE,
    FACTOR_VARIANCE,
    NOUGHT,
    ONE,
    PATH_M,
    READING_M_S,
    REPEATED,
    SPEED_M_S,
    SPEED_VARIANCE,
    TWO,
    UNSEEN,
)
from tuning_tables.programs.motion_filter import (
    LARGEST_EXCESS_M_S2,
    LARGEST_FACTOR,
    LEAST_EXCESS_M_S2,
    LEAST_FACTOR,
    LEAST_SPEED_M_S,
    LEAST_STEP_M,
)
from tuning_tables.programs.observe import (
    FEW_READINGS,
    GATE_SQUARED,
    LARGEST_OVERPRESSURE_KPA,
    LARGEST_SPEED_M_S,
    LARGEST_STEP_M,
)

FIELDS = 16
"""Numbers of a state of the estimator."""


class Observed(NamedTuple):
    """What the estimator knows of n passes, 0 where one begins; n = 0 without estimator.

    `state` float32 (n, 16): its own; `reached` float32 (n, 2): work of the grade and of the brake up to the path of the
    state; `at_break` (n,): the break before that; `passed_kpa` (n,): mean overpressure since the last sample.
    """

    state: NDArray[np.float32]
    reached: NDArray[np.float32]
    at_break: Ints
    passed_kpa: Floats


@part_inline
def work_until(table, place, j):
    """(work of the grade, work of the brake, break before) at the path `place`; `j`: a break before it."""
    breaks = table.breaks
    place = packs.least(packs.greatest(place, table.place_m[0]), table.place_m[breaks - 1])
    beyond = (place > packs.gather(table.place_m, j + 1)) & (j < breaks - 2)
    while packs.holds_anywhere(beyond):
        j = packs.choose(beyond, j + 1, j)
        beyond = (place > packs.gather(table.place_m, j + 1)) & (j < breaks - 2)
    here = packs.gather(table.place_m, j)
    part = (place - here) / (packs.gather(table.place_m, j + 1) - here)
    d, w = packs.gather(table.drive, j), packs.gather(table.brake, j)
    drive = d + part * (packs.gather(table.drive, j + 1) - d)
    brake = w + part * (packs.gather(table.brake, j + 1) - w)
    return drive, brake, j


class Filter(NamedTuple):
    """What the filter knows of a pack of passes: speed, factor and excess, and their covariances."""

    speed: Any
    factor: Any
    excess: Any
    speed_variance: Any
    factor_covariance: Any
    excess_covariance: Any
    factor_variance: Any
    cross_covariance: Any
    excess_variance: Any


@part_inline
def filter_of(state, at, begun):
    """The filter of the states that begin at `at`; where no pass has `begun`, a speed that can be divided by."""
    return Filter(
        packs.choose(begun, packs.gather(state, at + SPEED_M_S), ONE), packs.gather(state, at + FACTOR),
        packs.gather(state, at + EXCESS), packs.gather(state, at + SPEED_VARIANCE),
        packs.gather(state, at + FACTOR_COVARIANCE), packs.gather(state, at + EXCESS_COVARIANCE),
        packs.gather(state, at + FACTOR_VARIANCE), packs.gather(state, at + CROSS_COVARIANCE),
        packs.gather(state, at + EXCESS_VARIANCE),
    )  # fmt: skip


@part_inline
def predicted(former, table, step, drive, work_at_one):
    """(filter, speed that the brake takes at a factor of 1) `step` metres on."""
    speed = former.speed
    gained = drive - former.excess * step - former.factor * work_at_one
    mean = packs.greatest((speed + speed + gained / speed) / TWO, LEAST_SPEED_M_S)
    found = packs.greatest(speed + gained / mean, LEAST_SPEED_M_S)
    slope, effect, drag = speed / found, work_at_one / mean, step / mean
    path_part = table.path_variance / packs.greatest(step, LEAST_STEP_M)
    cross = slope * former.factor_covariance - effect * former.factor_variance - drag * former.cross_covariance
    excess = slope * former.excess_covariance - effect * former.cross_covariance - drag * former.excess_variance
    square = slope * former.speed_variance - effect * former.factor_covariance - drag * former.excess_covariance
    square = slope * square - effect * (cross - effect * path_part) - drag * excess
    now = Filter(
        found, former.factor, former.excess, packs.greatest(square, NOUGHT), cross, excess, former.factor_variance,
        former.cross_covariance, former.excess_variance,
    )  # fmt: skip
    return now, effect


@part_inline
def corrected(now, table, v):
    """The filter once the measured speed `v` is weighed in."""
    square, cross, excess = now.speed_variance, now.factor_covariance, now.excess_covariance
    total, innovation = square + table.speed_variance, v - now.speed
    gain, factor_gain, excess_gain = square / total, cross / total, excess / total
    factor, added = now.factor + factor_gain * innovation, now.excess + excess_gain * innovation
    return Filter(
        packs.greatest(now.speed + gain * innovation, LEAST_SPEED_M_S),
        packs.least(packs.greatest(factor, LEAST_FACTOR), LARGEST_FACTOR),
        packs.least(packs.greatest(added, LEAST_EXCESS_M_S2), LARGEST_EXCESS_M_S2),
        square - gain * square, cross - gain * cross, excess - gain * excess,
        packs.greatest(now.factor_variance - factor_gain * cross, NOUGHT),
        now.cross_covariance - factor_gain * excess,
        packs.greatest(now.excess_variance - excess_gain * excess, NOUGHT),
    )  # fmt: skip


@part_inline
def keep_filter(state, at, known, anew, v, table, corrects, better, now):
    """Write the filters of the `known` passes: `better` where a reading `corrects`; begun `anew` with `v`, or `now`."""
    choose = packs.choose
    speed = choose(anew, v, choose(corrects, better.speed, now.speed))
    variance = choose(anew, table.speed_variance, choose(corrects, better.speed_variance, now.speed_variance))
    factor = choose(corrects, better.factor, now.factor)
    factor_covariance = choose(corrects, better.factor_covariance, now.factor_covariance)
    excess_covariance = choose(corrects, better.excess_covariance, now.excess_covariance)
    factor_variance = choose(corrects, better.factor_variance, now.factor_variance)
    cross_covariance = choose(corrects, better.cross_covariance, now.cross_covariance)
    excess_variance = choose(corrects, better.excess_variance, now.excess_variance)
    packs.scatter(state, at + SPEED_M_S, known, speed)
    packs.scatter(state, at + FACTOR, known, choose(anew, packs.narrow(packs.eight(1.0)), factor))
    packs.scatter(state, at + EXCESS, known, choose(anew, NOUGHT, choose(corrects, better.excess, now.excess)))
    packs.scatter(state, at + SPEED_VARIANCE, known, variance)
    packs.scatter(state, at + FACTOR_COVARIANCE, known, choose(anew, NOUGHT, factor_covariance))
    packs.scatter(state, at + EXCESS_COVARIANCE, known, choose(anew, NOUGHT, excess_covariance))
    packs.scatter(state, at + FACTOR_VARIANCE, known, choose(anew, table.factor_variance, factor_variance))
    packs.scatter(state, at + CROSS_COVARIANCE, known, choose(anew, NOUGHT, cross_covariance))
    packs.scatter(state, at + EXCESS_VARIANCE, known, choose(anew, table.excess_variance, excess_variance))
    return speed, variance


@part_inline
def hear(state, at, there, table, v_m_s):
    """Take in the readings: (speed, the sensible one before, whether the last was heard, whether this is fresh)."""
    sensible = (v_m_s >= 0.0) & (v_m_s <= float(LARGEST_SPEED_M_S))
    v = packs.choose(sensible, packs.narrow(v_m_s), NOUGHT)
    reading, repeats = packs.gather(state, at + READING_M_S), packs.gather(state, at + REPEATED)
    was_heard = (packs.gather(state, at + UNSEEN) <= NOUGHT) | (repeats > NOUGHT)
    repeated = packs.choose(sensible & (v >= reading) & (v <= reading), repeats + ONE, NOUGHT)
    packs.scatter(state, at + READING_M_S, there, packs.choose(sensible, v, reading))
    packs.scatter(state, at + REPEATED, there, repeated)
    return v, reading, was_heard, sensible & (repeated + repeated + repeated < table.frozen)


@part_inline
def work_done(observed, table, i, begun, s_m):
    """(path, way from the last sample, work of grade and brake on it, both up to the path, break before)."""
    at = i * FIELDS
    before = packs.choose(begun, packs.gather(observed.state, at + PATH_M), table.place_m[0])
    farthest = packs.choose(begun, before + LARGEST_STEP_M, table.place_m[table.breaks - 1])
    s = packs.choose((packs.wide(before) <= s_m) & (s_m <= packs.wide(farthest)), packs.narrow(s_m), before)
    d, w, j = work_until(table, s, packs.gather(observed.at_break, i))
    drive, brake = d - packs.gather(observed.reached, i * 2), w - packs.gather(observed.reached, i * 2 + 1)
    return s, s - before, drive, brake, d, w, j


@part
def estimated(observed, table, there, i, s_m, v_m_s):
    """The speeds to compare of the passes `i` of a pack, float64; `there`: the lanes that have a pass.

    What the grade and the brake did up to the last sample is remembered, not worked out anew. Not inlined: laws without
    an estimator would pay for it by 15 %.
    """
    state, at = observed.state, i * FIELDS
    kpa = packs.gather(observed.passed_kpa, i)
    p = packs.choose((kpa >= 0.0) & (kpa <= float(LARGEST_OVERPRESSURE_KPA)), packs.narrow(kpa), NOUGHT)
    begun = packs.gather(state, at + BEGUN) > NOUGHT
    v, reading, was_heard, fresh = hear(state, at, there, table, v_m_s)
    s, step, drive, brake, d, w, j = work_done(observed, table, i, begun, s_m)
    former, believed = filter_of(state, at, begun), packs.gather(state, at + BELIEVED)
    now, effect = predicted(former, table, step, drive, p * brake)
    doubts, moving, innovation = packs.gather(state, at + DOUBTED), v >= LEAST_SPEED_M_S, v - now.speed
    leap, most = (v - reading) - (now.speed - former.speed), table.leap_m_s + effect
    leaps = (leap > most) | (leap < NOUGHT - most)
    strange = (was_heard & leaps) | (packs.opposite(was_heard) & packs.opposite(moving))
    far = innovation * innovation > GATE_SQUARED * (now.speed_variance + table.speed_variance)
    doubted = begun & fresh & far & (strange | (doubts > NOUGHT))
    counted = packs.choose(moving & packs.opposite(leaps), doubts + ONE, ONE)
    few = (believed < FEW_READINGS) | (counted >= table.doubted)
    corrects = begun & fresh & packs.opposite(doubted)
    anew = moving & ((packs.opposite(begun) & fresh) | (doubted & few))
    known, seen = there & (begun | anew), corrects | anew
    better = corrected(now, table, v)
    found, variance = keep_filter(state, at, known, anew, v, table, corrects, better, now)
    packs.scatter(state, at + BEGUN, known, packs.narrow(packs.eight(1.0)))
    packs.scatter(state, at + PATH_M, known, s)
    packs.scatter(state, at + UNSEEN, there, packs.choose(seen, NOUGHT, packs.gather(state, at + UNSEEN) + ONE))
    believed = packs.choose(anew, ONE, packs.choose(corrects, believed + ONE, believed))
    packs.scatter(state, at + BELIEVED, known, believed)
    packs.scatter(state, at + DOUBTED, known, packs.choose(seen, NOUGHT, packs.choose(doubted, counted, doubts)))
    packs.scatter(observed.reached, i * 2, known, d)
    packs.scatter(observed.reached, i * 2 + 1, known, w)
    packs.scatter(observed.at_break, i, known, j)
    answer = packs.greatest(found - table.caution * packs.greatest(variance - table.lost_variance, NOUGHT), NOUGHT)
    return packs.wide(packs.choose(begun | anew, answer, NOUGHT - ONE))
