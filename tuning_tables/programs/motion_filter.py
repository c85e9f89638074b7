"""The filter of `observe`: how speed, friction and resistance of a cut go on, and how a reading corrects them."""

from __future__ import annotations

from typing import Annotated, Any, Final

import numpy as np

from tuning_tables.language.records import real
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
    Answer,
    Estimate,
    LineTable,
    Path,
    Speed,
)

LEAST_SPEED_M_S: Final = np.float32(0.2)
LEAST_STEP_M: Final = np.float32(0.001)
LEAST_FACTOR: Final = np.float32(0.3)
LARGEST_FACTOR: Final = np.float32(1.9)
"""Beyond the default floor of ξ_cut, and six standard deviations at a CV of 0.15."""

LARGEST_EXCESS_M_S2: Final = np.float32(0.5)
LEAST_EXCESS_M_S2: Final = np.float32(-0.5)


def begin_cut(estimate: Estimate) -> None:
    """Forget the last cut: to be called once for each cut before its first sample."""
    estimate[BEGUN] = NOUGHT
    estimate[PATH_M] = NOUGHT
    estimate[SPEED_M_S] = NOUGHT
    estimate[FACTOR] = NOUGHT
    estimate[EXCESS] = NOUGHT
    estimate[SPEED_VARIANCE] = NOUGHT
    estimate[FACTOR_COVARIANCE] = NOUGHT
    estimate[EXCESS_COVARIANCE] = NOUGHT
    estimate[FACTOR_VARIANCE] = NOUGHT
    estimate[CROSS_COVARIANCE] = NOUGHT
    estimate[EXCESS_VARIANCE] = NOUGHT
    estimate[UNSEEN] = NOUGHT
    estimate[READING_M_S] = NOUGHT
    estimate[REPEATED] = NOUGHT
    estimate[BELIEVED] = NOUGHT
    estimate[DOUBTED] = NOUGHT


def work_until(table: LineTable, s: Path) -> Answer:
    """What grade and brake have done from the first break to path s."""
    last = table.breaks - 1
    place = min(max(s, table.place_m[0]), table.place_m[last])
    j = 0
    k = 1
    while k < last:
        if place > table.place_m[k]:
            j = k
            k = k + 1
        else:
            k = last
    part = (place - table.place_m[j]) / (table.place_m[j + 1] - table.place_m[j])
    drive = table.drive[j] + part * (table.drive[j + 1] - table.drive[j])
    brake = table.brake[j] + part * (table.brake[j + 1] - table.brake[j])
    return drive, brake


def predict(table: LineTable, estimate: Estimate, s: Path, kpa: Annotated[Any, real("overpressure, kPa")]) -> Answer:
    """Carry speed and covariances on to path s; returns the speed that the brake takes at a factor of 1."""
    v = estimate[SPEED_M_S]
    drive, brake = work_until(table, s)
    drive_before, brake_before = work_until(table, estimate[PATH_M])
    way = s - estimate[PATH_M]
    work_at_one = kpa * (brake - brake_before)
    gained = drive - drive_before - estimate[EXCESS] * way
    gained = gained - estimate[FACTOR] * work_at_one
    mean = max((v + v + gained / v) / TWO, LEAST_SPEED_M_S)
    predicted = max(v + gained / mean, LEAST_SPEED_M_S)
    slope = v / predicted
    effect = work_at_one / mean
    drag = way / mean
    path_part = table.path_variance / max(way, LEAST_STEP_M)
    # The covariances of speed and factor, of speed and excess, and the variance of the speed.
    cross = slope * estimate[FACTOR_COVARIANCE] - effect * estimate[FACTOR_VARIANCE]
    cross = cross - drag * estimate[CROSS_COVARIANCE]
    excess = slope * estimate[EXCESS_COVARIANCE] - effect * estimate[CROSS_COVARIANCE]
    excess = excess - drag * estimate[EXCESS_VARIANCE]
    square = slope * estimate[SPEED_VARIANCE] - effect * estimate[FACTOR_COVARIANCE]
    square = slope * (square - drag * estimate[EXCESS_COVARIANCE])
    square = square - effect * (cross - effect * path_part)
    estimate[PATH_M] = s
    estimate[SPEED_M_S] = predicted
    estimate[SPEED_VARIANCE] = max(square - drag * excess, NOUGHT)
    estimate[FACTOR_COVARIANCE] = cross
    estimate[EXCESS_COVARIANCE] = excess
    return effect


def correct(table: LineTable, estimate: Estimate, v: Speed) -> None:
    """Weigh a measured speed by the covariances."""
    square = estimate[SPEED_VARIANCE]
    cross = estimate[FACTOR_COVARIANCE]
    excess = estimate[EXCESS_COVARIANCE]
    total = square + table.speed_variance
    gain = square / total
    factor_gain = cross / total
    excess_gain = excess / total
    innovation = v - estimate[SPEED_M_S]
    estimate[SPEED_M_S] = max(estimate[SPEED_M_S] + gain * innovation, LEAST_SPEED_M_S)
    factor = estimate[FACTOR] + factor_gain * innovation
    estimate[FACTOR] = min(max(factor, LEAST_FACTOR), LARGEST_FACTOR)
    added = estimate[EXCESS] + excess_gain * innovation
    estimate[EXCESS] = min(max(added, LEAST_EXCESS_M_S2), LARGEST_EXCESS_M_S2)
    estimate[SPEED_VARIANCE] = square - gain * square
    estimate[FACTOR_COVARIANCE] = cross - gain * cross
    estimate[EXCESS_COVARIANCE] = excess - gain * excess
    estimate[FACTOR_VARIANCE] = max(estimate[FACTOR_VARIANCE] - factor_gain * cross, NOUGHT)
    estimate[CROSS_COVARIANCE] = estimate[CROSS_COVARIANCE] - factor_gain * excess
    estimate[EXCESS_VARIANCE] = max(estimate[EXCESS_VARIANCE] - excess_gain * excess, NOUGHT)
    estimate[BELIEVED] = estimate[BELIEVED] + ONE
    estimate[DOUBTED] = NOUGHT


def begin_at(table: LineTable, estimate: Estimate, s: Path, v: Speed) -> None:
    """Begin the estimate with a measured speed, taken as it is."""
    estimate[BEGUN] = ONE
    estimate[PATH_M] = s
    estimate[SPEED_M_S] = v
    estimate[FACTOR] = ONE
    estimate[EXCESS] = NOUGHT
    estimate[SPEED_VARIANCE] = table.speed_variance
    estimate[FACTOR_COVARIANCE] = NOUGHT
    estimate[EXCESS_COVARIANCE] = NOUGHT
    estimate[FACTOR_VARIANCE] = table.factor_variance
    estimate[CROSS_COVARIANCE] = NOUGHT
    estimate[EXCESS_VARIANCE] = table.excess_variance
    estimate[BELIEVED] = ONE
    estimate[DOUBTED] = NOUGHT
