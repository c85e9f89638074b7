"""Which speed to decide with: an estimator of speed, friction and resistance, a few multiplications a sample, no root.

A measured speed is noisy, and some readings are missing or false. But how much a cut slows down between two samples is
known, save for its friction and its running resistance. The estimator carries the speed v, the friction factor ξ and
the excess resistance a of the cut, with their covariance, from sample to sample (extended Kalman filter), and the lines
of a table that was tuned for it are compared with its speed:

    predict   Δe = ΔD - a Δs - ξ p ΔW      the work of grade and mean resistance, excess, and brake under p
              v' = v + 2 Δe / (v + v + Δe/v)
    doubt     a reading far from v' that leapt there; one that repeats itself a third as often as a frozen sensor
    correct   v, ξ, a by the measured speed, weighted by the covariance

D(s) and W(s) are given as broken lines. The path's own friction noise (standard deviation σ_η, correlation length ℓ)
enters as white noise of the same work, variance 2 σ_η² ℓ / Δs.

All arithmetic is float32, one rounding an operation, in the order written. A reading that is missing or doubted
corrects nothing: the estimate goes on by the model alone, and the state counts for how many samples it has done so.
Once the standard deviation of the speed is beyond a limit, the answer is cautious: lower than the estimate, the more
the less is known, so that a cut that nobody sees does not stop in the retarder. `alarms` tells.
"""

from __future__ import annotations

from typing import Annotated, Any, Final

import numpy as np

from tuning_tables.language.records import flag, real
from tuning_tables.programs.held import (
    BEGUN,
    BELIEVED,
    DOUBTED,
    MINUS_ONE,
    NOUGHT,
    ONE,
    PATH_M,
    READING_M_S,
    REPEATED,
    SPEED_M_S,
    SPEED_VARIANCE,
    UNSEEN,
    Answer,
    Estimate,
    LineTable,
    MeasuredSpeed,
    Overpressure,
    Path,
    PathReading,
    Speed,
    f32,
)
from tuning_tables.programs.motion_filter import LEAST_SPEED_M_S, begin_at, correct, predict

LARGEST_SPEED_M_S: Final = np.float32(40.0)
LARGEST_OVERPRESSURE_KPA: Final = np.float32(2000.0)
LARGEST_STEP_M: Final = np.float32(20.0)
"""Readings beyond these cannot be true, and one of them would spoil the state for the rest of the pass."""

GATE: Final = 5.0
"""Standard deviations of an innovation, beyond which a reading that leapt is doubted."""
GATE_SQUARED: Final = np.float32(GATE**2)

FEW_READINGS: Final = np.float32(3.0)
"""As long as fewer were believed, a doubted one begins the estimate anew: the first ones may have been the false."""


def follow(
    table: LineTable,
    estimate: Estimate,
    s: Path,
    kpa: Annotated[Any, real("overpressure, kPa")],
    v: Speed,
    reading: Annotated[Any, real("the sensible one before, m/s")],
    was_heard: Annotated[bool, flag("the reading before this one was a speed")],
    is_fresh: Annotated[bool, flag("this one is a speed, and not that of a frozen sensor")],
) -> Answer:
    """Go on to path s and weigh in the reading. 0: it is not believed; 1: it is; 2: the estimate begins anew."""
    how = 0
    former = estimate[SPEED_M_S]
    effect = predict(table, estimate, s, kpa)
    if is_fresh:
        innovation = v - estimate[SPEED_M_S]
        square = innovation * innovation
        bound = GATE_SQUARED * (estimate[SPEED_VARIANCE] + table.speed_variance)
        # A reading leaps where neither the noise of two readings nor all that the brake does explains its change.
        leap = v - reading - (estimate[SPEED_M_S] - former)
        most = table.leap_m_s + effect
        least = NOUGHT - most
        leaps = leap > most or leap < least
        strange = leaps
        if not was_heard:
            strange = v < LEAST_SPEED_M_S
        if square > bound and (strange or estimate[DOUBTED] > NOUGHT):
            if v >= LEAST_SPEED_M_S and not leaps:
                estimate[DOUBTED] = estimate[DOUBTED] + ONE
            else:
                estimate[DOUBTED] = ONE
            if v >= LEAST_SPEED_M_S and (estimate[BELIEVED] < FEW_READINGS or estimate[DOUBTED] >= table.doubted):
                how = 2
        else:
            correct(table, estimate, v)
            how = 1
    return how


