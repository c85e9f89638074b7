"""The resistance that a control expects of cuts when they come to a position."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.trains.asked import Asked
from synth.hump.trains.expected_way import ExpectedWay
from synth.hump.trains.free_stretch import SHORTEST_M
from synth.hump.trains.known_cuts import KnownCuts
from synth.hump.trains.resistance_prior import ResistancePrior, resistance_prior
from synth.hump.trains.speed_sensors import SpeedSensors
from synth.hump.trains.train_cuts import TrainCuts

Rollability = Callable[[Asked], Floats]
"""What a control makes of the cuts that come to a position: the w0 (n,) with which they are expected to roll on, with
mean bends and mean wind."""


def mean_of_category(known: KnownCuts, asked: Asked) -> Floats:
    """That of cuts of which nothing is measured: the mean of their category."""
    return known.mean_n_per_kn[asked.lanes * known.cuts + asked.cut]


@frozen_arrays
class Belief:
    """What is believed of n cuts, (n,) each: normal resistance whatever the speed, normal wind above its mean, and the
    `covariance` of both."""

    resistance_n_per_kn: Floats
    wind_m_s: Floats
    resistance_variance: Floats
    wind_variance: Floats
    covariance: Floats

    def variance(self, slope: Floats) -> Floats:
        """Of resistance + `slope`·wind, (n,)."""
        return self.resistance_variance + 2.0 * slope * self.covariance + slope**2 * self.wind_variance

    def after(self, excess_n_per_kn: Floats, slope: Floats, variance: Floats) -> Belief:
        """After a measurement of resistance + `slope`·wind, with an error of `variance` (n,), that was
        `excess_n_per_kn` more than expected, NaN where there was none: one step of a Kalman filter."""
        of_resistance = self.resistance_variance + slope * self.covariance
        of_wind = self.covariance + slope * self.wind_variance
        made = ~np.isnan(excess_n_per_kn)
        per_total = np.where(made, 1.0 / (self.variance(slope) + variance), 0.0)
        excess = np.where(made, excess_n_per_kn, 0.0)
        return Belief(
            self.resistance_n_per_kn + of_resistance * per_total * excess,
            self.wind_m_s + of_wind * per_total * excess,
            self.resistance_variance - of_resistance**2 * per_total,
            self.wind_variance - of_wind**2 * per_total,
            self.covariance - of_resistance * of_wind * per_total,
        )


@frozen_arrays
class Resistance:
    """Mean and standard deviation of what is expected of n cuts, (n,) each, N/kN."""

    mean_n_per_kn: Floats
    std_n_per_kn: Floats


@dataclass(frozen=True)
class MeasuredRollability:
    """The mean of a category, corrected by the speeds at both ends of every free stretch that a cut has behind it.

    The wind u above its mean is one draw for all the way. At the speed v it takes 2·a·(v + ū)·u + a·u²: the first part
    is believed in beside the resistance, the second, which no speed changes, is part of it. A stretch is measured as in
    `free_stretch`, with the errors of both speeds and of the bends. All laws are taken as normal.
    """

    sensors: SpeedSensors
    way: ExpectedWay
    prior: ResistancePrior

    def resistance_n_per_kn(self, asked: Asked) -> Floats:
        """See `Rollability`; nothing later than the start of the cuts asked for is used."""
        return self.expected(asked).mean_n_per_kn

    def expected(self, asked: Asked) -> Resistance:
        """The resistance on the way ahead, with its standard deviation."""
        rows = asked.lanes * self.sensors.trains.cuts + asked.cut
        belief = self.before_the_crest(rows)
        for position in range(asked.position + 1):
            belief = self.measured(belief, rows, asked, position)
        return self.on_the_way(belief, rows, asked.start.speed_m_s)

    def before_the_crest(self, rows: Ints) -> Belief:
        """What is believed of the cuts `rows` before they roll."""
        wind = np.full(len(rows), self.prior.wind_std_m_s**2)
        of_square = self.prior.air_n_per_kn[rows] * wind
        variance = self.prior.std_n_per_kn[rows] ** 2 + 2.0 * of_square**2
        none = np.zeros(len(rows))
        return Belief(self.way.mean_n_per_kn[rows] + of_square, none, variance, wind, none)

    def measured(self, belief: Belief, rows: Ints, asked: Asked, position: int) -> Belief:
        """What is believed after the stretch ahead of `position`."""
        speeds = self.sensors.stretch(asked, position)
        square = 0.5 * (speeds.from_m_s**2 + speeds.to_m_s**2)
        speed, gravity = np.sqrt(square), self.way.gravity_m_s2[rows]
        taken = self.on_the_way(belief, rows, speed).mean_n_per_kn
        comes = self.way.comes_m_s(rows, asked.routes, speeds, taken)
        excess = speeds.resistance_n_per_kn(taken, comes, gravity) - taken
        place = asked.routes, position
        heads = (self.prior.bends_v2_m_s2[place] * square) ** 2 + self.prior.bends_head_m[place] ** 2
        of_bends = 1e6 * heads / np.maximum(speeds.length_m, SHORTEST_M) ** 2
        variance = speeds.std_n_per_kn(gravity) ** 2 + of_bends
        return belief.after(excess, self.prior.air_slope(rows, speed), variance)

    def on_the_way(self, belief: Belief, rows: Ints, speed_m_s: Floats) -> Resistance:
        """What is expected at `speed_m_s` (n,), air beyond that of the mean wind included."""
        slope = self.prior.air_slope(rows, speed_m_s)
        mean = belief.resistance_n_per_kn + slope * belief.wind_m_s
        return Resistance(mean, np.sqrt(belief.variance(slope)))


def measured_rollability(sensors: SpeedSensors, trains: TrainCuts, way: ExpectedWay) -> MeasuredRollability:
    """For the cuts of `trains`."""
    return MeasuredRollability(sensors, way, resistance_prior(sensors.routes, trains))
