"""How sure the resistance of cuts is before they roll: spreads of w0, wind and bends."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.rolling.car_mix import AXLES_OF_A_CATEGORY
from plant_models.rolling.random_cuts import CutPopulation, bend_scales_m
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.train_cuts import TrainCuts


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
