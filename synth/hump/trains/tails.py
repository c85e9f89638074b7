"""The last axles of cuts on their way, which those in contact with them follow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.motion import Cars, Moving, Push, Rolls, braked_evenly, merged, rolled_free
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory


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