def told(table: LineTable, estimate: Estimate) -> Answer:
    """The speed to decide with: a cut whose speed is known too badly is taken for slower than it seems."""
    speed = MINUS_ONE
    if estimate[BEGUN] > NOUGHT:
        beyond = max(estimate[SPEED_VARIANCE] - table.lost_variance, NOUGHT)
        speed = max(estimate[SPEED_M_S] - table.caution * beyond, NOUGHT)
    return speed


def observe(
    table: LineTable, estimate: Estimate, s_m: PathReading, v_m_s: MeasuredSpeed, overpressure_kpa: Overpressure
) -> Answer:
    """Take one sample into the state: the speed to decide with, m/s; -1 as long as no speed was measured.

    To be called at every sample, also while a change of stage is under way. What cannot be true changes little: a speed
    above 40 m/s, negative or not finite corrects nothing, such an overpressure counts as 0, a path that goes back, or
    on by more than 20 m, as no movement. A cut begins with a reading of the least speed or more. A reading is doubted,
    and corrects nothing, if it is far from the estimate and leapt there: more than the noise of two readings and all
    that the brake does are off between it and the last; after a missing one, if it is below the least speed. Doubt ends
    with a reading near the estimate. `unseen` of the estimate counts the samples since the last reading that was
    believed; the supervision compares it with a limit of its own, and acts.
    """
    observed = v_m_s
    # No comparison with a NaN is true.
    is_sensible = NOUGHT <= v_m_s <= LARGEST_SPEED_M_S
    is_seen = is_sensible
    if table.breaks > 0:
        is_seen = False
        observed = MINUS_ONE
    # The size is looked at, too, so that no index leaves a damaged table.
    if 2 <= table.breaks <= table.place_m.shape[0]:
        v = NOUGHT
        if is_sensible:
            v = f32(v_m_s)
        kpa = NOUGHT
        if NOUGHT <= overpressure_kpa <= LARGEST_OVERPRESSURE_KPA:
            kpa = f32(overpressure_kpa)
        is_begun = estimate[BEGUN] > NOUGHT
        before = table.place_m[0]
        farthest = table.place_m[table.breaks - 1]
        if is_begun:
            before = estimate[PATH_M]
            farthest = before + LARGEST_STEP_M
        s = before
        if before <= s_m <= farthest:
            s = f32(s_m)
        reading = estimate[READING_M_S]
        was_heard = estimate[UNSEEN] <= NOUGHT or estimate[REPEATED] > NOUGHT
        if is_sensible and reading <= v <= reading:
            estimate[REPEATED] = estimate[REPEATED] + ONE
        else:
            estimate[REPEATED] = NOUGHT
        if is_sensible:
            estimate[READING_M_S] = v
        is_fresh = is_sensible and estimate[REPEATED] + estimate[REPEATED] + estimate[REPEATED] < table.frozen
        how = 0
        if is_begun:
            how = follow(table, estimate, s, kpa, v, reading, was_heard, is_fresh)
        elif is_fresh and v >= LEAST_SPEED_M_S:
            how = 2
        if how == 2:
            begin_at(table, estimate, s, v)
        is_seen = how > 0
        observed = told(table, estimate)
    if is_seen:
        estimate[UNSEEN] = NOUGHT
    else:
        estimate[UNSEEN] = estimate[UNSEEN] + ONE
    return observed
