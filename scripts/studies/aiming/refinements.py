"""Refinements of a command by what is measured of a cut: the recorded cut that took nearly the same times
([kozachenko-aimed]), a polynomial of the reading as an engineer would fit it, and readings that only studies
suppose.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial
from scipy.spatial import KDTree
from scipy.special import ndtri

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from synth.aim.knowledge import MOST_N_PER_KN, Reading, Requirement, TrueReadings, bounded
from synth.aim.scene import SceneCuts


@dataclass(frozen=True)
class ResistanceByRadar:
    """Mean resistance on the last `length_m` of the scene's stretch by regression of e on path: a radar that looks
    upstream reads the speed each `sample_period_s` with an independent error of `speed_std_m_s`.

    Standard deviation √12·v·σ_v·10³/(√N·g'·L) for N readings at nearly even speed v.
    """

    speed_std_m_s: float
    length_m: float
    sample_period_s: float = 0.1

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """Resistance on that stretch, N/kN; `MOST_N_PER_KN` for a cut that stops there."""
        rolling, scene = cuts.rolling, cuts.scene
        ends = scene.stretch.to_m + rolling.cuts.first_axle_m
        begins = np.maximum(ends - self.length_m, cuts.begin_m + 1e-3)
        rolled = rolling.roll_on(cuts.begin_m, cuts.stretch_speed_m_s, np.stack([begins, ends], axis=1))
        v1, v2 = rolled.speed_m_s[:, 0], rolled.speed_m_s[:, 1]
        gravity, length = rolling.cuts.reduced_gravity_m_s2, ends - begins
        fall = rolling.fall_m(ends) - rolling.fall_m(begins)
        value = 1e3 * (fall - (v2**2 - v1**2) / (2.0 * gravity)) / length
        speed = np.maximum(0.5 * (v1 + v2), 0.1)
        readings = np.maximum(length / (speed * self.sample_period_s), 2.0)
        std = math.sqrt(12.0) * 1e3 * speed * self.speed_std_m_s / (np.sqrt(readings) * gravity * length)
        return TrueReadings(np.where(v2 > 0.0, value, MOST_N_PER_KN), std)


@dataclass(frozen=True)
class LightnessByWeigher:
    """Less the mass of the cut, tonnes, by a weigher with a relative error of `relative_std`: light cuts roll worse."""

    relative_std: float = 0.02

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """Less the mass, tonnes."""
        mass = cuts.rolling.cuts.cut_mass_t
        return TrueReadings(-mass, self.relative_std * mass)


STOPPED_S = 1e6
"""Time that stands for a cut that stopped between two points."""


@dataclass(frozen=True)
class ControlPoints:
    """Three points between bunch and park position, metres from the crest; each passage is told with a normal error of
    `time_std_s` (passages of the first axle)."""

    at_m: tuple[float, float, float]
    time_std_s: float = 0.005

    def __post_init__(self) -> None:
        require(
            self.at_m[0] < self.at_m[1] < self.at_m[2],
            f"control points: at_m is {self.at_m}; it must increase",
        )
        require_between("control points: time_std_s", self.time_std_s, 0.0, 1.0)

    def times_s(self, cuts: SceneCuts) -> Floats:
        """(t1, t2) of each cut as measured, (n, 2)."""
        stations = np.array(self.at_m) + cuts.rolling.cuts.first_axle_m[:, None]
        passed = cuts.rolling.roll_on(cuts.begin_m, cuts.stretch_speed_m_s, stations).time_s
        told = np.where(np.isfinite(passed), passed, STOPPED_S)
        return np.diff(told + self.time_std_s * ndtri(cuts.numbers(Purpose.SPEED_NOISE, 3)), axis=1)


@frozen_arrays
class CommandsByRecords:
    """Exit speeds of the nearest record less a margin: `times_s` (records, 2), `speeds_m_s` (records, k)."""

    points: ControlPoints
    times_s: Floats
    speeds_m_s: Floats
    bounds_m_s: tuple[float, float]

    def of(self, cuts: SceneCuts) -> Floats:
        """By the times of these cuts, (n, k)."""
        return bounded(self.speeds_m_s[nearest(self.times_s, self.points.times_s(cuts))], self.bounds_m_s)


@dataclass(frozen=True)
class NearestRecord:
    """Category, cars, and `records` recorded cuts with their times and the exit speeds that would have served them.

    The margin, one for each place, is what keeps the requirement for other cuts. A share `wrong` of the records holds
    the exit speed of another cut.
    """

    points: ControlPoints
    records: int
    wrong: float = 0.0

    def __post_init__(self) -> None:
        require(self.records >= 1, f"records: {self.records}; there must be 1 or more")
        require_between("records: wrong", self.wrong, 0.0, 1.0)

    def commands(self, cuts: SceneCuts, thresholds_m_s: Floats, requirement: Requirement) -> CommandsByRecords:
        """The first `records` of these cuts are recorded; the others choose the margin."""
        require(
            self.records < len(cuts),
            f"records: {self.records}; there must be fewer than cuts to choose on, {len(cuts)}",
        )
        times = self.points.times_s(cuts)
        able = np.maximum(thresholds_m_s[: self.records], requirement.bounds_m_s[0])  # none is recorded as slower
        recorded = with_wrong(able, self.wrong, cuts)
        others = slice(self.records, None)
        guess = recorded[nearest(times[: self.records], times[others])]
        margin = np.quantile(guess - thresholds_m_s[others], 1.0 - requirement.p_overspeed, axis=0, method="higher")
        return CommandsByRecords(self.points, times[: self.records], recorded - margin, requirement.bounds_m_s)


def nearest(records_s: Floats, times_s: Floats) -> Ints:
    """The record nearest to each row of `times_s` by (t1' − t1)² + (t2' − t2)²."""
    return np.asarray(KDTree(records_s).query(times_s)[1])


def with_wrong(speeds_m_s: Floats, wrong: float, cuts: SceneCuts) -> Floats:
    """`speeds_m_s` (records, k), a share of them moved on to the next record."""
    u = cuts.numbers(Purpose.RECORDS, 1)[: len(speeds_m_s), :]
    return np.where(u < wrong, np.roll(speeds_m_s, 1, axis=0), speeds_m_s)


@frozen_arrays
class CommandsByPolynomial:
    """`polynomials` of the reading, one for each place, margin included; readings beyond `range` count as its ends."""

    reading: Reading
    polynomials: tuple[Polynomial, ...]
    range: tuple[float, float]
    bounds_m_s: tuple[float, float]

    def of(self, cuts: SceneCuts) -> Floats:
        """By the readings of these cuts, (n, k)."""
        told = np.clip(self.reading.of(cuts).with_error(cuts), *self.range)
        return bounded(np.stack([p(told) for p in self.polynomials], axis=1), self.bounds_m_s)


@dataclass(frozen=True)
class ByRegression:
    """Category, cars and a reading: least squares of the thresholds on a polynomial of `degree` of the reading; one
    margin for each place keeps the requirement on average over the cuts, not for every reading."""

    reading: Reading
    degree: int = 2

    def __post_init__(self) -> None:
        require(1 <= self.degree <= 6, f"regression: degree is {self.degree}; it must be from 1 to 6")

    def commands(self, cuts: SceneCuts, thresholds_m_s: Floats, requirement: Requirement) -> CommandsByPolynomial:
        """Fit and margin on these cuts; cuts that couple too fast whatever is commanded choose the margin only."""
        told = self.reading.of(cuts).with_error(cuts)
        low, high = np.quantile(told, (0.001, 0.999))
        told = np.clip(told, low, high)
        fitted = tuple(self.fitted(told, column, requirement.p_overspeed) for column in thresholds_m_s.T)
        return CommandsByPolynomial(self.reading, fitted, (float(low), float(high)), requirement.bounds_m_s)

    def fitted(self, told: Floats, thresholds_m_s: Floats, p_overspeed: float) -> Polynomial:
        """The polynomial for one place, lowered by the margin."""
        able = np.isfinite(thresholds_m_s)
        fit = Polynomial.fit(told[able], thresholds_m_s[able], self.degree)
        return fit - np.quantile(fit(told) - thresholds_m_s, 1.0 - p_overspeed, method="higher")
