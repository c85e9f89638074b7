"""The resistance that a control expects of cuts when they come to a position, and how sure it is before they roll:
spreads of w0, wind and bends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.rolling.car_mix import AXLES_OF_A_CATEGORY
from plant_models.rolling.random_cuts import CutPopulation, bend_scales_m
from synth.hump.planning.free_stretch import SHORTEST_M, ExpectedWay, SpeedSensors
from synth.hump.planning.known_cuts import KnownCuts
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import Asked


@frozen_arrays
class ResistancePrior:
    """Before any measurement, (rows,): standard deviation of w0, and air of a cut per (m/s)². Head wind: normal.

    `bends_v2_m_s2`, `bends_head_m` (routes, positions): standard deviations of the heads that all bends between a
    position and the one before it take together, per (m/s)² and whatever the speed.
    """

    std_n_per_kn: Floats
    air_n_per_kn: Floats
    wind_mean_m_s: float
    wind_std_m_s: float
    bends_v2_m_s2: Floats
    bends_head_m: Floats

    def air_slope(self, rows: Ints, speed_m_s: Floats) -> Floats:
        """How much more the air takes for each m/s that the wind is above its mean, N/kN, (n,)."""
        return np.asarray(2.0 * self.air_n_per_kn[rows] * np.abs(speed_m_s + self.wind_mean_m_s))


def resistance_prior(routes: HumpRoutes, trains: TrainCuts) -> ResistancePrior:
    """The prior of the cuts of `trains`, of which a list tells mass, axles and cars.

    The cars of a cut are independent: σ of its w0 is that of one car, times √Σq²/Σq for masses q that go by axles.
    """
    people = trains.population
    on_four_axles = trains.mass_t * AXLES_OF_A_CATEGORY / trains.axles
    std = np.empty(len(trains))
    for place, member in enumerate(people.categories.members):
        of_it = trains.category == place
        std[of_it] = people.law.std_basic_n_per_kn(
            member.resistance, on_four_axles[of_it], people.weather.temperature_c
        )
    shares = trains.car_axles / trains.axles[:, None]
    bends = bend_spreads(routes, people)
    return ResistancePrior(
        std_n_per_kn=std * np.sqrt((shares**2).sum(axis=1)),
        air_n_per_kn=trains.drawn.air_n_per_kn,
        wind_mean_m_s=people.weather.head_wind_mean_m_s,
        wind_std_m_s=people.weather.head_wind_std_m_s,
        bends_v2_m_s2=bends[..., 0],
        bends_head_m=bends[..., 1],
    )


def bend_spreads(routes: HumpRoutes, population: CutPopulation) -> Floats:
    """Standard deviations of the heads of the bends ahead of each position, (routes, positions, 2)."""
    spreads = np.zeros((*routes.entrance_m.shape, 2))
    for row, route in enumerate(routes.routes):
        bends = route.roll_track.bends
        squares = (bend_scales_m(population.law, bends) * population.law.std_bend_draw) ** 2
        middles = np.array([0.5 * (bend.from_m + bend.to_m) for bend in bends])
        begins = np.concatenate(([0.0], routes.exit_m[row, :-1]))
        for position, (begin, end) in enumerate(zip(begins, routes.entrance_m[row], strict=True)):
            spreads[row, position] = squares[(middles > begin) & (middles < end)].sum(axis=0)
    return np.sqrt(spreads)


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
