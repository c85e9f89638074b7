"""Kernel of the estimator for passes side by side: what `tuning_tables.programs.observe` computes, for eight lanes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import part, part_inline
from synth.kernels.vector import packs
from tuning_tables.programs.motion_filter import (
    LARGEST_EXCESS_M_S2,
    LARGEST_FACTOR,
    LEAST_FACTOR,
    LEAST_SPEED_M_S,
    LEAST_STEP_M,
)
from tuning_tables.programs.numbers import NOUGHT, ONE, TWO
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


@part
def estimated(observed, table, there, i, s_m, v_m_s):
    """The speeds to compare of the passes `i` of a pack, float64; `there`: the lanes that have a pass.

    What the grade and the brake did up to the last sample is remembered, not worked out anew. Not inlined: laws without
    an estimator would pay for it by 15 %.
    """
    nought, one, two, least_speed = NOUGHT, ONE, TWO, LEAST_SPEED_M_S
    state, at = observed.state, i * FIELDS
    sensible = (v_m_s >= 0.0) & (v_m_s <= float(LARGEST_SPEED_M_S))
    v = packs.choose(sensible, packs.narrow(v_m_s), nought)
    kpa = packs.gather(observed.passed_kpa, i)
    p = packs.choose((kpa >= 0.0) & (kpa <= float(LARGEST_OVERPRESSURE_KPA)), packs.narrow(kpa), nought)
    begun = packs.gather(state, at) > nought
    before = packs.choose(begun, packs.gather(state, at + 1), table.place_m[0])
    farthest = packs.choose(begun, before + LARGEST_STEP_M, table.place_m[table.breaks - 1])
    s = packs.choose((packs.wide(before) <= s_m) & (s_m <= packs.wide(farthest)), packs.narrow(s_m), before)
    reading, unseen, repeats = packs.gather(state, at + 12), packs.gather(state, at + 11), packs.gather(state, at + 13)
    again = sensible & (v >= reading) & (v <= reading)
    heard = (unseen <= nought) | (repeats > nought)
    repeated = packs.choose(again, repeats + one, nought)
    packs.scatter(state, at + 12, there, packs.choose(sensible, v, reading))
    packs.scatter(state, at + 13, there, repeated)
    fresh = sensible & (repeated + repeated + repeated < table.frozen)
    moving = v >= least_speed
    speed, factor = packs.choose(begun, packs.gather(state, at + 2), one), packs.gather(state, at + 3)
    excess, c5, c6 = packs.gather(state, at + 4), packs.gather(state, at + 5), packs.gather(state, at + 6)
    c7, c8, c9 = packs.gather(state, at + 7), packs.gather(state, at + 8), packs.gather(state, at + 9)
    c10, believings = packs.gather(state, at + 10), packs.gather(state, at + 14)
    doubts = packs.gather(state, at + 15)
    d, w, j = work_until(table, s, packs.gather(observed.at_break, i))
    drive, brake = d - packs.gather(observed.reached, i * 2), w - packs.gather(observed.reached, i * 2 + 1)
    step, work_at_one = s - before, p * brake
    gained = drive - excess * step - factor * work_at_one
    mean = packs.greatest((speed + speed + gained / speed) / two, least_speed)
    predicted = packs.greatest(speed + gained / mean, least_speed)
    slope, effect, drag = speed / predicted, work_at_one / mean, step / mean
    path_variance = table.path_variance / packs.greatest(step, LEAST_STEP_M)
    p12 = slope * c6 - effect * c8 - drag * c9
    p13 = slope * c7 - effect * c9 - drag * c10
    p11 = slope * (slope * c5 - effect * c6 - drag * c7)
    p11 = packs.greatest(p11 - effect * (p12 - effect * path_variance) - drag * p13, nought)
    total, innovation = p11 + table.speed_variance, v - predicted
    leap, most = (v - reading) - (predicted - speed), table.leap_m_s + effect
    leaps = (leap > most) | (leap < nought - most)
    strange = (heard & leaps) | (packs.opposite(heard) & packs.opposite(moving))
    far = innovation * innovation > GATE_SQUARED * total
    doubted = begun & fresh & far & (strange | (doubts > nought))
    counted = packs.choose(moving & packs.opposite(leaps), doubts + one, one)
    few = (believings < FEW_READINGS) | (counted >= table.doubted)
    corrects = begun & fresh & packs.opposite(doubted)
    anew = moving & ((packs.opposite(begun) & fresh) | (doubted & few))
    gain, factor_gain, excess_gain = p11 / total, p12 / total, p13 / total
    found = packs.choose(corrects, packs.greatest(predicted + gain * innovation, least_speed), predicted)
    found = packs.choose(anew, v, found)
    likely = packs.least(packs.greatest(factor + factor_gain * innovation, LEAST_FACTOR), LARGEST_FACTOR)
    bound = LARGEST_EXCESS_M_S2
    excessive = packs.least(packs.greatest(excess + excess_gain * innovation, nought - bound), bound)
    ones = packs.narrow(packs.eight(1.0))
    known = there & (begun | anew)
    packs.scatter(state, at, known, ones)
    packs.scatter(state, at + 1, known, s)
    packs.scatter(state, at + 2, known, found)
    packs.scatter(state, at + 3, known, packs.choose(anew, ones, packs.choose(corrects, likely, factor)))
    packs.scatter(state, at + 4, known, packs.choose(anew, nought, packs.choose(corrects, excessive, excess)))
    variance = packs.choose(anew, table.speed_variance, packs.choose(corrects, p11 - gain * p11, p11))
    packs.scatter(state, at + 5, known, variance)
    c6 = packs.choose(anew, nought, packs.choose(corrects, p12 - gain * p12, p12))
    c7 = packs.choose(anew, nought, packs.choose(corrects, p13 - gain * p13, p13))
    packs.scatter(state, at + 6, known, c6)
    packs.scatter(state, at + 7, known, c7)
    c8 = packs.choose(corrects, packs.greatest(c8 - factor_gain * p12, nought), c8)
    c9 = packs.choose(corrects, c9 - factor_gain * p13, c9)
    c10 = packs.choose(corrects, packs.greatest(c10 - excess_gain * p13, nought), c10)
    packs.scatter(state, at + 8, known, packs.choose(anew, table.factor_variance, c8))
    packs.scatter(state, at + 9, known, packs.choose(anew, nought, c9))
    packs.scatter(state, at + 10, known, packs.choose(anew, table.excess_variance, c10))
    unseen = packs.choose(corrects | anew, nought, unseen + one)
    packs.scatter(state, at + 11, there, unseen)
    believings = packs.choose(anew, one, packs.choose(corrects, believings + one, believings))
    packs.scatter(state, at + 14, known, believings)
    doubts = packs.choose(corrects | anew, nought, packs.choose(doubted, counted, doubts))
    packs.scatter(state, at + 15, known, doubts)
    packs.scatter(observed.reached, i * 2, known, d)
    packs.scatter(observed.reached, i * 2 + 1, known, w)
    packs.scatter(observed.at_break, i, known, j)
    beyond = packs.greatest(variance - table.lost_variance, nought)
    answer = packs.greatest(found - table.caution * beyond, nought)
    return packs.wide(packs.choose(begun | anew, answer, nought - one))
