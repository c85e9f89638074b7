"""Readings of a faulty radar, and of a cut that is braked hard: part of the golden tracks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from tuning_tables.estimator import Estimator
from tuning_tables.programs import motion_filter, observe

LARGEST_STEP_M: Final = float(observe.LARGEST_STEP_M)
LEAST_SPEED_M_S: Final = float(motion_filter.LEAST_SPEED_M_S)

Reading = tuple[float, float, float]
"""Path in m, measured speed in m/s, overpressure in kPa."""

MISSING_M_S: Final = -1.0
"""A speed that cannot be true, with a literal in every language."""


def faulty_radar(estimator: Estimator) -> Iterator[Reading]:
    """A cut in front of a radar that shows 0, leaps away and back, repeats itself, leaps twice, stays, and is lost."""
    first, last = float(estimator.work[0, 0]), float(estimator.work[0, -1])
    frozen, doubted = (min(number, 40) for number in (estimator.frozen_readings, estimator.doubted_readings))
    far = 4.0 + 12.0 * estimator.speed_noise_m_s + 1.0
    speeds = [4.0, 4.05, 3.95, 4.0, 0.0, 4.05, far, 3.95, far, far, 4.0, MISSING_M_S, 0.0, 4.05, MISSING_M_S, far, 4.0]
    speeds += [3.95] * (frozen + 1) + [far, 4.0, *(far + 0.05 * (i % 2) for i in range(doubted + 3))]
    speeds += [MISSING_M_S] * 12
    step = (last - first) / (len(speeds) + 1)
    for sample, speed in enumerate(speeds):
        yield first + sample * step, speed, 300.0 if sample % 3 else 0.0


def wrong_at_first(estimator: Estimator) -> Iterator[Reading]:
    """The first readings are the false ones: the estimate begins with each, and anew with the right one."""
    first, last = float(estimator.work[0, 0]), float(estimator.work[0, -1])
    far, least = 4.0 + 12.0 * estimator.speed_noise_m_s + 1.0, float(np.float32(LEAST_SPEED_M_S))
    speeds = (
        0.0,
        0.1,
        least,
        far,
        least,
        4.0,
        4.05,
        far + 2.0,
        4.0,
        3.95,
        4.05,
        far + 2.0,
        4.0,
        4.05,
        MISSING_M_S,
        least,
    )
    step = min((last - first) / len(speeds), 0.4)
    for sample, speed in enumerate(speeds):
        yield first + sample * step, speed, 0.0


def leaping_after_three(estimator: Estimator) -> Iterator[Reading]:
    """Three readings that agree, then far ones that leap on and on: none is believed, however many they are."""
    first, last = float(estimator.work[0, 0]), float(estimator.work[0, -1])
    leap = 12.0 * estimator.speed_noise_m_s + 1.0
    leaps = [4.0 + leap * (1 + i % 2) for i in range(min(estimator.doubted_readings, 40) + 2)]
    speeds = [4.0, 4.05, 3.95, *leaps, 4.0]
    step = min((last - first) / len(speeds), 0.1)
    for sample, speed in enumerate(speeds):
        yield first + sample * step, speed, 0.0


def frozen_alone(estimator: Estimator) -> Iterator[Reading]:
    """A radar that repeats itself, and nothing else is wrong."""
    first, last = float(estimator.work[0, 0]), float(estimator.work[0, -1])
    speeds = [4.0, 4.05, *[3.95] * (min(estimator.frozen_readings, 40) + 2)]
    step = min((last - first) / len(speeds), 0.1)
    for sample, speed in enumerate(speeds):
        yield first + sample * step, speed, 0.0


def rising_while_braked(estimator: Estimator) -> Iterator[Reading]:
    """Single readings that are the higher the later, while the brake works hard: what leaps depends on its work."""
    base, unit = hardest(estimator)
    yield float(estimator.work[0, 0]), 6.0, 0.0
    for sample in range(30):
        rises = sample % 3 == 2
        yield base + sample * unit / 4.0, 6.0 - 0.05 * sample + (0.06 * sample if rises else 0.0), 600.0


def hardest(estimator: Estimator) -> tuple[float, float]:
    """Where the line begins on which the brake works hardest, m, among those that few steps reach; and an eighth of it.

    The eighth is 1 m at most.
    """
    s_m, _, brake = np.array(estimator.work, dtype=np.float64)
    within = np.flatnonzero(s_m[:-1] <= s_m[0] + 3.5 * LARGEST_STEP_M)
    place = within[np.argmax((np.diff(brake) / np.diff(s_m))[within])]
    return float(s_m[place]), min(float(s_m[place + 1] - s_m[place]) / 8.0, 1.0)
