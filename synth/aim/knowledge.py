"""From what is known of a cut to the exit speed that it is commanded: by category, or by a reading besides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.optimize import isotonic_regression

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.aim.limit_speed import thresholds_of
from synth.aim.readings import Reading
from synth.aim.scene import SceneCuts

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
