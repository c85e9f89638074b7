"""What a control knows of cuts on their way: when they will leave the elements, and from when on it knows that."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.hump.trains.asked import Asked
from synth.hump.trains.forecast import Forecast, Given, entrance_m, from_crest, from_entrance
from synth.hump.trains.hump_routes import HumpRoutes, Mark
from synth.hump.trains.known_cuts import KnownCuts
from synth.hump.trains.motion import Moving
from synth.hump.trains.position_roles import Roles
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_plan import LEADERS, TrainPlan, push_of, shared_needs


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
