"""Triples of single cars: a bad runner ahead of a good one ahead of a bad one, to every two tracks of a hump."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.design.hump_under_test import HumpUnderTest
from synth.hump.design_runners import DesignRunner, bad_runner, good_runner, single_cars
from synth.hump.planning.forecast import Given
from synth.hump.planning.interval_control import ProgramSpeeds
from synth.hump.planning.known_cuts import KnownCuts, Runners, known_as
from synth.hump.planning.train_plan import TrainPlan, shared_needs
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.humping import Hump, humped
from synth.hump.rolling.route_rolling import RouteRolling, rolling_on
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import Asked, TrainMemory
from synth.hump.trains.train_trace import TrainTrace, train_trace
from synth.hump.trial.trial import reduced_gravity_m_s2

CARS: Final = 3
"""Of a triple."""

GOOD: Final = 1
"""Which of them is the good runner."""

PAIRS: Final = ((0, 1), (1, 2), (0, 2))
"""Its cuts, (ahead, behind), between which there is an interval: bad–good, good–bad, bad–bad."""


@frozen_arrays
class Triples:
    """Triples on `hump`, `route` (t, 3): rows of the routes of their cuts. Build them with `triples`.

    `trains`: their cuts, which roll as in `rolls`; `known`: the same as a control knows them, which is exactly.
    """

    hump: HumpUnderTest
    route: Ints
    trains: TrainCuts
    rolls: RouteRolling
    known: KnownCuts

    def __len__(self) -> int:
        return len(self.route)

    def chosen(self, which: Ints) -> Triples:
        """Those of the rows `which` (n,)."""
        return triples(self.hump, self.route[which])

    def planned(self, hump_speed_m_s: Floats) -> TrainPlan:
        """Exit speeds where the triples are pushed at `hump_speed_m_s` (t,)."""
        speeds = np.repeat(hump_speed_m_s[:, None], CARS, axis=1)
        return self.hump.planner.at_speeds(self.known, speeds)

    def alone(self, plan: TrainPlan) -> TrainMemory:
        """The same cuts with the exit speeds of `plan`, none of which meets another: each is a train of its own."""
        count, routes = len(self.trains), self.hump.routes
        single = replace(self.trains, trains=count, cuts=1)
        exits = plan.exit_m_s.reshape(count, 1, -1)
        speeds = ProgramSpeeds(plan.hump_speed_m_s.reshape(count, 1))
        return humped(Hump(routes, self.hump.positions, self.rolls), single, self._free_m(count), speeds, Told(exits))

    def together(self, plan: TrainPlan) -> TrainTrace:
        """The only triple as it would be humped: points that are too late send a cut the wrong way."""
        hump = Hump(self.hump.routes, self.hump.positions, self.rolls)
        speeds = ProgramSpeeds(plan.hump_speed_m_s)
        memory = humped(hump, self.trains, self._free_m(len(self)), speeds, Told(plan.exit_m_s))
        return train_trace(hump, self.trains, memory, 0)

    def _free_m(self, trains: int) -> Floats:
        """All tracks are free."""
        return np.tile(self.hump.routes.length_m, (trains, 1))


@frozen_arrays
class Told:
    """Exit speeds (trains, cuts, positions) that are told before, of whatever position."""

    exit_m_s: Floats

    def command(self, asked: Asked) -> Floats:
        """See `ExitSpeeds`."""
        return np.asarray(self.exit_m_s[asked.lanes, asked.cut, asked.position])


def pairs_of(routes: HumpRoutes) -> Ints:
    """Every two routes that part, (t, 3): bad runners go the first way, the good one the second."""
    count = len(routes.routes)
    first, second = np.nonzero(~np.eye(count, dtype=bool))
    return np.stack((first, second, first), axis=1)


def triples(hump: HumpUnderTest, route: Ints) -> Triples:
    """Those on the routes `route` (t, 3)."""
    asked, population = hump.asked, hump.population
    bad, good = bad_runner(asked), good_runner(asked)
    runners = [bad, good, bad] * len(route)
    drawn = single_cars(population, runners, hump.ways.bends)
    rows = route.reshape(-1)
    trains = TrainCuts(
        population=replace(population, categories=hump.categories),
        seed=0,
        first=0,
        trains=len(route),
        cuts=CARS,
        drawn=drawn,
        route=rows,
        track=hump.routes.tracks[rows],
        category=np.array([hump.place_of(runner) for runner in runners]),
        mass_t=drawn.cut_mass_t,
    )
    rolls = rolling_on(hump.ways, trains.population, drawn)
    return Triples(hump, route, trains, rolls, known_exactly(hump, trains, rolls, runners))


def known_exactly(
    hump: HumpUnderTest, trains: TrainCuts, rolls: RouteRolling, runners: list[DesignRunner]
) -> KnownCuts:
    """`trains` as a control knows them whose resistance is known.

    Where a position aims, the track is full for the good runner, which must leave it as slowly as it may couple, and
    empty for the bad one, which is not braked.
    """
    heads = {runner: hump.heads_m(runner) for runner in set(runners)}
    braked = 2.0 * reduced_gravity_m_s2(trains)[:, None] * np.stack([heads[runner] for runner in runners])
    good = np.array([runner.name == "good" for runner in runners])
    last = hump.routes.positions_of[trains.route] - 1
    of_last = braked[np.arange(len(trains)), last]
    aim = Given(
        np.where(good, hump.allowed_m_s, np.inf), np.where(good, np.sqrt(hump.allowed_m_s**2 + of_last), np.inf)
    )
    resistance = trains.drawn.resistance_n_per_kn
    return known_as(trains, rolls, Runners(resistance, resistance, resistance), aim, braked)


def margins_s(triples: Triples, plan: TrainPlan) -> Floats:
    """How much later than needed the cut behind of each of `PAIRS` comes to each element, (t, pairs, elements): its
    first axle in, less the last axle of the cut ahead out, less what the points need between them.

    Infinite where they share no element, −∞ behind a cut that stands on the way.
    """
    routes, route = triples.hump.routes, triples.route
    found = np.full((len(triples), len(PAIRS), routes.elements), np.inf)
    for place, (ahead, behind) in enumerate(PAIRS):
        shared, needs = shared_needs(routes, route[:, ahead], route[:, behind])
        shared = shared & (routes.vertex[route[:, ahead]] >= 0)
        comes, leaves = plan.first_in_s[:, behind], plan.last_out_s[:, ahead]
        stands = shared & ~np.isfinite(leaves) & ~np.isnan(leaves)
        counts = shared & np.isfinite(comes) & np.isfinite(leaves)
        np.subtract(comes, leaves + needs, out=found[:, place], where=counts)
        found[:, place][stands] = -np.inf
    return found
