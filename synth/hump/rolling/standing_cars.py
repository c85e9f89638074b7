"""Where the cars stand on each track of many trains, and what rolled there last: written by one cut after the other.
Cuts that come up with the one ahead while it still rolls on its track couple to it, and both roll on as one.
"""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.rolling.motion import Cars, CoupledRolls, Moving, rolled_free
from synth.hump.rolling.route_rolling import in_turn
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory

PLACES = 48
"""Places on the track where both are compared, and once more about the one where they first touch, or come closest."""


@frozen_arrays
class OnTrack:
    """n cuts on their last free rolls, (n,) each: `cars` from `start` to the places `end_m` of their heads, where they
    stand from `still_s` on."""

    cars: Cars
    start: Moving
    end_m: Floats
    still_s: Floats


@frozen_arrays
class Contact:
    """Where the head of each of n cuts behind touches the tail ahead, when, and how fast both are then; (n,) each, NaN
    where they do not touch while that ahead rolls."""

    head_m: Floats
    time_s: Floats
    ahead_m_s: Floats
    behind_m_s: Floats

    @property
    def closing_m_s(self) -> Floats:
        """How much faster the cut behind is."""
        return np.maximum(self.behind_m_s - self.ahead_m_s, 0.0)


def contact_on_track(ahead: OnTrack, behind: OnTrack, length_m: Floats) -> Contact:
    """Where cuts `behind` touch those `ahead`, whose `length_m` (n,) is given. Both roll as if alone up to there."""
    from_m = np.maximum(behind.start.head_m, ahead.start.head_m - length_m)
    to_m = np.maximum(ahead.end_m - length_m, from_m)
    rows = np.arange(len(from_m))
    steps = np.linspace(0.0, 1.0, PLACES)
    places = from_m[:, None] + (to_m - from_m)[:, None] * steps
    later_s = compared(ahead, behind, places, length_m)[0]
    touches = (later_s < 0.0).any(axis=1)
    at = np.where(touches, (later_s < 0.0).argmax(axis=1), later_s.argmin(axis=1))
    begins, ends = places[rows, np.maximum(at - 1, 0)], places[rows, np.minimum(at + 1, PLACES - 1)]
    fine = begins[:, None] + (ends - begins)[:, None] * steps
    later_s, first, second = compared(ahead, behind, fine, length_m)
    late = later_s < 0.0
    at, none = (rows, late.argmax(axis=1)), ~late.any(axis=1)
    time = np.where(np.isfinite(first[0][at]), first[0][at], second[0][at])
    return Contact(*(np.where(none, np.nan, each) for each in (fine[at], time, first[1][at], second[1][at])))


Rolled = tuple[Floats, Floats]


def compared(ahead: OnTrack, behind: OnTrack, places_m: Floats, length_m: Floats) -> tuple[Floats, Rolled, Rolled]:
    """How much later the heads of the cuts `behind` are at `places_m` (n, k) than the tails `ahead`, infinitely where
    these stand already; and both, as `rolled` tells them."""
    first, second = rolled(ahead, places_m + length_m[:, None]), rolled(behind, places_m)
    with np.errstate(invalid="ignore"):  # neither comes: ∞ − ∞
        return np.where(second[0] < ahead.still_s[:, None], second[0] - first[0], np.inf), first, second


def rolled(cuts: OnTrack, heads_m: Floats) -> Rolled:
    """(times, speeds) of `cuts` when their heads pass `heads_m` (n, k); infinite and 0 behind a stop."""
    found = cuts.cars.rolls.roll_on(
        cuts.cars.rows,
        cuts.cars.routes,
        cuts.start.head_m,
        cuts.start.speed_m_s,
        np.maximum.accumulate(heads_m, axis=1),
    )
    here = heads_m <= cuts.start.head_m[:, None] + 1e-9
    return (
        np.where(here, cuts.start.time_s[:, None], cuts.start.time_s[:, None] + found.time_s),
        np.where(here, cuts.start.speed_m_s[:, None], found.speed_m_s),
    )


@frozen_arrays
class RolledOn:
    """Cuts that coupled to the one ahead on their tracks and rolled on with it: `which` (m,) of those that were added,
    on the tracks of the routes `route` of the trains `lanes`; `members` (m, k) of each body, rows of cuts from its head
    to its tail, −1 behind the last one. `contact`; then the head of the body is at `head_m` with `speed_m_s`, and comes
    to its end at `end_m` with `end_m_s`, at `still_s`.
    `marks_s` (m, j): when the head of the last cut is at its marks from there on, NaN for those not on the way."""

    which: Ints
    lanes: Ints
    route: Ints
    members: Ints
    contact: Contact
    head_m: Floats
    speed_m_s: Floats
    end_m: Floats
    end_m_s: Floats
    still_s: Floats
    marks_s: Floats


def remember(memory: TrainMemory, trains: TrainCuts, cut: int, found: RolledOn, coupled_m_s: Floats) -> None:
    """What becomes of all cuts of each body, of which cut number `cut` came last; the first one couples with
    `coupled_m_s` (m,)."""
    head = found.end_m.copy()
    for place in range(found.members.shape[1]):
        there = found.members[:, place] >= 0
        rows = found.members[there, place]
        own = found.lanes[there], rows % trains.cuts
        memory.end_m[own], memory.end_time_s[own] = head[there], found.still_s[there]
        memory.tail_m[own], memory.still_s[own] = head[there] - trains.last_axle_m[rows], found.still_s[there]
        if place == 0:
            memory.end_speed_m_s[own] = coupled_m_s
        head[there] -= trains.length_m[rows]
    at = found.lanes, cut
    memory.caught_on_track[at], memory.end_speed_m_s[at] = True, found.contact.closing_m_s
    memory.touch_s[at], memory.touch_m[at] = found.contact.time_s, found.contact.head_m
    memory.together_m_s[at] = found.speed_m_s


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
