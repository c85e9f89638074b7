"""Where the cuts of a train came closest to one another: the least interval between a cut and the next one."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.hump.trains.hump_routes import HumpRoutes, Mark
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory


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
