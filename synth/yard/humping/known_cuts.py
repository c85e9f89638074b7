"""Cuts as a control knows them before they roll: their list, and the resistances of their categories."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from plant_models.rolling.car_mix import AXLES_OF_A_CATEGORY
from plant_models.rolling.random_cuts import DrawnCuts
from synth.yard.humping.forecast import Expected, Given
from synth.yard.humping.motion import Cars, Rolls
from synth.yard.humping.route_rolling import rolling_on
from synth.yard.humping.route_ways import RouteWays
from synth.yard.humping.train_cuts import TrainCuts, expected

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@frozen_arrays
@dataclass(frozen=True, eq=False)
class KnownCuts:
    """All cuts of some trains, a row each: `rolls` with mean bends and wind; resistance: `mean_n_per_kn`, and that of
    good and of bad runners, `good_n_per_kn` and `bad_n_per_kn` (rows,). `aim_m_s`: the exit speed of the last position
    by the aim, as it is expected before the train, and `most_entry_m_s` there."""

    rolls: Rolls
    trains: int
    cuts: int
    route: Ints
    length_m: Floats
    first_axle_m: Floats
    last_axle_m: Floats
    mean_n_per_kn: Floats
    good_n_per_kn: Floats
    bad_n_per_kn: Floats
    aim_m_s: Floats
    most_entry_m_s: Floats

    def of_cut(self, cut: int) -> Ints:
        """Rows of cut number `cut` of every train."""
        return np.arange(self.trains) * self.cuts + cut

    def expected(self, rows: Ints, routes: Ints, resistance_n_per_kn: Floats) -> Expected:
        """The cuts `rows` on `routes`, with the resistance (n,) that is expected of them."""
        cars = Cars(self.rolls, rows, routes, resistance_n_per_kn)
        return Expected(cars, self.first_axle_m[rows], self.last_axle_m[rows])

    def aim(self, rows: Ints) -> Given:
        """What the last position is expected to make of the cuts `rows`."""
        return Given(self.aim_m_s[rows], self.most_entry_m_s[rows])


GOOD, BAD = 0.023, 0.977
"""Quantiles of runners that are good and bad: two standard deviations from the mean of a normal law."""


def known_cuts(
    trains: TrainCuts, ways: RouteWays, aim_m_s: Floats, most_entry_m_s: Floats, threads: int = 0
) -> KnownCuts:
    """`trains` as they are known before they roll on `ways`, with the exit speeds that they will be aimed with."""
    drawn = expected(trains)
    rolls = rolling_on(ways, trains.population, drawn, threads)
    return KnownCuts(
        rolls=rolls,
        trains=trains.trains,
        cuts=trains.cuts,
        route=trains.route,
        length_m=trains.length_m,
        first_axle_m=trains.first_axle_m,
        last_axle_m=trains.last_axle_m,
        mean_n_per_kn=drawn.resistance_n_per_kn,
        good_n_per_kn=runner_n_per_kn(trains, drawn, GOOD),
        bad_n_per_kn=runner_n_per_kn(trains, drawn, BAD),
        aim_m_s=aim_m_s,
        most_entry_m_s=most_entry_m_s,
    )


def runner_n_per_kn(trains: TrainCuts, drawn: DrawnCuts, quantile: float) -> Floats:
    """Resistance of good or bad cuts (rows,). Their cars are drawn one by one, so a cut is nearer to the mean than a
    car by the root of Σ shares² of its masses."""
    people, mean = trains.population, drawn.resistance_n_per_kn
    on_four_axles = trains.mass_t * AXLES_OF_A_CATEGORY / trains.axles
    single = np.empty(len(mean))
    for place, category in enumerate(people.categories.members):
        of_it = trains.category == place
        u = np.full(int(of_it.sum()), quantile)
        single[of_it] = people.law.basic_n_per_kn(
            category.resistance, on_four_axles[of_it], people.weather.temperature_c, u
        )
    return np.asarray(mean + (single - mean) * np.sqrt((drawn.shares**2).sum(axis=1)))
