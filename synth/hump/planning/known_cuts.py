"""Cuts as a control knows them before they roll: their list, and the resistances of their categories."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.rolling.car_mix import AXLES_OF_A_CATEGORY
from plant_models.rolling.random_cuts import DrawnCuts
from synth.hump.planning.forecast import Choices, Expected, Given
from synth.hump.planning.position_roles import Roles
from synth.hump.rolling.motion import Cars, KnownRolls, Rolls
from synth.hump.rolling.route_rolling import RouteWays, rolling_on
from synth.hump.rolling.train_cuts import TrainCuts, expected


@frozen_arrays
class KnownCuts:
    """All cuts of some trains, a row each: `rolls` with mean bends and wind; resistance: `mean_n_per_kn`, and that of
    good and of bad runners, `good_n_per_kn` and `bad_n_per_kn` (rows,). `aim` (rows,): exit speeds of
    positions that aim as they are expected before the train, and how fast cuts may come to them; `braked_m2_s2` (rows,
    positions): most loss of v² to the brake of each position. `rolled`: what was worked out of them before."""

    rolls: Rolls
    trains: int
    cuts: int
    route: Ints
    category: Ints
    length_m: Floats
    first_axle_m: Floats
    last_axle_m: Floats
    mean_n_per_kn: Floats
    good_n_per_kn: Floats
    bad_n_per_kn: Floats
    aim: Given
    braked_m2_s2: Floats
    rolled: KnownRolls

    def of_cut(self, cut: int) -> Ints:
        """Rows of cut number `cut` of every train."""
        return np.arange(self.trains) * self.cuts + cut

    def expected(self, rows: Ints, routes: Ints, resistance_n_per_kn: Floats) -> Expected:
        """The cuts `rows` on `routes`, with the resistance (n,) that is expected of them."""
        cars = Cars(self.rolls, rows, routes, resistance_n_per_kn)
        axles = self.first_axle_m[rows], self.last_axle_m[rows]
        return Expected(cars, *axles, self.braked_m2_s2[rows], self.rolled)

    def aim_of(self, rows: Ints) -> Given:
        """What a position that aims is expected to make of the cuts `rows`."""
        aim = self.aim
        most, least = (np.broadcast_to(m, len(aim.speed_m_s)) for m in (aim.most_entry_m_s, aim.least_entry_m_s))
        return Given(aim.speed_m_s[rows], most[rows], least[rows])

    def choices(self, rows: Ints, routes: Ints, roles: Roles, position: int = 0) -> tuple[Choices, ...]:
        """What the positions from `position` on may make of the cuts `rows` on `routes`, (n,) both."""
        kept = tuple(exits.choices(self.category[rows]) for exits in roles.exits[position:])
        return roles.aimed(kept, routes, self.aim_of(rows), position)


GOOD, BAD = 0.023, 0.977
"""Quantiles of runners that are good and bad: two standard deviations from the mean of a normal law."""


def known_cuts(trains: TrainCuts, ways: RouteWays, aim: Given, braked_m2_s2: Floats, threads: int = 0) -> KnownCuts:
    """`trains` as they are known before they roll on `ways`; `aim` (rows,): what they will be aimed with;
    `braked_m2_s2` (rows, positions)."""
    drawn = expected(trains)
    runners = Runners(
        drawn.resistance_n_per_kn, runner_n_per_kn(trains, drawn, GOOD), runner_n_per_kn(trains, drawn, BAD)
    )
    return known_as(trains, rolling_on(ways, trains.population, drawn, threads), runners, aim, braked_m2_s2)


@frozen_arrays
class Runners:
    """Resistances (rows,) that a control reckons with: of mean, good and bad cuts, N/kN."""

    mean_n_per_kn: Floats
    good_n_per_kn: Floats
    bad_n_per_kn: Floats


def known_as(trains: TrainCuts, rolls: Rolls, runners: Runners, aim: Given, braked_m2_s2: Floats) -> KnownCuts:
    """`trains`, which are expected to roll as in `rolls` with the resistances of `runners`."""
    return KnownCuts(
        rolls=rolls,
        trains=trains.trains,
        cuts=trains.cuts,
        route=trains.route,
        category=trains.category,
        length_m=trains.length_m,
        first_axle_m=trains.first_axle_m,
        last_axle_m=trains.last_axle_m,
        mean_n_per_kn=runners.mean_n_per_kn,
        good_n_per_kn=runners.good_n_per_kn,
        bad_n_per_kn=runners.bad_n_per_kn,
        aim=aim,
        braked_m2_s2=braked_m2_s2,
        rolled=KnownRolls(len(trains)),
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
