"""Controls of the positions: as planned before the train, or anew when a cut comes, from what is known by then of the
cuts on their way: when they will leave the elements, and from when on that is known.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.planning.aim_control import AimControl
from synth.hump.planning.forecast import Forecast, Given, entrance_m, from_crest, from_entrance
from synth.hump.planning.known_cuts import KnownCuts
from synth.hump.planning.position_roles import Roles
from synth.hump.planning.rollability import Rollability
from synth.hump.planning.speed_rules import centred, possible
from synth.hump.planning.train_plan import LEADERS, Planner, TrainPlan, apart_m, free_by_s, push_of, shared_needs
from synth.hump.rolling.hump_routes import HumpRoutes, Mark
from synth.hump.rolling.motion import Moving, Push
from synth.hump.rolling.train_memory import Asked, TrainMemory


class Sight:
    """Forecasts of each cut: at the crest, with each command, and with the speed after each pass.

    The simulation works cut by cut, so `TrainMemory` tells what lies in the future of a control. A forecast of this
    class holds nothing that is younger than itself, and only those are used that are older than the question.
    """

    def __init__(self, routes: HumpRoutes, known: KnownCuts, plan: TrainPlan, roles: Roles) -> None:
        self.routes, self.known, self.plan, self.roles = routes, known, plan, roles
        trains, cuts, positions = plan.exit_m_s.shape
        self.told = roles.not_of_all
        shape = trains, cuts, 1 + 2 * len(self.told)
        self.known_s, self.out_s = np.full(shape, np.inf), np.full((*shape, routes.elements), np.nan)
        self.chosen_m_s = np.repeat(plan.exit_m_s[:, :, None], positions, axis=2)
        mean = known.mean_n_per_kn.reshape(trains, cuts, 1)
        self.resistance_n_per_kn = np.repeat(mean, positions, axis=2)
        self.learnt = -1

    def decided(self, asked: Asked, resistance_n_per_kn: Floats, taken: Forecast) -> None:
        """A cut was given its command, as in the forecast `taken`, and is expected with this resistance."""
        lanes, cut, position = asked.lanes, asked.cut, asked.position
        version = 1 + 2 * self.told.index(position)
        self.chosen_m_s[lanes, cut, position, position:] = taken.exit_m_s
        self.resistance_n_per_kn[lanes, cut, position] = resistance_n_per_kn
        self.known_s[lanes, cut, version] = asked.start.time_s
        self.out_s[lanes, cut, version] = taken.last_out_s

    def learn(self, cut: int, memory: TrainMemory) -> None:
        """Add the forecasts of the cut ahead of number `cut`, once."""
        ahead = cut - 1
        if ahead < 0 or self.learnt >= ahead:
            return
        self.learnt = ahead
        known, rows = self.known, self.known.of_cut(ahead)
        start = Moving(0.5 * known.length_m[rows], memory.hump_speed_m_s[:, ahead], memory.crest_s[:, ahead])
        planned = tuple(Given(self.plan.exit_m_s[:, ahead, q]) for q in range(self.routes.positions))
        choices = self.roles.aimed(planned, known.route[rows], known.aim_of(rows))
        expected = known.expected(rows, known.route[rows], known.mean_n_per_kn[rows])
        push = push_of(known, memory.hump_speed_m_s, ahead)
        ways = from_crest(self.routes, expected, start, push, choices)
        self.known_s[:, ahead, 0], self.out_s[:, ahead, 0] = memory.crest_s[:, ahead], ways.followed().last_out_s
        for position in self.told:
            self.learn_pass(ahead, position, memory)

    def learn_pass(self, cut: int, position: int, memory: TrainMemory) -> None:
        """Add what the speed after a pass told; the next exit speeds are those that were chosen before it."""
        lanes = np.flatnonzero(np.isfinite(memory.end_s[:, cut, position]))
        if len(lanes) == 0:
            return
        rows, ended = lanes * self.known.cuts + cut, memory.end_s[lanes, cut, position]
        routes = self.routes_by(lanes, np.full(len(lanes), cut), ended, memory)
        expected = self.known.expected(rows, routes, self.resistance_n_per_kn[lanes, cut, position])
        head = np.maximum(entrance_m(self.routes, expected, position), 0.5 * self.known.length_m[rows])
        start = Moving(head, memory.entry_m_s[lanes, cut, position], memory.begin_s[lanes, cut, position])
        exits = memory.exit_m_s[lanes, cut, position]
        later = range(position + 1, self.routes.positions)
        next_m_s = tuple(Given(self.chosen_m_s[lanes, cut, position, q]) for q in later)
        behind = self.roles.aimed(next_m_s, routes, self.known.aim_of(rows), position + 1)
        told = from_entrance(self.routes, expected, start, position, (Given(exits), *behind)).followed()
        shift = ended - told.ended_s[:, 0]
        version = 2 + 2 * self.told.index(position)
        self.known_s[lanes, cut, version] = ended
        self.out_s[lanes, cut, version] = told.last_out_s + shift[:, None]

    def routes_by(self, lanes: Ints, cut: Ints, now_s: Floats, memory: TrainMemory) -> Ints:
        """Routes (n,) on which the cuts (n,) are at `now_s`, as far as one can see: their own until they are misrouted,
        or touch the cut ahead."""
        own, went = self.known.route[lanes * self.known.cuts + cut], memory.route[lanes, cut]
        at = np.minimum(memory.misrouted_at[lanes, cut], memory.contact_at[lanes, cut])
        lost = at < self.routes.elements
        when = memory.time_s[lanes, cut, np.where(lost, at, 0), Mark.FIRST_IN]
        return np.asarray(np.where(lost & (when <= now_s), went, own))

    def free_from_s(self, cut: int, lanes: Ints, own: Ints, now_s: Floats, memory: TrainMemory) -> Floats:
        """When the elements are free for cut number `cut` of the trains `lanes`, on the routes `own`, as far as that is
        known at `now_s`, all (n,): (n, elements), −∞ where nobody is ahead."""
        free = np.full((len(lanes), self.routes.elements), -np.inf)
        for leader in range(max(cut - LEADERS, 0), cut):
            other = self.routes_by(lanes, np.full(len(lanes), leader), now_s, memory)
            shared, needs = shared_needs(self.routes, own, other)
            leaves = self.leaves_s(leader, lanes, now_s, memory) + needs
            free = np.where(shared & ~np.isnan(leaves), np.maximum(free, leaves), free)
        return free

    def leaves_s(self, cut: int, lanes: Ints, now_s: Floats, memory: TrainMemory) -> Floats:
        """When cut number `cut` leaves the elements, as far as that is known at `now_s`, (n, elements)."""
        now = now_s[:, None]
        left = memory.time_s[lanes, cut, :, Mark.LAST_OUT]
        best = self.out_s[lanes, cut, 0]
        for version in range(1, self.known_s.shape[2]):
            told = self.out_s[lanes, cut, version]
            newer = (self.known_s[lanes, cut, version, None] <= now) & ~np.isnan(told)
            best = np.where(newer, told, best)
        return np.asarray(np.where(left <= now, left, np.maximum(best, now)))


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
