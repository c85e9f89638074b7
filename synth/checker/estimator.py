"""The estimator of a table of version 2: its data, and what a controller computes with them, in float32.

Every sum, product and quotient is rounded to binary32 by storing and loading it. The order of the operations is that of
docs/table-format.md, "The recursion"; the arithmetic, the search for the break and the handling of readings are this
program's own.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

from synth.checker.document_shape import ESTIMATOR_NUMBERS, ESTIMATOR_ROWS, refuse_unless
from synth.checker.float32 import rounded

Row = tuple[float, ...]

LIMITS: Final[Mapping[str, tuple[float, float]]] = {
    "speed_noise_m_s": (1e-4, 10.0),
    "friction_cv": (0.0, 1.0),
    "path_std": (0.0, 1.0),
    "correlation_length_m": (1e-3, 1e4),
    "touch_pressure_kpa": (0.0, 2000.0),
    "s_m": (-1e4, 1e4),
    "drive_m2_s2": (-1e6, 1e6),
    "brake_m2_s2_per_kpa": (-1e6, 1e6),
}
MOST_BREAKS: Final = 256

FASTEST_M_S: Final = 40.0
HIGHEST_KPA: Final = 2000.0
LONGEST_STEP_M: Final = 20.0
"""Readings beyond are not believed."""
SLOWEST_M_S: Final = rounded(0.2)
SHORTEST_STEP_M: Final = rounded(0.001)
LEAST_FACTOR: Final = rounded(0.3)
MOST_FACTOR: Final = rounded(1.9)


@dataclass(frozen=True)
class Estimator:
    """What the table says of sensor, friction and work; the three rows are D and W at the breaks `s_m`."""

    speed_noise_m_s: float
    friction_cv: float
    path_std: float
    correlation_length_m: float
    touch_pressure_kpa: float
    s_m: Row
    drive_m2_s2: Row
    brake_m2_s2_per_kpa: Row

    @property
    def noise(self) -> float:
        """Variance of a measured speed."""
        return self.speed_noise_m_s**2

    @property
    def spread(self) -> float:
        """Variance of the factor between cuts."""
        return self.friction_cv**2

    @property
    def along(self) -> float:
        """Variance of the factor along the path, times the length that it counts for."""
        return 2.0 * self.path_std**2 * self.correlation_length_m

    @property
    def held(self) -> tuple[Row, Row, Row, Row]:
        """All that a controller holds, as binary32 numbers: the three variances and P0, s, D and W."""
        variances = (self.noise, self.spread, self.along, self.touch_pressure_kpa)
        s, drive, brake, numbers = (
            tuple(map(rounded, row)) for row in (self.s_m, self.drive_m2_s2, self.brake_m2_s2_per_kpa, variances)
        )
        return numbers, s, drive, brake


def estimator_of(section: Mapping[str, Any]) -> Estimator:
    """The estimator in a section of the right shape; `DamagedError` for values that none may have."""
    for key, (low, high) in LIMITS.items():
        for value in section[key] if key in ESTIMATOR_ROWS else [section[key]]:
            refuse_unless(low <= value <= high, value, f"estimator.{key}", f"from {low:g} to {high:g}")
    rows = {key: tuple(map(float, section[key])) for key in ESTIMATOR_ROWS}
    counts = [len(row) for row in rows.values()]
    refuse_unless(len(set(counts)) == 1, counts, "the lengths of the estimator's rows", "equal")
    refuse_unless(2 <= counts[0] <= MOST_BREAKS, counts[0], "the number of breaks", f"from 2 to {MOST_BREAKS}")
    for (a, b), (before, after) in zip(pairwise(rows["s_m"]), pairwise(rows["brake_m2_s2_per_kpa"]), strict=True):
        apart = rounded(rounded(b) - rounded(a)) >= SHORTEST_STEP_M
        refuse_unless(apart, [a, b], "estimator.s_m", "rising by a millimetre at least")
        refuse_unless(before <= after, [before, after], "estimator.brake_m2_s2_per_kpa", "without a fall")
    noise, spread, path, length, touch = (float(section[key]) for key in ESTIMATOR_NUMBERS)
    places, drive, brake = rows.values()
    return Estimator(noise, spread, path, length, touch, places, drive, brake)


def is_credible(v_m_s: float) -> bool:
    """Whether a measured speed is believed; NaN is not."""
    return 0.0 <= v_m_s <= FASTEST_M_S


def next_unseen(unseen: float, v_m_s: float) -> float:
    """Samples since the last speed that was believed, after one more; binary32, so it stays at 2**24."""
    return 0.0 if is_credible(v_m_s) else rounded(unseen + 1.0)


def quotient(a: float, b: float) -> float:
    """a / b as IEEE 754 has it, also for b = 0, which only absurd work can bring about."""
    if b != 0.0:
        return rounded(a / b)
    return math.nan if a == 0.0 or math.isnan(a) else math.copysign(math.inf, a) * math.copysign(1.0, b)


class Observer:
    """The estimator at work on one cut after the other; every attribute that is a number is a binary32 one."""

    def __init__(self, of: Estimator) -> None:
        (self._noise, self._spread, self._path, _), self._places, self._drive, self._brake = of.held
        self.begin()

    def begin(self) -> None:
        """Forget the cut: the next sample is the first of another one."""
        self.begun = False
        self.s = self.v = self.factor = 0.0
        self.speed_variance = self.covariance = self.factor_variance = 0.0
        self.unseen = 0.0

    def observe(self, s_m: float, v_m_s: float, overpressure_kpa: float) -> float:
        """The estimated speed after this sample, −1 as long as none was measured.

        `overpressure_kpa` is the mean of max(0, P − P0) since the sample before.
        """
        measured = rounded(v_m_s) if is_credible(v_m_s) else None
        self.unseen = next_unseen(self.unseen, v_m_s)
        if not self.begun:
            return self._first(s_m, measured)
        kpa = rounded(overpressure_kpa) if 0.0 <= overpressure_kpa <= HIGHEST_KPA else 0.0
        before = self.s
        if before <= s_m <= rounded(before + LONGEST_STEP_M):
            self.s = rounded(s_m)
        self._predict(before, kpa)
        if measured is not None:
            self._correct(measured)
        return self.v

    def _first(self, s_m: float, measured: float | None) -> float:
        if measured is None:
            return -1.0
        first, last = self._places[0], self._places[-1]
        self.begun, self.s = True, rounded(s_m) if first <= s_m <= last else first
        self.v, self.factor = max(measured, SLOWEST_M_S), 1.0
        self.speed_variance, self.covariance, self.factor_variance = self._noise, 0.0, self._spread
        return self.v

    def _predict(self, before: float, kpa: float) -> None:
        """Go on to `self.s` by energy, from the place `before`."""
        r = rounded
        (drive_then, brake_then), (drive_now, brake_now) = self._work(before), self._work(self.s)
        braking = r(kpa * r(brake_now - brake_then))
        gained = r(r(drive_now - drive_then) - r(self.factor * braking))
        v = self.v
        mean = max(r(0.5 * r(r(v + v) + r(gained / v))), SLOWEST_M_S)
        self.v = max(r(v + r(gained / mean)), SLOWEST_M_S)
        a, b = r(v / self.v), r(braking / mean)  # what an error of v, and of −ξ, makes of the speed
        along = r(self._path / max(r(self.s - before), SHORTEST_STEP_M))
        p11, p12, p22 = self.speed_variance, self.covariance, self.factor_variance
        crossed = r(r(r(2.0 * a) * b) * p12)
        self.speed_variance = r(r(r(r(a * a) * p11) - crossed) + r(r(b * b) * r(p22 + along)))
        self.covariance = r(r(a * p12) - r(b * p22))

    def _correct(self, measured: float) -> None:
        """Weigh in the measured speed."""
        r = rounded
        p11, p12 = self.speed_variance, self.covariance
        total = r(p11 + self._noise)
        gain, of_factor = quotient(p11, total), quotient(p12, total)
        surprise = r(measured - self.v)
        self.v = max(r(self.v + r(gain * surprise)), SLOWEST_M_S)
        self.factor = min(max(r(self.factor + r(of_factor * surprise)), LEAST_FACTOR), MOST_FACTOR)
        self.factor_variance = max(r(self.factor_variance - r(of_factor * p12)), 0.0)
        self.covariance = r(p12 - r(gain * p12))
        self.speed_variance = r(p11 - r(gain * p11))

    def _work(self, place: float) -> tuple[float, float]:
        """D and W at a place, beyond the breaks those at the nearest one."""
        r, s = rounded, self._places
        place = min(max(place, s[0]), s[-1])
        end = bisect_left(s, place, 1, len(s) - 1)
        part = r(r(place - s[end - 1]) / r(s[end] - s[end - 1]))
        drive, brake = (r(row[end - 1] + r(part * r(row[end] - row[end - 1]))) for row in (self._drive, self._brake))
        return drive, brake
