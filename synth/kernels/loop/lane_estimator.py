"""Kernel of the estimator for passes side by side: what `tuning_tables.estimator.observe` computes, for eight lanes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synth.kernels.loop.lane_places import Floats, Ints
from synth.kernels.vector import packs
from synth.kernels.vector.borrowing import borrowing, borrowing_inline

FIELDS = 8
"""Numbers of a state of the estimator; the last counts samples without a credible speed, and is not followed here."""


class Observed(NamedTuple):
    """What the estimator knows of n passes, 0 where one begins; n = 0 without estimator.

    `state` float32 (n, 8): its own; `reached` float32 (n, 2): work of the grade and of the brake up to the path of the
    state; `at_break` (n,): the break before that; `passed_kpa` (n,): mean overpressure since the last sample.
    """

    state: NDArray[np.float32]
    reached: NDArray[np.float32]
    at_break: Ints
    passed_kpa: Floats


@borrowing_inline
def work_until(work, place, j):
    """(work of the grade, work of the brake, break before) at the path `place`; `j`: a break before it."""
    breaks = work.shape[1]
    place = packs.least(packs.greatest(place, work[0, 0]), work[0, breaks - 1])
    beyond = (place > packs.gather(work, j + 1)) & (j < breaks - 2)
    while packs.holds_anywhere(beyond):
        j = packs.choose(beyond, j + 1, j)
        beyond = (place > packs.gather(work, j + 1)) & (j < breaks - 2)
    here = packs.gather(work, j)
    part = (place - here) / (packs.gather(work, j + 1) - here)
    d, w = packs.gather(work, j + breaks), packs.gather(work, j + 2 * breaks)
    drive = d + part * (packs.gather(work, j + (breaks + 1)) - d)
    brake = w + part * (packs.gather(work, j + (2 * breaks + 1)) - w)
    return drive, brake, j


@borrowing
def estimated(observed, parameters, work, there, i, s_m, v_m_s):
    """The estimated speeds of the passes `i` of a pack, float64; `there`: the lanes that have a pass.

    What the grade and the brake did up to the last sample is remembered, not worked out anew. Not inlined: laws without
    an estimator would pay for it by 15 %.
    """
    nought, one, two, least_speed = parameters[7], parameters[8], parameters[9], parameters[5]
    state, at = observed.state, i * FIELDS
    credible = (v_m_s >= 0.0) & (v_m_s <= float(parameters[10]))
    v = packs.choose(credible, packs.narrow(v_m_s), nought)
    kpa = packs.gather(observed.passed_kpa, i)
    p = packs.choose((kpa >= 0.0) & (kpa <= float(parameters[11])), packs.narrow(kpa), nought)
    begun = packs.gather(state, at) > nought
    begins = packs.opposite(begun) & credible
    before = packs.choose(begun, packs.gather(state, at + 1), work[0, 0])
    farthest = packs.choose(begun, before + parameters[12], work[0, work.shape[1] - 1])
    s = packs.choose((packs.wide(before) <= s_m) & (s_m <= packs.wide(farthest)), packs.narrow(s_m), before)
    speed, factor = packs.choose(begun, packs.gather(state, at + 2), one), packs.gather(state, at + 3)
    s4, s5, s6 = packs.gather(state, at + 4), packs.gather(state, at + 5), packs.gather(state, at + 6)
    d, w, j = work_until(work, s, packs.gather(observed.at_break, i))
    drive, brake = d - packs.gather(observed.reached, i * 2), w - packs.gather(observed.reached, i * 2 + 1)
    work_at_one = p * brake
    gained = drive - factor * work_at_one
    mean = packs.greatest((speed + speed + gained / speed) / two, least_speed)
    predicted = packs.greatest(speed + gained / mean, least_speed)
    slope, effect = speed / predicted, work_at_one / mean
    path_variance = parameters[2] / packs.greatest(s - before, parameters[6])
    p11 = slope * slope * s4 - two * slope * effect * s5 + effect * effect * (s6 + path_variance)
    p12 = slope * s5 - effect * s6
    total = p11 + parameters[0]
    gain, factor_gain, surprise = p11 / total, p12 / total, v - predicted
    corrected = packs.greatest(predicted + gain * surprise, least_speed)
    likely = packs.least(packs.greatest(factor + factor_gain * surprise, parameters[3]), parameters[4])
    less = packs.greatest(s6 - factor_gain * p12, nought)
    found = packs.choose(credible, corrected, predicted)
    found = packs.choose(begins, packs.greatest(v, least_speed), found)
    ones = packs.narrow(packs.eight(1.0))
    known = there & (begun | credible)
    packs.scatter(state, at, known, ones)
    packs.scatter(state, at + 1, known, s)
    packs.scatter(state, at + 2, known, found)
    packs.scatter(state, at + 3, known, packs.choose(begins, ones, packs.choose(credible, likely, factor)))
    p11, p12 = packs.choose(credible, p11 - gain * p11, p11), packs.choose(credible, p12 - gain * p12, p12)
    packs.scatter(state, at + 4, known, packs.choose(begins, parameters[0], p11))
    packs.scatter(state, at + 5, known, packs.choose(begins, nought, p12))
    s6 = packs.choose(credible, less, s6)
    packs.scatter(state, at + 6, known, packs.choose(begins, parameters[1], s6))
    packs.scatter(observed.reached, i * 2, known, d)
    packs.scatter(observed.reached, i * 2 + 1, known, w)
    packs.scatter(observed.at_break, i, known, j)
    return packs.wide(packs.choose(begun | credible, found, nought - one))
