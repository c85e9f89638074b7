"""The estimator of a table: its data, and what a controller computes with them, in float32.

Every sum, product and quotient is rounded to binary32 by storing and loading it. The order of the operations is that of
docs/reference/table-format.md, "The recursion"; the arithmetic, the search for the break and the handling of readings
are this program's own.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final, NamedTuple

from synth.checker.document_shape import ESTIMATOR_COUNTS, ESTIMATOR_NUMBERS, ESTIMATOR_ROWS, refuse_unless
from synth.checker.float32 import rounded

Row = tuple[float, ...]

LIMITS: Final[Mapping[str, tuple[float, float]]] = {
    "speed_noise_m_s": (1e-4, 10.0),
    "friction_cv": (0.0, 1.0),
    "resistance_std_m_s2": (0.0, 1.0),
    "path_std": (0.0, 1.0),
    "correlation_length_m": (1e-3, 1e4),
    "frozen_readings": (1, 10_000),
    "doubted_readings": (1, 10_000),
    "lost_speed_std_m_s": (1e-3, 10.0),
    "unlikely_deviation": (0.0, 10.0),
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
MOST_EXCESS_M_S2: Final = 0.5
GATE: Final = 5.0
"""A reading so many standard deviations away is doubted, if it leapt; by so many of two readings a leap begins."""
SETTLED_READINGS: Final = 3.0
"""Before so many were believed, a doubted reading is taken for the truth, and the ones before for the error."""
CAUTION: Final = 0.5

LOST_ALARM: Final = 1
SENSOR_ALARM: Final = 2
LIGHTER_ALARM: Final = 4
HEAVIER_ALARM: Final = 8


class Held(NamedTuple):
    """The numbers of an estimator in a controller, all of them binary32, in the order in which it holds them."""

    speed_variance: float
    factor_variance: float
    path_variance: float
    excess_variance: float
    leap: float
    frozen_readings: float
    doubted_readings: float
    lost_variance: float
    caution: float
    unlikely_deviation: float


@dataclass(frozen=True)
class Estimator:
    """What the table says of sensor, cut and work; the three rows are D and W at the breaks `s_m`."""

    speed_noise_m_s: float
    friction_cv: float
    resistance_std_m_s2: float
    path_std: float
    correlation_length_m: float
    frozen_readings: int
    doubted_readings: int
    lost_speed_std_m_s: float
    unlikely_deviation: float
    touch_pressure_kpa: float
    s_m: Row
    drive_m2_s2: Row
    brake_m2_s2_per_kpa: Row

    @property
    def held(self) -> tuple[Held, Row, Row, Row]:
        """All that a controller holds, as binary32 numbers: `Held`, s, D and W."""
        numbers = Held(
            speed_variance=self.speed_noise_m_s**2,
            factor_variance=self.friction_cv**2,
            path_variance=2.0 * self.path_std**2 * self.correlation_length_m,
            excess_variance=self.resistance_std_m_s2**2,
            leap=GATE * math.sqrt(2.0) * self.speed_noise_m_s,
            frozen_readings=self.frozen_readings,
            doubted_readings=self.doubted_readings,
            lost_variance=self.lost_speed_std_m_s**2,
            caution=CAUTION / self.lost_speed_std_m_s,
            unlikely_deviation=self.unlikely_deviation,
        )
        s, drive, brake = (tuple(map(rounded, row)) for row in (self.s_m, self.drive_m2_s2, self.brake_m2_s2_per_kpa))
        return Held(*map(rounded, numbers)), s, drive, brake


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
    parts: dict[str, Any] = {key: float(section[key]) for key in ESTIMATOR_NUMBERS}
    return Estimator(**(parts | {key: section[key] for key in ESTIMATOR_COUNTS} | rows))


def is_credible(v_m_s: float) -> bool:
    """Whether a speed can be measured at all; NaN cannot."""
    return 0.0 <= v_m_s <= FASTEST_M_S


def next_unseen(unseen: float, v_m_s: float) -> float:
    """Without an estimator: samples since the last credible speed, after one more; binary32, so it stays at 2**24."""
    return 0.0 if is_credible(v_m_s) else rounded(unseen + 1.0)


class Observer:
    """The estimator at work on one cut after the other; every attribute that is a number is a binary32 one.

    v is the speed, x the friction factor, a the excess resistance; vv, vx, … are their covariances.
    """

    def __init__(self, of: Estimator) -> None:
        self._held, self._places, self._drive, self._brake = of.held
        self.begin()

    def begin(self) -> None:
        """Forget the cut: the next sample is the first of another one."""
        self.begun = False
        self.s = self.v = self.x = self.a = 0.0
        self.vv = self.vx = self.va = self.xx = self.xa = self.aa = 0.0
        self.unseen = self.reading = self.repeated = self.believed = self.doubted = 0.0

    def observe(self, s_m: float, v_m_s: float, overpressure_kpa: float) -> float:
        """The speed to compare after this sample, −1 as long as none was believed.

        `overpressure_kpa` is the mean of max(0, P − P0) since the sample before.
        """
        before = self.s if self.begun else self._places[0]
        farthest = rounded(before + LONGEST_STEP_M) if self.begun else self._places[-1]
        s = rounded(s_m) if before <= s_m <= farthest else before
        last, heard = self.reading, self.unseen == 0.0 or self.repeated > 0.0
        measured = self._heard(v_m_s)
        if self.begun:
            kpa = rounded(overpressure_kpa) if 0.0 <= overpressure_kpa <= HIGHEST_KPA else 0.0
            then = self.v
            effect = self._predict(s, kpa)
            leaps = measured is not None and self._leaps(rounded(measured - last), then, effect)
            found = measured is not None and self._weighed(measured, heard, leaps)
        else:
            found = measured is not None and measured >= SLOWEST_M_S
            if measured is not None and found:
                self._first(s, measured)
        self.unseen = 0.0 if found else rounded(self.unseen + 1.0)
        return self._answer() if self.begun else -1.0

    @property
    def alarms(self) -> int:
        """The alarm word of the cut so far."""
        if not self.begun:
            return 0
        held, off = self._held, rounded(self.x - 1.0)
        lost = self.vv > held.lost_variance
        sensor = self.doubted > 0.0 or self.repeated >= held.frozen_readings
        lighter, heavier = off > held.unlikely_deviation, off < -held.unlikely_deviation
        return LOST_ALARM * lost + SENSOR_ALARM * sensor + LIGHTER_ALARM * lighter + HEAVIER_ALARM * heavier

    def _answer(self) -> float:
        """The estimate, and less where little is known of it."""
        beyond = max(rounded(self.vv - self._held.lost_variance), 0.0)
        return max(rounded(self.v - rounded(self._held.caution * beyond)), 0.0)

    def _heard(self, v_m_s: float) -> float | None:
        """The reading, None for one that says nothing: an impossible one, or one repeated too often."""
        if not is_credible(v_m_s):
            self.repeated = 0.0
            return None
        v = rounded(v_m_s)
        self.repeated = rounded(self.repeated + 1.0) if v == self.reading else 0.0
        self.reading = v
        return v if 3.0 * self.repeated < self._held.frozen_readings else None

    def _first(self, s: float, measured: float) -> None:
        """Begin, or begin anew, with this reading."""
        self.begun, self.s, self.v, self.x, self.a = True, s, measured, 1.0, 0.0
        self.vv, self.xx, self.aa = self._held.speed_variance, self._held.factor_variance, self._held.excess_variance
        self.vx = self.va = self.xa = 0.0
        self.believed, self.doubted = 1.0, 0.0

    def _predict(self, s: float, kpa: float) -> float:
        """Go on to the place `s` by energy; the speed that the brake took at a factor of 1."""
        r, then = rounded, self.v
        (drive_then, brake_then), (drive_now, brake_now) = self._work(self.s), self._work(s)
        step, braking = r(s - self.s), r(kpa * r(brake_now - brake_then))
        gained = r(r(r(drive_now - drive_then) - r(self.a * step)) - r(self.x * braking))
        mean = max(r(0.5 * r(r(then + then) + r(gained / then))), SLOWEST_M_S)
        self.s, self.v = s, max(r(then + r(gained / mean)), SLOWEST_M_S)
        # What an error of v, of −x and of −a makes of the speed.
        of_v, of_x, of_a = r(then / self.v), r(braking / mean), r(step / mean)
        vv = r(of_v * r(r(r(of_v * self.vv) - r(of_x * self.vx)) - r(of_a * self.va)))
        self.vx = r(r(r(of_v * self.vx) - r(of_x * self.xx)) - r(of_a * self.xa))
        self.va = r(r(r(of_v * self.va) - r(of_x * self.xa)) - r(of_a * self.aa))
        along = r(self._held.path_variance / max(step, SHORTEST_STEP_M))
        self.vv = max(r(r(vv - r(of_x * r(self.vx - r(of_x * along)))) - r(of_a * self.va)), 0.0)
        return of_x

    def _leaps(self, change: float, then: float, effect: float) -> bool:
        """Whether a reading that changed by `change` did so by more than the cut, the speed before being `then`."""
        leap, most = rounded(change - rounded(self.v - then)), rounded(self._held.leap + effect)
        return leap > most or leap < -most

    def _weighed(self, measured: float, heard: bool, leaps: bool) -> bool:
        """Take a reading; whether it is believed. `heard`: so that there was one at the sample before to leap from."""
        r = rounded
        total, innovation = r(self.vv + self._held.speed_variance), r(measured - self.v)
        strange = leaps if heard else measured < SLOWEST_M_S
        if (strange or self.doubted > 0.0) and r(innovation * innovation) > r(GATE**2 * total):
            return self._doubt(measured, leaps)
        self._correct(total, innovation)
        return True

    def _doubt(self, measured: float, leaps: bool) -> bool:
        """Do not believe the reading, unless the estimate seems to be what is wrong: then begin anew."""
        moving = measured >= SLOWEST_M_S
        self.doubted = rounded(self.doubted + 1.0) if moving and not leaps else 1.0
        anew = moving and (self.believed < SETTLED_READINGS or self.doubted >= self._held.doubted_readings)
        if anew:
            self._first(self.s, measured)
        return anew

    def _correct(self, total: float, innovation: float) -> None:
        """Weigh in a reading that is `innovation` above the speed; `total`: variance of that."""
        r, vv, vx, va = rounded, self.vv, self.vx, self.va
        to_v, to_x, to_a = r(vv / total), r(vx / total), r(va / total)
        self.v = max(r(self.v + r(to_v * innovation)), SLOWEST_M_S)
        self.x = min(max(r(self.x + r(to_x * innovation)), LEAST_FACTOR), MOST_FACTOR)
        self.a = min(max(r(self.a + r(to_a * innovation)), -MOST_EXCESS_M_S2), MOST_EXCESS_M_S2)
        self.vv, self.vx, self.va = r(vv - r(to_v * vv)), r(vx - r(to_v * vx)), r(va - r(to_v * va))
        self.xx = max(r(self.xx - r(to_x * vx)), 0.0)
        self.xa = r(self.xa - r(to_x * va))
        self.aa = max(r(self.aa - r(to_a * va)), 0.0)
        self.believed, self.doubted = r(self.believed + 1.0), 0.0

    def _work(self, place: float) -> tuple[float, float]:
        """D and W at a place, beyond the breaks those at the nearest one."""
        r, s = rounded, self._places
        place = min(max(place, s[0]), s[-1])
        end = bisect_left(s, place, 1, len(s) - 1)
        part = r(r(place - s[end - 1]) / r(s[end] - s[end - 1]))
        drive, brake = (r(row[end - 1] + r(part * r(row[end] - row[end - 1]))) for row in (self._drive, self._brake))
        return drive, brake
