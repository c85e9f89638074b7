"""Refinement as published: the exit speed of the recorded cut that took nearly the same times ([kozachenko-aimed])."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree
from scipy.special import ndtri

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from synth.aim.knowledge import Requirement
from synth.aim.limit_speed import bounded
from synth.aim.scene import SceneCuts

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
