"""How a cut meets those ahead of it: not separated on an element, too late for its points, in contact, foul."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.trains.hump_routes import HumpRoutes, Mark


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
