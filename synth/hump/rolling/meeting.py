"""How a cut meets those ahead of it: not separated on an element, too late for its points, in contact, foul; the last
axles that those in contact follow; and where the cuts of a train came closest to one another.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.rolling.hump_routes import HumpRoutes, Mark
from synth.hump.rolling.motion import Cars, Moving, Push, Rolls, braked_evenly, merged, rolled_free
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory


class LastUsers:
    """Who used each element last, in every train: written by one cut after the other.

    `cut` (trains, numbers), −1 nobody; `points`, as that cut left them; `time_s`, with the marks as a third axis.
    """

    def __init__(self, trains: int, routes: HumpRoutes) -> None:
        self.routes = routes
        shape = trains, len(routes.numbers)
        self.cut = np.full(shape, -1)
        self.points = np.full(shape, -1)
        self.time_s = np.full((*shape, len(Mark)), np.nan)

    def on(self, routes: Ints, lanes: Ints) -> Ahead:
        """Who is ahead of cuts on `routes` (n,) in the trains `lanes` (n,)."""
        vertex, lane = self.routes.vertex[routes], lanes[:, None]
        cut = np.where(vertex >= 0, self.cut[lane, vertex], -1)
        return Ahead(cut, self.points[lane, vertex], self.time_s[lane, vertex])

    def add(self, cut: int, routes: Ints, time_s: Floats) -> None:
        """Cut number `cut` of every train went by `routes` (trains,), `time_s` (trains, elements, marks).

        The first element that it never comes to is taken, too: a cut that stands between two is in the way to that.
        What is not known, NaN, is not taken.
        """
        entered = (self.routes.vertex[routes] >= 0) & np.isfinite(time_s[:, :, Mark.FIRST_IN])
        before = np.concatenate((np.ones((len(entered), 1), dtype=bool), entered[:, :-1]), axis=1)
        stands = before & np.isinf(time_s[:, :, Mark.FIRST_IN]) & (self.routes.vertex[routes] >= 0)
        lane, element = np.nonzero(entered | stands)
        vertex = self.routes.vertex[routes][lane, element]
        self.cut[lane, vertex] = cut
        self.points[lane, vertex] = self.routes.points[routes][lane, element]
        self.time_s[lane, vertex] = np.nan_to_num(time_s[lane, element], nan=np.inf, posinf=np.inf)


@frozen_arrays
class Ahead:
    """The cut ahead on each element of n routes, (n, elements): its place in the train, −1 nobody; how it left the
    points; `time_s` (n, elements, marks)."""

    cut: Ints
    points: Ints
    time_s: Floats


@frozen_arrays
class Meeting:
    """What n cuts, of which `time_s` is known as far as it is not NaN, do with those ahead: (n, elements) each.

    `unseparated`: the first axle comes in before the last one ahead went out. `late`: the points lie for the cut ahead
    and cannot be thrown any more. `touches_in`, `touches_out`: its first axle passes the joint where cuts come in, or
    go out, before the last one of the cut ahead has passed it. `foul`: where the ways part, it is at the fouling point
    before the cut ahead is beyond its own.
    """

    unseparated: Bools
    late: Bools
    touches_in: Bools
    touches_out: Bools
    foul: Bools

    @property
    def contact(self) -> Bools:
        """The cuts touch at one of both joints."""
        return np.asarray(self.touches_in | self.touches_out)


def meeting(routes: HumpRoutes, rows: Ints, time_s: Floats, ahead: Ahead) -> Meeting:
    """How cuts on the routes `rows` meet those `ahead`; comparisons with what is not known are False."""
    somebody, points = ahead.cut >= 0, routes.points[rows]
    parts = (points >= 0) & (points != ahead.points)
    first_in, out = time_s[:, :, Mark.FIRST_IN], ahead.time_s[:, :, Mark.LAST_OUT]
    touch_in = first_in < ahead.time_s[:, :, Mark.LAST_IN]
    touch_out = (time_s[:, :, Mark.FIRST_OUT] < out) & ~parts
    foul = parts & (time_s[:, :, Mark.FIRST_CLEAR] < ahead.time_s[:, :, Mark.LAST_CLEAR])
    return Meeting(
        unseparated=somebody & (first_in < out),
        late=somebody & parts & (first_in < out + routes.throw_s[rows]),
        touches_in=somebody & touch_in,
        touches_out=somebody & touch_out,
        foul=somebody & foul,
    )


def first_of(found: Bools) -> Ints:
    """Column of the first True of each row; the number of columns where there is none."""
    return np.asarray(np.concatenate((found, np.ones((len(found), 1), bool)), axis=1).argmax(axis=1))


@dataclass(frozen=True)
class Tails:
    """The last axles of the cuts that `memory` tells of, told anew from what it has of their legs."""

    routes: HumpRoutes
    rolls: Rolls
    trains: TrainCuts
    memory: TrainMemory

    def times_s(self, lanes: Ints, cuts: Ints, places_m: Floats) -> Floats:
        """When the last axles of the cuts (n,) of the trains `lanes` are at `places_m` (n, k), infinite where they
        never are. A cut in contact follows the last axle of the one ahead of it with its first axle from then on."""
        rows = lanes * self.trains.cuts + cuts
        times = self.alone_s(lanes, cuts, places_m + self.trains.last_axle_m[rows, None])
        led = np.flatnonzero(self.memory.behind[lanes, cuts] >= 0)
        if len(led):
            at, since = (lanes[led], cuts[led]), self.memory.since_s[lanes[led], cuts[led], None]
            base = (self.trains.last_axle_m - self.trains.first_axle_m)[rows[led], None]
            times[led] = followed(times[led], since, self.times_s(at[0], self.memory.behind[at], places_m[led] + base))
        return times

    def alone_s(self, lanes: Ints, cuts: Ints, heads_m: Floats) -> Floats:
        """When the heads of the cuts (n,) are at `heads_m` (n, k), as if nobody were ahead of them; infinite where they
        never are."""
        memory, trains, at = self.memory, self.trains, (lanes, cuts)
        rows, routes = lanes * trains.cuts + cuts, memory.route[lanes, cuts]
        cars = Cars(self.rolls, rows, routes)
        moving = Moving(0.5 * trains.length_m[rows], memory.hump_speed_m_s[at], memory.crest_s[at])
        times = self.pushed_s(lanes, cuts, moving, heads_m)
        for position in range(self.routes.positions):
            held = np.isfinite(memory.end_s[lanes, cuts, position])  # a cut that stops in a position is not braked
            if not held.any():
                continue
            place = lanes[held], cuts[held], position
            entrance = self.routes.entrance_m[routes[held], position] + trains.first_axle_m[rows[held]]
            leaves = self.routes.exit_m[routes[held], position] + trains.last_axle_m[rows[held]]
            _, rolled = rolled_free(cars.chosen(held), moving.chosen(held), entrance, heads_m[held])
            start = Moving(entrance, memory.entry_m_s[place], memory.begin_s[place])
            takes, exits = memory.end_s[place] - start.time_s, memory.exit_m_s[place]
            end, braked = braked_evenly(start, leaves, exits, takes, heads_m[held])
            times[held] = np.fmin(times[held], np.fmin(rolled, braked))
            moving = merged(moving, end, held)
        end_m = np.where(np.isnan(memory.end_m[at]), self.routes.length_m[routes], memory.end_m[at])
        _, rolled = rolled_free(cars, moving, np.maximum(end_m, moving.head_m), heads_m)
        times = np.fmin(times, rolled)
        return np.where(np.isnan(times), np.inf, times)

    def pushed_s(self, lanes: Ints, cuts: Ints, let_go: Moving, heads_m: Floats) -> Floats:
        """The same of the train on the hump before the cuts are `let_go`; NaN for places behind that."""
        ahead = np.maximum(cuts - 1, 0)
        length_m, rows = self.trains.length_m, lanes * self.trains.cuts
        apart = np.where(cuts > 0, 0.5 * (length_m[rows + cuts] + length_m[rows + ahead]), length_m[rows + cuts])
        return Push(self.memory.hump_speed_m_s[lanes, ahead], apart).times_s(let_go, heads_m)


def followed(own_s: Floats, since_s: Floats, tail_s: Floats) -> Floats:
    """Times of cuts that have `own_s` until they touch, at `since_s`, and those of the last axle ahead from then on."""
    return np.where(own_s <= since_s, own_s, np.maximum(tail_s, since_s))


@frozen_arrays
class TightestPairs:
    """The tightest pair of each train, (trains,): `interval_s` more than its points needed, 0 where no two cuts share
    an element; `at`, place of the element among the numbers of the routes, −1 for none; `ahead`, `behind`: places
    of the weight categories."""

    interval_s: Floats
    at: Ints
    ahead: Ints
    behind: Ints


def tightest_pairs(routes: HumpRoutes, trains: TrainCuts, memory: TrainMemory) -> TightestPairs:
    """The least interval of each train from the last axle of a cut out of an element to the first axle of the next cut
    in, less what the points need between both.

    Counted on the way that the cuts went, up to the switch that parts them and only where both roll freely: not behind
    a place where one of them was in contact.
    """
    ahead, behind = memory.route[:, :-1], memory.route[:, 1:]
    last = routes.shared(ahead.ravel(), behind.ravel()).reshape(ahead.shape)[:, :, None]
    columns = np.arange(routes.elements)
    parts = routes.points[ahead] != routes.points[behind]
    needs = np.where(parts, routes.throw_s[behind], 0.0)
    comes, leaves = memory.time_s[:, 1:, :, Mark.FIRST_IN], memory.time_s[:, :-1, :, Mark.LAST_OUT]
    contact = np.minimum(memory.contact_at[:, :-1], memory.contact_at[:, 1:])[:, :, None]
    counts = (columns < np.minimum(last, contact)) & np.isfinite(comes) & np.isfinite(leaves)
    margin = np.full(counts.shape, np.inf)
    np.subtract(comes, leaves + needs, out=margin, where=counts)
    lanes, none = np.arange(len(margin)), np.full((len(margin), 1), np.inf)  # a train of one cut has no pair at all
    flat = np.concatenate((margin.reshape(len(margin), -1), none), axis=1)
    place = flat.argmin(axis=1)
    least = flat[lanes, place]
    pair, column = np.divmod(np.where(np.isfinite(least), place, 0), routes.elements)
    follower = np.minimum(pair + 1, memory.route.shape[1] - 1)
    category = trains.category.reshape(memory.route.shape)
    at = np.where(np.isfinite(least), routes.vertex[memory.route[lanes, follower], column], -1)
    least = np.where(at >= 0, least, 0.0)
    return TightestPairs(least, at, category[lanes, pair], category[lanes, follower])
