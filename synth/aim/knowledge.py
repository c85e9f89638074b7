"""From what is known of a cut to the exit speed that it is commanded: by category, or by a reading besides.

The highest command that keeps the probability of over-speed is a quantile of a sorted list of thresholds; a reading is
what can be measured of a cut before its exit speed is set, and how well.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.optimize import isotonic_regression
from scipy.special import ndtri

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from synth.aim.scene import SceneCuts


@frozen_arrays
class Thresholds:
    """Commands above which n cuts couple too fast at k places: `sorted_m_s` (n, k), each column sorted, and `order`
    (n, k): whose they are. Build it with `thresholds_of`."""

    sorted_m_s: Floats
    order: Ints

    def overspeed(self, commanded_m_s: Floats) -> Floats:
        """Share of the cuts that couple too fast at place k when all are commanded `commanded_m_s` (k,)."""
        columns = range(self.sorted_m_s.shape[1])
        below = [np.searchsorted(self.sorted_m_s[:, k], commanded_m_s[k], side="left") for k in columns]
        return np.array(below) / len(self.sorted_m_s)

    def limit_speeds(self, p_overspeed: float, bounds_m_s: tuple[float, float]) -> Floats:
        """The highest command for each place, (k,), that at most the share `p_overspeed` of the cuts couples too fast
        with; at most the upper bound, and NaN where even the lower bound is too fast."""
        return bounded(self.sorted_m_s[int(p_overspeed * len(self.sorted_m_s))], bounds_m_s)

    def weighted_limit_speeds(self, weights: Floats, p_overspeed: float, bounds_m_s: tuple[float, float]) -> Floats:
        """As `limit_speeds`, each cut counting by its weight (n,)."""
        kept = p_overspeed * weights.sum()
        places = [place_beyond(kept, weights, order) for order in self.order.T]
        return bounded(self.sorted_m_s[places, np.arange(len(places))], bounds_m_s)


def thresholds_of(thresholds_m_s: Floats) -> Thresholds:
    """The list of `thresholds_m_s` (n, k), sorted."""
    order = np.argsort(thresholds_m_s, axis=0, kind="stable")
    return Thresholds(np.take_along_axis(thresholds_m_s, order, axis=0), order)


def place_beyond(limit: float, weights: Floats, order: Ints) -> int:
    """First place at which the weights (n,) in `order` (n,) add up to more than `limit`, or the last one.

    The first quarter of the places is added up first, as it mostly is enough.
    """
    for count in (len(order) // 4, len(order)):
        passed = np.cumsum(weights[order[:count]])
        if passed.size and passed[-1] > limit:
            break
    return min(int(np.searchsorted(passed, limit, side="right")), len(order) - 1)


def bounded(speeds_m_s: Floats, bounds_m_s: tuple[float, float]) -> Floats:
    """Speeds down to the upper bound, NaN below the lower one."""
    low, high = bounds_m_s
    return np.where(speeds_m_s >= low, np.minimum(speeds_m_s, high), np.nan)


MOST_N_PER_KN = 50.0
"""Resistance that stands for a cut that stopped on the stretch."""


@frozen_arrays
class TrueReadings:
    """Of n cuts: the reading of a sensor without error, and the standard deviation of its error, each (n,)."""

    value: Floats
    std: Floats

    def with_error(self, cuts: SceneCuts) -> Floats:
        """Readings as the sensor gives them for these cuts, (n,)."""
        return self.value + self.std * ndtri(cuts.numbers(Purpose.SPEED_NOISE, 1)[:, 0])


class Reading(Protocol):
    """A kind of reading. The higher it is, the worse the cut rolls."""

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """What it reads of these cuts."""


@dataclass(frozen=True)
class ResistanceByTwoSpeeds:
    """Mean resistance on the scene's stretch from the speeds at both ends, each with an error of `speed_std_m_s`:
    w = i − (v2² − v1²)/(2 g' L), N/kN; grade, mass and axles are known ([kozachenko-aimed] has three such points)."""

    speed_std_m_s: float

    def __post_init__(self) -> None:
        require_between("measured stretch: speed_std_m_s", self.speed_std_m_s, 1e-4, 2.0)

    def of(self, cuts: SceneCuts) -> TrueReadings:
        """Resistance on the stretch, N/kN; `MOST_N_PER_KN` for a cut that stopped there."""
        v1, v2 = cuts.measured_speeds_m_s
        stretch, gravity = cuts.scene.stretch, cuts.rolling.cuts.reduced_gravity_m_s2
        length = stretch.to_m - stretch.from_m
        begin = cuts.begin_m
        fall = cuts.rolling.fall_m(begin + length) - cuts.rolling.fall_m(begin)
        value = 1e3 * (fall - (v2**2 - v1**2) / (2.0 * gravity)) / length
        std = 1e3 * self.speed_std_m_s * np.hypot(v1, v2) / (gravity * length)
        return TrueReadings(np.where(v2 > 0.0, value, MOST_N_PER_KN), std)


NODES = 25
"""At which commands by a reading are worked out."""

LOW_TAIL, HIGH_TAIL = 0.0002, 0.002
"""Shares of readings beyond the ends of the nodes; they get the command of the end: too fast below, too slow above."""


@dataclass(frozen=True)
class Requirement:
    """At most the share `p_overspeed` of the cuts couples too fast; commands stay within `bounds_m_s`."""

    p_overspeed: float
    bounds_m_s: tuple[float, float]


class Commands(Protocol):
    """Exit speeds to command, as a function of what is known."""

    def of(self, cuts: SceneCuts) -> Floats:
        """For these cuts, (n, k) for k places of coupling; NaN where no command meets the requirement."""


class Knowledge(Protocol):
    """What is known of a cut when its exit speed is set."""

    def commands(self, cuts: SceneCuts, thresholds_m_s: Floats, requirement: Requirement) -> Commands:
        """The highest commands that meet the requirement on these cuts, whose thresholds (n, k) are given."""


@frozen_arrays
class SameCommands:
    """`speeds_m_s` (k,) whatever the cut."""

    speeds_m_s: Floats

    def of(self, cuts: SceneCuts) -> Floats:
        """The same row for each cut."""
        return np.broadcast_to(self.speeds_m_s, (len(cuts), len(self.speeds_m_s)))


@dataclass(frozen=True)
class ByCategory:
    """Nothing but the weight category and the number of cars."""

    def commands(self, cuts: SceneCuts, thresholds_m_s: Floats, requirement: Requirement) -> SameCommands:
        """The quantile of the sorted thresholds."""
        return SameCommands(thresholds_of(thresholds_m_s).limit_speeds(requirement.p_overspeed, requirement.bounds_m_s))


@frozen_arrays
class CommandsByReading:
    """`speeds_m_s` (nodes, k) at the readings `nodes` (nodes,), linear between, constant beyond; they do not fall with
    the reading."""

    reading: Reading
    nodes: Floats
    speeds_m_s: Floats

    def of(self, cuts: SceneCuts) -> Floats:
        """By the readings of these cuts, errors of the sensor included."""
        return self.at(self.reading.of(cuts).with_error(cuts))

    def at(self, readings: Floats) -> Floats:
        """For `readings` (n,), shape (n, k)."""
        columns = [np.interp(readings, self.nodes, column) for column in self.speeds_m_s.T]
        return np.stack(columns, axis=1)


@dataclass(frozen=True)
class ByReading:
    """Category, cars and a reading: Bayes' rule on the drawn cuts.

    For a reading r, each cut counts by the likelihood of r given what a perfect sensor would have read of it; the
    command is the quantile of the thresholds so weighted. It keeps the requirement for every reading, so for all cuts.
    """

    reading: Reading
    nodes: int = NODES

    def commands(self, cuts: SceneCuts, thresholds_m_s: Floats, requirement: Requirement) -> CommandsByReading:
        """The weighted quantiles at evenly spaced readings."""
        return self.commands_at(self.readings(cuts), cuts, thresholds_m_s, requirement)

    def readings(self, cuts: SceneCuts) -> Floats:
        """Evenly spaced readings that span those of `cuts`, (nodes,)."""
        low, high = np.quantile(self.reading.of(cuts).with_error(cuts), (LOW_TAIL, 1.0 - HIGH_TAIL))
        return np.linspace(float(low), float(high), self.nodes)

    def commands_at(
        self, nodes: Floats, cuts: SceneCuts, thresholds_m_s: Floats, requirement: Requirement
    ) -> CommandsByReading:
        """The weighted quantiles at the readings `nodes`, made not to fall."""
        true, thresholds = self.reading.of(cuts), thresholds_of(thresholds_m_s)
        rows = [
            thresholds.weighted_limit_speeds(
                likelihood(r, true.value, true.std), requirement.p_overspeed, requirement.bounds_m_s
            )
            for r in nodes
        ]
        return CommandsByReading(self.reading, nodes, not_falling(np.array(rows)))


def likelihood(reading: float, value: Floats, std: Floats) -> Floats:
    """Of a reading, for cuts of which a perfect sensor would have read `value`; the same factor is left out for all."""
    squares = ((reading - value) / std) ** 2
    return np.asarray(np.exp(-0.5 * (squares - squares.min())) / std)


def not_falling(speeds_m_s: Floats) -> Floats:
    """`speeds_m_s` (nodes, k) made not to fall along the nodes, by least squares: the noise of the draws is averaged
    out where it would command a better runner more than a worse one. A node below one that is NaN is NaN, too."""
    rising = np.full_like(speeds_m_s, np.nan)
    for k, column in enumerate(speeds_m_s.T):
        without = np.flatnonzero(np.isnan(column))
        start = without[-1] + 1 if len(without) else 0
        if start < len(column):
            rising[start:, k] = isotonic_regression(column[start:]).x
    return rising
