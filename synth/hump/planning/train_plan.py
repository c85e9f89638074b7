"""The plan of a train before it is humped: hump speeds, and exit speeds of the interval positions.

Every pair is simulated, and the hump speeds are the fastest with which some choice of exit speeds keeps the cut behind
from the cut ahead by the least interval. Then the exit speeds are chosen anew, each cut in the middle between both.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.planning.forecast import Given, from_crest
from synth.hump.planning.known_cuts import KnownCuts
from synth.hump.planning.position_roles import Roles
from synth.hump.planning.speed_rules import (
    HumpSpeedLimits,
    IntervalRule,
    SpeedMethod,
    centred,
    early,
    possible,
    whole_train,
)
from synth.hump.rolling.hump_routes import HumpRoutes, Mark
from synth.hump.rolling.meeting import Ahead, LastUsers
from synth.hump.rolling.motion import Moving, Push

LEADERS = 4
"""Cuts ahead whose headways are told one by one."""

SHORT_COSTS, NEARLY_S, MOST_SHORT_S = 60.0, 0.05, 30.0
"""Seconds over the crest that a second of an interval is worth; what it may be too short; and most that counts."""

FOLLOWERS = 3
"""Cuts behind that a cut looks at: a long one leaves late what not the next cut, but the one after it needs."""


@frozen_arrays
class TrainPlan:
    """The plan of some trains, (trains, cuts): `crest_s`, `hump_speed_m_s`, `margin_s`: the largest to those ahead that
    some choice of exit speeds gives; with it, `margins_s` (…, leaders) to the cut 1, 2, … ahead.

    `exit_m_s` (…, positions): exit speeds. `first_in_s`, `last_out_s` (…, elements): of the
    elements up to the end of the last position.
    """

    crest_s: Floats
    hump_speed_m_s: Floats
    margin_s: Floats
    margins_s: Floats
    exit_m_s: Floats
    first_in_s: Floats
    last_out_s: Floats


@dataclass(frozen=True)
class Planner:
    """Plans trains on `routes`, whose positions have the `roles`.

    `least_s`: the interval that a pair must keep at its worst element; `early_s`: of it, what a cut keeps to the cut
    ahead when those behind wait for it. `worst_pair`: a bad runner ahead and a good one behind (2.3 and 97.7 % of their
    categories), not two mean ones. Headways and speeds are worked out from one another in so many `fits`;
    in the `repairs` that follow headways only grow, where speeds that changed elsewhere had made a pair too close.
    """

    routes: HumpRoutes
    limits: HumpSpeedLimits
    roles: Roles
    least_s: float = 0.5
    early_s: float = 0.2
    worst_pair: bool = False
    method: SpeedMethod = whole_train
    fits: int = 2
    repairs: int = 3

    def plan(self, known: KnownCuts) -> TrainPlan:
        """The plan with the fastest hump speeds that keep the interval; of all turns, the best one for each train. With
        one step there is no choice."""
        if len(self.limits.steps_m_s) == 1:
            return self.at_speeds(known, np.full((known.trains, known.cuts), self.limits.steps_m_s[0]))
        speeds = np.full((known.trains, known.cuts), self.limits.steps_m_s[len(self.limits.steps_m_s) // 2])
        needs_s = np.full((known.trains, known.cuts, LEADERS), -np.inf)
        best, least_cost = speeds, np.full(known.trains, np.inf)
        first_in_s = np.full((known.trains, known.cuts, self.routes.elements), np.nan)
        for turn in range(self.fits + self.repairs + 1):
            if turn > 0:
                speeds = self.method(apart_m(known), needs_s, self.limits)
            found = Sweep(self, known, speeds, None).run(partial(early, ahead_s=self.early_s))
            cost = self.cost_s(found)
            better = cost < least_cost
            best = np.where(better[:, None], speeds, best)
            first_in_s = np.where(better[:, None, None], found.first_in_s, first_in_s)
            least_cost = np.minimum(cost, least_cost)
            enough = self.headways_s(found)
            needs_s = enough if turn < self.fits else np.maximum(needs_s, enough)
        return Sweep(self, known, best, first_in_s).run(centred)

    def cost_s(self, found: TrainPlan) -> Floats:
        """What each train costs (trains,): its time over the crest, and much more for intervals that are too short."""
        short = np.clip(self.least_s - found.margin_s - NEARLY_S, 0.0, MOST_SHORT_S)
        return np.asarray(found.crest_s[:, -1] + SHORT_COSTS * short.sum(axis=1))

    def at_speeds(self, known: KnownCuts, speeds_m_s: Floats) -> TrainPlan:
        """The plan with given hump speeds (trains, cuts): exit speeds in the middle between both neighbours."""
        found = Sweep(self, known, speeds_m_s, None).run(partial(early, ahead_s=self.early_s))
        return Sweep(self, known, speeds_m_s, found.first_in_s).run(centred)

    def headways_s(self, found: TrainPlan) -> Floats:
        """What each cut needs behind those ahead of it at the crest, (trains, cuts, leaders): what it had less what it
        had too much. Nothing behind a cut that is expected to stop on the way: no hump speed helps."""
        needs = np.full(found.margins_s.shape, -np.inf)
        for leader in range(1, min(LEADERS + 1, len(found.crest_s.T))):
            had = found.crest_s[:, leader:] - found.crest_s[:, :-leader]
            margins = found.margins_s[:, leader:, leader - 1]
            needs[:, leader:, leader - 1] = np.where(np.isfinite(margins), had - margins + self.least_s, -np.inf)
        return needs


def apart_m(known: KnownCuts) -> Floats:
    """From the middle of each cut to that of the cut ahead, (trains, cuts)."""
    length = known.length_m.reshape(known.trains, known.cuts)
    return np.asarray(0.5 * (length + np.concatenate((length[:, :1], length[:, :-1]), axis=1)))


def push_of(known: KnownCuts, speeds_m_s: Floats, cut: int) -> Push:
    """How cut number `cut` of every train is pushed at the hump speeds (trains, cuts)."""
    return Push(speeds_m_s[:, max(cut - 1, 0)], apart_m(known)[:, cut])


class Sweep:
    """One sweep over all cuts, each planned behind those ahead of it.

    `speeds_m_s` (trains, cuts): hump speeds. `before_s` (trains, cuts, elements): when the cuts behind
    come by an earlier sweep.
    """

    def __init__(self, planner: Planner, known: KnownCuts, speeds_m_s: Floats, before_s: Floats | None) -> None:
        self.planner, self.known, self.before_s = planner, known, before_s
        routes, shape = planner.routes, (known.trains, known.cuts)
        self.users = LastUsers(known.trains, routes)
        self.hump_speed_m_s, self.margin_s = speeds_m_s, np.zeros(shape)
        self.margins_s = np.full((*shape, LEADERS), np.inf)
        mean = 0.5 * (speeds_m_s[:, 1:] + speeds_m_s[:, :-1])
        self.crest_s = np.zeros(shape)
        self.crest_s[:, 1:] = np.cumsum(apart_m(known)[:, 1:] / mean, axis=1)
        self.exit_m_s = np.zeros((*shape, routes.positions))
        self.first_in_s, self.last_out_s, self.left_s = (np.full((*shape, routes.elements), np.nan) for _ in range(3))

    def run(self, rule: IntervalRule) -> TrainPlan:
        """Plan all cuts by `rule`."""
        for cut in range(self.known.cuts):
            self.one(cut, rule)
            self.remember(cut)
        return TrainPlan(
            self.crest_s,
            self.hump_speed_m_s,
            self.margin_s,
            self.margins_s,
            self.exit_m_s,
            self.first_in_s,
            self.last_out_s,
        )

    def one(self, cut: int, rule: IntervalRule) -> None:
        """Plan cut number `cut` of every train."""
        known, planner = self.known, self.planner
        rows = known.of_cut(cut)
        start = Moving(0.5 * known.length_m[rows], self.hump_speed_m_s[:, cut], self.crest_s[:, cut])
        resistance = known.good_n_per_kn if planner.worst_pair else known.mean_n_per_kn
        expected = known.expected(rows, known.route[rows], resistance[rows])
        push = push_of(known, self.hump_speed_m_s, cut)
        ways = from_crest(planner.routes, expected, start, push, known.choices(rows, known.route[rows], planner.roles))
        compared = ways.compared(*self.neighbours(cut))
        taken = ways.followed(rule(compared))
        margins = np.where(possible(compared), compared.ahead_s, -np.inf)
        self.margin_s[:, cut] = margins.max(axis=1)
        self.measure(cut, ways.followed(margins.argmax(axis=1)).first_in_s)
        self.exit_m_s[:, cut] = taken.exit_m_s
        self.first_in_s[:, cut], self.last_out_s[:, cut] = taken.first_in_s, taken.last_out_s

    def measure(self, cut: int, first_in_s: Floats) -> None:
        """Note the margins of cut number `cut` to each of the cuts ahead, if it comes at `first_in_s`."""
        known, routes = self.known, self.planner.routes
        own = known.route[known.of_cut(cut)]
        for leader in range(1, min(LEADERS, cut) + 1):
            other = known.route[known.of_cut(cut - leader)]
            shared, needs = shared_needs(routes, own, other)
            free = self.left_s[:, cut - leader] + needs
            late = np.full(free.shape, np.inf)  # also where the cut never comes: it needs nothing there
            np.subtract(first_in_s, free, out=late, where=shared & np.isfinite(first_in_s) & ~np.isnan(free))
            self.margins_s[:, cut, leader - 1] = late.min(axis=1)

    def remember(self, cut: int) -> None:
        """Let the cuts behind know when cut number `cut` leaves the elements, at the latest where pairs are worst."""
        known, planner = self.known, self.planner
        rows, out = known.of_cut(cut), self.last_out_s[:, cut]
        if planner.worst_pair:
            start = Moving(0.5 * known.length_m[rows], self.hump_speed_m_s[:, cut], self.crest_s[:, cut])
            given = tuple(Given(self.exit_m_s[:, cut, q]) for q in range(planner.routes.positions))
            slow = known.expected(rows, known.route[rows], known.bad_n_per_kn[rows])
            push = push_of(known, self.hump_speed_m_s, cut)
            choices = planner.roles.aimed(given, known.route[rows], known.aim_of(rows))
            out = from_crest(planner.routes, slow, start, push, choices).followed().last_out_s
        self.left_s[:, cut] = out
        times = np.full((known.trains, planner.routes.elements, len(Mark)), np.nan)
        times[:, :, Mark.FIRST_IN], times[:, :, Mark.LAST_OUT] = self.first_in_s[:, cut], out
        self.users.add(cut, known.route[rows], times)

    def neighbours(self, cut: int) -> tuple[Floats, Floats]:
        """From when on the elements are free of the cuts ahead, and by when they must be left for those behind."""
        known, routes = self.known, self.planner.routes
        lanes = np.arange(known.trains)
        own = known.route[known.of_cut(cut)]
        ahead = self.users.on(own, lanes)
        free_by = np.full((known.trains, routes.elements), np.inf)
        if self.before_s is not None:
            free_by = free_by_s(routes, known, self.before_s, own, lanes, cut)
        leaves = np.where(ahead.cut >= 0, ahead.time_s[:, :, Mark.LAST_OUT], -np.inf)  # nobody is there
        return leaves + throws_s(routes, own, ahead), free_by


def throws_s(routes: HumpRoutes, own: Ints, ahead: Ahead) -> Floats:
    """What the points need behind the cuts ahead: a throw where they lie otherwise."""
    points = routes.points[own]
    parts = (ahead.cut >= 0) & (points >= 0) & (points != ahead.points)
    return np.where(parts, routes.throw_s[own], 0.0)


def free_by_s(routes: HumpRoutes, known: KnownCuts, first_in_s: Floats, own: Ints, lanes: Ints, cut: int) -> Floats:
    """When cut number `cut` of the trains `lanes`, on the routes `own` (n,), must have left each element: when the next
    of the `FOLLOWERS` behind it comes there, less the throw of the points; (n, elements). `first_in_s` (trains, cuts,
    elements): when cuts come."""
    free_by = np.full((len(own), routes.elements), np.inf)
    for follower in range(cut + 1, min(cut + 1 + FOLLOWERS, known.cuts)):
        shared, needs = shared_needs(routes, own, known.route[lanes * known.cuts + follower])
        comes = first_in_s[lanes, follower] - needs
        free_by = np.where(shared & ~np.isnan(comes), np.minimum(free_by, comes), free_by)
    return free_by


def shared_needs(routes: HumpRoutes, one: Ints, other: Ints) -> tuple[Bools, Floats]:
    """(which elements the routes `one` and `other` (n,) share, what the points need between two cuts on them), each
    (n, elements)."""
    shared = np.arange(routes.elements)[None, :] < routes.shared(one, other)[:, None]
    parts = shared & (routes.points[one] != routes.points[other])
    return shared, np.where(parts, routes.throw_s[one], 0.0)
