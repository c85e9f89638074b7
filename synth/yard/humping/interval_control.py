"""Controls of the positions: as planned before the train, or anew when a cut comes, from what is measured by then."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.yard.humping.aim_control import AimControl
from synth.yard.humping.forecast import Choices, Expected, Forecast, Given, SpeedRange, from_crest, from_entrance
from synth.yard.humping.hump_routes import HumpRoutes, Mark
from synth.yard.humping.humping import Asked
from synth.yard.humping.interval import IntervalRule
from synth.yard.humping.known_cuts import KnownCuts
from synth.yard.humping.motion import Moving
from synth.yard.humping.rollability import Rollability
from synth.yard.humping.train_memory import TrainMemory
from synth.yard.humping.train_plan import TrainPlan, free_by_s

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@frozen_arrays
@dataclass(frozen=True, eq=False)
class ProgramSpeeds:
    """Hump speeds by a program, `speed_m_s` (trains, cuts)."""

    speed_m_s: Floats

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """That of the program."""
        return np.asarray(self.speed_m_s[:, cut])


@dataclass(frozen=True)
class OpenLoop:
    """Exit speeds of the interval positions as planned; the last position aims."""

    plan: TrainPlan
    aim: AimControl

    def command(self, asked: Asked) -> Floats:
        """See the class."""
        if asked.position >= self.plan.exit_m_s.shape[2]:
            return self.aim.command(asked)
        return np.asarray(self.plan.exit_m_s[asked.lanes, asked.cut, asked.position])


class Feedback:
    """Exit speeds chosen when a cut comes: from its own motion, and from where the cuts ahead of it are by then.

    The cut behind is expected as planned. `rollability` tells the resistance of each cut from what was measured of it.
    """

    def __init__(
        self,
        routes: HumpRoutes,
        known: KnownCuts,
        plan: TrainPlan,
        ranges: tuple[SpeedRange, ...],
        rule: IntervalRule,
        rollability: Rollability,
        aim: AimControl,
    ) -> None:
        self.routes, self.known, self.plan, self.ranges = routes, known, plan, ranges
        self.rule, self.rollability, self.aim = rule, rollability, aim
        self.sight = Sight(routes, known, plan)

    def command(self, asked: Asked) -> Floats:
        """Exit speeds of the interval positions; the last position aims."""
        if asked.position >= len(self.ranges):
            return self.aim.command(asked)
        self.sight.learn(asked.cut, asked.memory)
        rows = asked.lanes * self.known.cuts + asked.cut
        resistance = self.rollability.resistance_n_per_kn(asked)
        expected = self.known.expected(rows, asked.routes, resistance)
        choices: tuple[Choices, ...] = (*self.ranges[asked.position :], self.known.aim_of(rows))
        ways = from_entrance(self.routes, expected, asked.start, asked.position, choices)
        first_in = self.plan.first_in_s
        free_by = free_by_s(self.routes, self.known, first_in, asked.routes, asked.lanes, asked.cut)
        taken = ways.followed(self.rule.best(ways.compared(self.sight.free_from_s(asked), free_by)))
        self.sight.decided(asked, resistance, taken)
        return np.asarray(taken.exit_m_s[:, 0])


class Sight:
    """What the control knows of when cuts leave the elements: forecasts of each cut, and from when on they are known.

    For each cut and position three forecasts: from the crest, with each command, and with the speed after each pass.
    """

    def __init__(self, routes: HumpRoutes, known: KnownCuts, plan: TrainPlan) -> None:
        self.routes, self.known, self.plan = routes, known, plan
        shape = known.trains, known.cuts, 1 + 2 * plan.exit_m_s.shape[2]
        self.known_s, self.out_s = np.full(shape, np.inf), np.full((*shape, routes.elements), np.nan)
        self.planned_m_s = plan.exit_m_s.copy()
        self.resistance_n_per_kn = known.mean_n_per_kn.reshape(known.trains, known.cuts).copy()
        self.learnt = -1

    def decided(self, asked: Asked, resistance_n_per_kn: Floats, taken: Forecast) -> None:
        """A cut was given its command, as in the forecast `taken`, and will be expected with this resistance."""
        lanes, cut, column = asked.lanes, asked.cut, 1 + 2 * asked.position
        self.planned_m_s[lanes, cut, asked.position :] = taken.exit_m_s[:, :-1]
        self.resistance_n_per_kn[lanes, cut] = resistance_n_per_kn
        self.known_s[lanes, cut, column] = asked.start.time_s
        self.out_s[lanes, cut, column] = taken.last_out_s

    def learn(self, cut: int, memory: TrainMemory) -> None:
        """Add what was to be seen of the cut ahead of number `cut`, once."""
        ahead = cut - 1
        if ahead < 0 or self.learnt >= ahead:
            return
        self.learnt = ahead
        rows = self.known.of_cut(ahead)
        start = Moving(0.5 * self.known.length_m[rows], memory.hump_speed_m_s[:, ahead], memory.crest_s[:, ahead])
        planned = (Given(self.plan.exit_m_s[:, ahead, q]) for q in range(self.plan.exit_m_s.shape[2]))
        expected = self.known.expected(rows, self.known.route[rows], self.known.mean_n_per_kn[rows])
        ways = from_crest(self.routes, expected, start, (*planned, self.known.aim_of(rows)))
        self.known_s[:, ahead, 0] = memory.crest_s[:, ahead]
        self.out_s[:, ahead, 0] = ways.followed().last_out_s
        for position in range(self.plan.exit_m_s.shape[2]):
            self.learn_pass(ahead, position, memory)

    def learn_pass(self, cut: int, position: int, memory: TrainMemory) -> None:
        """Add what the speed after a pass told."""
        lanes = np.flatnonzero(np.isfinite(memory.end_s[:, cut, position]))
        rows = lanes * self.known.cuts + cut
        routes, column = memory.route[lanes, cut], 2 + 2 * position
        expected = self.known.expected(rows, routes, self.resistance_n_per_kn[lanes, cut])
        head = self.routes.entrance_m[routes, position] + expected.first_axle_m
        start = Moving(head, memory.entry_m_s[lanes, cut, position], memory.begin_s[lanes, cut, position])
        speeds = [memory.exit_m_s[lanes, cut, position]]
        speeds += [self.planned_m_s[lanes, cut, q] for q in range(position + 1, self.planned_m_s.shape[2])]
        choices = (*(Given(speed) for speed in speeds), self.known.aim_of(rows))
        ways = from_entrance(self.routes, expected, start, position, choices)
        ended = expected_end_s(self.routes, expected, start, speeds[0], position)
        shift = memory.end_s[lanes, cut, position] - ended
        self.known_s[lanes, cut, column] = memory.end_s[lanes, cut, position]
        self.out_s[lanes, cut, column] = ways.followed().last_out_s + shift[:, None]

    def free_from_s(self, asked: Asked) -> Floats:
        """When the elements are free for the cut that asks, as far as that is known by now, (n, elements)."""
        lane, now = asked.lanes[:, None], asked.start.time_s[:, None]
        cut = asked.ahead.cut
        somebody, leader = cut >= 0, np.maximum(cut, 0)
        column = np.arange(self.out_s.shape[3])[None, :]
        leaves = asked.memory.time_s[lane, leader, column, Mark.LAST_OUT]
        seen = leaves <= now
        best = self.out_s[lane, leader, 0, column]
        for version in range(1, self.known_s.shape[2]):
            told = self.out_s[lane, leader, version, column]
            newer = (self.known_s[lane, leader, version] <= now) & ~np.isnan(told)
            best = np.where(newer, told, best)
        leaves = np.where(seen, leaves, np.maximum(best, now))
        points = self.routes.points[asked.routes]
        parts = somebody & (points >= 0) & (points != asked.ahead.points)
        return np.where(somebody, leaves + np.where(parts, self.routes.throw_s[asked.routes], 0.0), -np.inf)


def expected_end_s(routes: HumpRoutes, expected: Expected, start: Moving, exit_m_s: Floats, position: int) -> Floats:
    """When a pass at an even rate would end."""
    path = routes.exit_m[expected.cars.routes, position] + expected.last_axle_m - start.head_m
    return np.asarray(start.time_s + 2.0 * path / (start.speed_m_s + exit_m_s))
