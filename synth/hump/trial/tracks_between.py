"""Tracks before a train and between the trains of a shift: what stands on them, which are pushed up, and pulled."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from plant_models.rolling.random_numbers import Purpose, uniform_numbers
from synth.hump.configuration.settings import TracksSettings
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory

SPARE_M = 30.0
"""Room that a cut gets besides its length (assumed)."""


@frozen_arrays
class Tracks:
    """Tracks before some trains, (trains, routes): `free_m`, where the standing cars begin, metres from the crest;
    `cars_m`: length of all cars that stand there; whether they were `pushed_up`, or `pulled`, just before."""

    free_m: Floats
    cars_m: Floats
    pushed_up: Bools
    pulled: Bools


def free_before_m(tracks: TracksSettings, routes: HumpRoutes, seed: int, first: int, count: int) -> Floats:
    """Where standing cars begin on each route, from the crest, before the trains `first` … `first + count − 1`: (count,
    routes). They stand as the hump file tells, or every share of the length of a track behind its last position and
    fouling point, from the lowest to the highest, is free equally often."""
    if tracks.standing == "file":
        return np.tile(np.array([route.free_to_m for route in routes.routes]), (count, 1))
    u = uniform_numbers(seed, Purpose.STANDING, first, count, len(routes.routes))
    begins, low, high = routes.standing_from_m, tracks.free_low, tracks.free_high
    return np.asarray(begins + (low + (high - low) * u) * (routes.length_m - begins))


def tracks_as_drawn(routes: HumpRoutes, trains: TrainCuts, free_m: Floats) -> Tracks:
    """Tracks of which `free_m` (trains, routes) is free, or more where `trains` need it."""
    found = with_room(routes, trains, free_m)
    none = np.zeros(found.shape, dtype=bool)
    return Tracks(found, routes.length_m - found, none, none)


def tracks_left(
    routes: HumpRoutes, before: Tracks, memory: TrainMemory, trains: TrainCuts, coming: TrainCuts, share: float
) -> Tracks:
    """The tracks for the trains that are `coming`, as the `trains` that found them as `before` have left them.

    A track whose cars take `share` of it is pulled, all its cars at once. One that has not the room for what is coming
    is pushed up, so that no gap is left between its cars; so are cars that stand ahead of it, in the switches. If that
    is not enough, it is pulled, too.
    """
    cars_m = before.cars_m.copy()
    lanes = np.arange(trains.trains)[:, None]
    np.add.at(cars_m, (lanes, memory.route), trains.length_m.reshape(memory.route.shape))
    begins, most = routes.standing_from_m, routes.length_m
    wanted = begins + room_m(routes, coming)
    full = (cars_m > 0.0) & (cars_m >= share * (most - begins))
    pushed = ~full & (memory.left_free_m < wanted) & (memory.left_free_m < most - cars_m)
    free_m = np.where(pushed, most - cars_m, memory.left_free_m)
    pulled = full | ((cars_m > 0.0) & (free_m < wanted))
    return Tracks(np.where(pulled, most, free_m), np.where(pulled, 0.0, cars_m), pushed & ~pulled, pulled)


def room_m(routes: HumpRoutes, trains: TrainCuts) -> Floats:
    """What `trains` bring to each track, with some room to spare, (trains, routes)."""
    train = np.repeat(np.arange(trains.trains), trains.cuts)
    needs = np.zeros((trains.trains, len(routes.routes)))
    np.add.at(needs, (train, trains.route), trains.length_m + SPARE_M)
    return needs


def with_room(routes: HumpRoutes, trains: TrainCuts, free_m: Floats) -> Floats:
    """`free_m` (trains, routes), but where a train brings more cars than there is room for, all room that they need:
    nobody sends cuts to a full track. As much as the track has, where that is less."""
    return np.asarray(np.clip(routes.standing_from_m + room_m(routes, trains), free_m, routes.length_m))
