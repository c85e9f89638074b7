"""Where the cars stand on each track of many trains, and what rolled there last: written by one cut after the other."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.hump.trains.coupled_cuts import in_turn
from synth.hump.trains.coupling_on_track import Contact, OnTrack, contact_on_track
from synth.hump.trains.motion import Cars, CoupledRolls, Moving, rolled_free
from synth.hump.trains.rolled_on import RolledOn

NEARLY_M = 0.05
"""A cut that stops of itself is taken to stand when it has so much to go: the last of it takes time, but no place."""


class StandingCars:
    """Arrays (trains, routes): `free_m`, where the standing cars of each track begin, metres from the crest.

    Of the last body there, a cut or several that coupled while they rolled: `members`, a row each (…, k), −1 behind the
    last one; its last free roll from `head_m`, `speed_m_s`, `time_s` to `end_m`, `still_s`, when it stopped; `to_m`,
    where the cars stood that it came to; its `length_m`. `taken_m`: what was seen to be free when its last cut began to
    roll there, less that cut.
    """

    def __init__(self, free_m: Floats, rolls: CoupledRolls) -> None:
        self.rolls = rolls
        self.free_m, self.taken_m, self.to_m = (free_m.copy() for _ in range(3))
        self.members = np.full((*free_m.shape, 1), -1)
        self.head_m, self.speed_m_s, self.time_s, self.end_m, self.still_s, self.length_m = (
            np.zeros(free_m.shape) for _ in range(6)
        )

    def seen_m(self, lanes: Ints, routes: Ints, now_s: Floats) -> Floats:
        """Where the standing cars begin, (n,), as far as one knows at `now_s`: a cut that rolls is taken to couple."""
        at = lanes, routes
        return np.where(self.still_s[at] <= now_s, self.free_m[at], self.taken_m[at])

    def block(self, lanes: Ints, routes: Ints, length_m: Floats) -> None:
        """Cuts (n,) that do not come by themselves stand at the end of those ahead, whom nobody comes up with now."""
        self.free_m[lanes, routes] -= length_m
        self.members[lanes, routes] = -1

    def add(self, lanes: Ints, cars: Cars, start: Moving, end: Moving, length_m: Floats, marks_m: Floats) -> RolledOn:
        """Cuts (n,) of the trains `lanes` roll freely from `start` to `end`, if they do not couple to the last body on
        their tracks while that rolls. Returned: those that do; `marks_m` (n, j): where their heads are at marks."""
        at = lanes, cars.routes
        which, contact = self.contacts(lanes, cars, start, end)
        seen = self.seen_m(lanes, cars.routes, start.time_s) - length_m
        found = self.rolled_on(which, contact, lanes, cars, length_m, marks_m)
        alone = np.setdiff1d(np.arange(len(lanes)), which)
        self.taken_m[at] = seen
        self.last(lanes[alone], cars.chosen(alone), start.chosen(alone), end.chosen(alone), length_m[alone])
        return found

    def contacts(self, lanes: Ints, cars: Cars, start: Moving, end: Moving) -> tuple[Ints, Contact]:
        """Which of the cuts touch the last body on their tracks while that still rolls, and how."""
        at = lanes, cars.routes
        met = np.flatnonzero((self.members[at][:, 0] >= 0) & (start.time_s < self.still_s[at]))
        if len(met) == 0:
            return met, Contact(*np.empty((4, 0)))
        ahead = lanes[met], cars.routes[met]
        was = Moving(self.head_m[ahead], self.speed_m_s[ahead], self.time_s[ahead])
        contact = contact_on_track(
            OnTrack(self.body(self.members[ahead], cars.routes[met]), was, self.end_m[ahead], self.still_s[ahead]),
            OnTrack(cars.chosen(met), start.chosen(met), end.head_m[met], end.time_s[met]),
            self.length_m[ahead],
        )
        touches = ~np.isnan(contact.head_m)
        parts = (contact.head_m, contact.time_s, contact.ahead_m_s, contact.behind_m_s)
        return met[touches], Contact(*(each[touches] for each in parts))

    def body(self, members: Ints, routes: Ints) -> Cars:
        """The cuts `members` (n, k) on `routes`, each row as one."""
        if members.shape[1] == 1:
            return Cars(self.rolls, members[:, 0], routes)
        return Cars(self.rolls.coupled(members), np.arange(len(members)), routes)

    def rolled_on(
        self, which: Ints, contact: Contact, lanes: Ints, cars: Cars, length_m: Floats, marks_m: Floats
    ) -> RolledOn:
        """The cuts `which` couple to the bodies ahead, and both roll on with what their momentum gives them."""
        at = lanes[which], cars.routes[which]
        behind = cars.rows[which]
        weighs = self.inertia_t(self.members[at]), self.rolls.inertia_t(behind)
        speed = (weighs[0] * contact.ahead_m_s + weighs[1] * contact.behind_m_s) / (weighs[0] + weighs[1])
        head, members = contact.head_m + self.length_m[at], self.joined(self.members[at], behind)
        body = self.body(members, cars.routes[which])
        start, marks = Moving(head, speed, contact.time_s), marks_m[which] + self.length_m[at][:, None]
        end, marks_s = rolled_free(body, start, np.maximum(self.to_m[at], head), marks)
        nearly, _ = rolled_free(body, start, np.maximum(end.head_m - NEARLY_M, head), marks[:, :0])
        still = np.where(end.speed_m_s > 0.0, end.time_s, nearly.time_s)
        self.hold(at, members)
        self.head_m[at], self.speed_m_s[at], self.time_s[at] = head, speed, contact.time_s
        self.end_m[at], self.still_s[at] = end.head_m, still
        self.length_m[at] += length_m[which]
        self.free_m[at] = end.head_m - self.length_m[at]
        return RolledOn(which, *at, members, contact, head, speed, end.head_m, end.speed_m_s, still, marks_s)

    def inertia_t(self, members: Ints) -> Floats:
        """Of each body, (n,)."""
        each = self.rolls.inertia_t(np.maximum(members, 0).reshape(-1)).reshape(members.shape)
        return in_turn(np.where(members >= 0, each, 0.0))

    def joined(self, members: Ints, behind: Ints) -> Ints:
        """The bodies with one more cut each behind them."""
        wider = np.concatenate((members, np.full((len(members), 1), -1)), axis=1)
        wider[np.arange(len(wider)), (members >= 0).sum(axis=1)] = behind
        return wider[:, : max(int((wider >= 0).sum(axis=1).max(initial=1)), 1)]

    def hold(self, at: tuple[Ints, Ints], members: Ints) -> None:
        """The last bodies there have these members."""
        wide = members.shape[1]
        if wide > self.members.shape[2]:
            more = np.full((*self.members.shape[:2], wide - self.members.shape[2]), -1)
            self.members = np.concatenate((self.members, more), axis=2)
        self.members[at] = -1
        self.members[(*at, slice(wide))] = members

    def last(self, lanes: Ints, cars: Cars, start: Moving, end: Moving, length_m: Floats) -> None:
        """These cuts are the last bodies on their tracks."""
        at = lanes, cars.routes
        self.hold(at, cars.rows[:, None])
        self.to_m[at], self.end_m[at], self.length_m[at] = self.free_m[at], end.head_m, length_m
        self.head_m[at], self.speed_m_s[at], self.time_s[at] = start.head_m, start.speed_m_s, start.time_s
        self.still_s[at] = np.maximum(self.still_s[at], end.time_s)
        self.free_m[at] = np.minimum(self.free_m[at], end.head_m - length_m)
