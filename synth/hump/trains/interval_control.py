"""Controls of the positions: as planned before the train, or anew when a cut comes, from what is measured by then."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.hump.trains.aim_control import AimControl
from synth.hump.trains.asked import Asked
from synth.hump.trains.forecast import from_crest, from_entrance
from synth.hump.trains.interval import IntervalRule, possible
from synth.hump.trains.known_cuts import KnownCuts
from synth.hump.trains.motion import Moving, Push
from synth.hump.trains.rollability import Rollability
from synth.hump.trains.route_choices import Choices
from synth.hump.trains.sight import Sight
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_plan import Planner, TrainPlan, apart_m, free_by_s

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


def by_position(asked: Asked, aim: AimControl, kept: Callable[[Asked], Floats]) -> Floats:
    """Exit speeds (n,): by `aim` of the cuts for which it is the last position of the route on which they roll by now,
    of all others what `kept` commands."""
    last = aim.routes.positions_of[asked.routes] == asked.position + 1
    if last.all():
        return aim.command(asked)
    if not last.any():
        return kept(asked)
    found = np.empty(len(last))
    found[last], found[~last] = aim.command(asked.chosen(last)), kept(asked.chosen(~last))
    return found


@dataclass(frozen=True)
class OpenLoop:
    """Exit speeds as planned, for the track of the list; the last position of the route on which a cut rolls aims."""

    plan: TrainPlan
    aim: AimControl

    def command(self, asked: Asked) -> Floats:
        """See the class."""
        return by_position(asked, self.aim, self.planned)

    def planned(self, asked: Asked) -> Floats:
        """What the plan has."""
        return np.asarray(self.plan.exit_m_s[asked.lanes, asked.cut, asked.position])


class Feedback:
    """Exit speeds chosen when a cut comes: from its own motion, and from where the cuts ahead of it are by then.

    The cuts behind are expected as planned, later by what this cut was later over the crest. `rollability` tells the
    resistance of each cut from what was measured of it.
    """

    def __init__(
        self,
        planner: Planner,
        known: KnownCuts,
        plan: TrainPlan,
        rule: IntervalRule,
        rollability: Rollability,
        aim: AimControl,
    ) -> None:
        self.planner, self.known, self.plan = planner, known, plan
        self.rule, self.rollability, self.aim = rule, rollability, aim
        self.sight = Sight(planner.routes, known, plan)

    def command(self, asked: Asked) -> Floats:
        """Exit speeds (n,); the last position of the route on which a cut rolls aims."""
        return by_position(asked, self.aim, self.chosen)

    def chosen(self, asked: Asked) -> Floats:
        """Exit speeds (n,) of cuts that go on to another position."""
        routes, ranges = self.planner.routes, self.planner.ranges
        cut, lanes, memory = asked.cut, asked.lanes, asked.memory
        self.sight.learn(cut, memory)
        rows = lanes * self.known.cuts + cut
        resistance = self.rollability.resistance_n_per_kn(asked)
        expected = self.known.expected(rows, asked.routes, resistance)
        choices: tuple[Choices, ...] = (*ranges[asked.position :], self.known.aim_of(rows))
        ways = from_entrance(routes, expected, asked.start, asked.position, choices)
        later = (memory.crest_s[lanes, cut] - self.plan.crest_s[lanes, cut])[:, None]
        free_by = later + free_by_s(routes, self.known, self.plan.first_in_s, asked.routes, lanes, cut)
        free_from = self.sight.free_from_s(cut, lanes, asked.routes, asked.start.time_s, memory)
        taken = ways.followed(self.rule.best(ways.compared(free_from, free_by)))
        self.sight.decided(asked, resistance, taken)
        return np.asarray(taken.exit_m_s[:, 0])


@dataclass(frozen=True)
class FeedbackSpeeds:
    """Hump speeds of the plan, but slower for a cut that would come closer than `keep_s` to those ahead of it, by what
    is known of these when the cut before it is let go; as slow as the locomotive can be by then."""

    feedback: Feedback
    keep_s: float

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """See `HumpSpeeds`."""
        plan, limits = self.feedback.plan, self.feedback.planner.limits
        speed = plan.hump_speed_m_s[:, cut].copy()
        if cut == 0:
            return speed
        self.feedback.sight.learn(cut, memory)
        before, steps = memory.hump_speed_m_s[:, cut - 1], np.array(limits.steps_m_s)
        apart = apart_m(self.feedback.known)[:, cut]
        change = 2.0 * limits.acceleration_m_s2 * apart
        # after a cut that was slowed down the train cannot be as fast again at once
        fastest = np.sqrt(before**2 + change)
        speed = np.minimum(speed, fastest)
        lowest = np.maximum(steps[0], np.sqrt(np.maximum(before**2 - change, 0.0)))
        pending = np.arange(len(speed))
        while len(pending):
            margin = self.margin_s(cut, pending, speed[pending], apart[pending], memory)
            pending = pending[(margin < self.keep_s) & (speed[pending] > lowest[pending])]
            below = np.searchsorted(steps, speed[pending] - 1e-9) - 1
            speed[pending] = np.maximum(steps[np.maximum(below, 0)], lowest[pending])
        return speed

    def margin_s(self, cut: int, lanes: Ints, speed_m_s: Floats, apart_m: Floats, memory: TrainMemory) -> Floats:
        """The largest margin (n,) to the cuts ahead that some choice of exit speeds gives at `speed_m_s` (n,)."""
        feedback = self.feedback
        known, routes = feedback.known, feedback.planner.routes
        rows, now = lanes * known.cuts + cut, memory.crest_s[lanes, cut - 1]
        own = known.route[rows]
        time = now + 2.0 * apart_m / (speed_m_s + memory.hump_speed_m_s[lanes, cut - 1])
        expected = known.expected(rows, own, known.mean_n_per_kn[rows])
        start = Moving(0.5 * known.length_m[rows], speed_m_s, time)
        push = Push(memory.hump_speed_m_s[lanes, cut - 1], apart_m)
        ways = from_crest(routes, expected, start, push, (*feedback.planner.ranges, known.aim_of(rows)))
        free_from = feedback.sight.free_from_s(cut, lanes, own, now, memory)
        compared = ways.compared(free_from, np.full(free_from.shape, np.inf))
        return np.asarray(np.where(possible(compared), compared.ahead_s, -np.inf).max(axis=1))
