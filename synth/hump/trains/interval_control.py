"""Controls of the positions: as planned before the train, or anew when a cut comes, from what is measured by then."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.trains.aim_control import AimControl
from synth.hump.trains.asked import Asked
from synth.hump.trains.forecast import from_crest, from_entrance
from synth.hump.trains.interval import centred, possible
from synth.hump.trains.known_cuts import KnownCuts
from synth.hump.trains.motion import Moving, Push
from synth.hump.trains.position_roles import Roles
from synth.hump.trains.rollability import Rollability
from synth.hump.trains.sight import Sight
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_plan import Planner, TrainPlan, apart_m, free_by_s


@frozen_arrays
class ProgramSpeeds:
    """Hump speeds by a program, `speed_m_s` (trains, cuts)."""

    speed_m_s: Floats

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """That of the program."""
        return np.asarray(self.speed_m_s[:, cut])


def by_role(asked: Asked, roles: Roles, aim: AimControl, chosen: Callable[[Asked], Floats]) -> Floats:
    """Exit speeds (n,): by `aim` where the position aims on the route on which a cut rolls by now; else what is fixed,
    or what is `chosen`."""

    def kept(asked: Asked) -> Floats:
        fixed = roles.exits[asked.position].fixed_m_s(aim.trains.category[asked.lanes * aim.trains.cuts + asked.cut])
        return chosen(asked) if fixed is None else fixed

    aims = roles.aims[asked.position][asked.routes]
    if aims.all():
        return aim.command(asked)
    if not aims.any():
        return kept(asked)
    found = np.empty(len(aims))
    found[aims], found[~aims] = aim.command(asked.chosen(aims)), kept(asked.chosen(~aims))
    return found


@dataclass(frozen=True)
class OpenLoop:
    """Exit speeds as planned, for the track of the list; but a cut is aimed by the route on which it rolls."""

    plan: TrainPlan
    roles: Roles
    aim: AimControl

    def command(self, asked: Asked) -> Floats:
        """See the class."""
        return by_role(asked, self.roles, self.aim, self.planned)

    def planned(self, asked: Asked) -> Floats:
        """What the plan has."""
        return np.asarray(self.plan.exit_m_s[asked.lanes, asked.cut, asked.position])


class Feedback:
    """Exit speeds chosen when a cut comes: from its own motion, and from where the cuts ahead of it are by then.

    The cuts behind are expected as planned, later by what this cut was later over the crest. `rollability` tells the
    resistance of each cut from what was measured of it.
    """

    def __init__(
        self, planner: Planner, known: KnownCuts, plan: TrainPlan, rollability: Rollability, aim: AimControl
    ) -> None:
        self.planner, self.known, self.plan = planner, known, plan
        self.rollability, self.aim = rollability, aim
        self.sight = Sight(planner.routes, known, plan, planner.roles)

    def command(self, asked: Asked) -> Floats:
        """Exit speeds (n,), by the role of the position on the route on which a cut rolls."""
        return by_role(asked, self.planner.roles, self.aim, self.chosen)

    def chosen(self, asked: Asked) -> Floats:
        """Exit speeds (n,) of cuts that a position keeps apart."""
        routes = self.planner.routes
        cut, lanes, memory = asked.cut, asked.lanes, asked.memory
        self.sight.learn(cut, memory)
        rows = lanes * self.known.cuts + cut
        resistance = self.rollability(asked)
        expected = self.known.expected(rows, asked.routes, resistance)
        choices = self.known.choices(rows, asked.routes, self.planner.roles, asked.position)
        ways = from_entrance(routes, expected, asked.start, asked.position, choices)
        later = (memory.crest_s[lanes, cut] - self.plan.crest_s[lanes, cut])[:, None]
        free_by = later + free_by_s(routes, self.known, self.plan.first_in_s, asked.routes, lanes, cut)
        free_from = self.sight.free_from_s(cut, lanes, asked.routes, asked.start.time_s, memory)
        taken = ways.followed(centred(ways.compared(free_from, free_by)))
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
        ways = from_crest(routes, expected, start, push, known.choices(rows, own, feedback.planner.roles))
        free_from = feedback.sight.free_from_s(cut, lanes, own, now, memory)
        compared = ways.compared(free_from, np.full(free_from.shape, np.inf))
        return np.asarray(np.where(possible(compared), compared.ahead_s, -np.inf).max(axis=1))
