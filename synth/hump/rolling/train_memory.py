"""What happened to the cuts of many trains so far, written cut by cut; what a control of those that follow is asked,
and what it answers.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.rolling.hump_routes import HumpRoutes, Mark
from synth.hump.rolling.motion import Moving


class TrainMemory:
    """Arrays (trains, cuts, …), NaN or −1 where nothing happened yet.

    `route`: rows of the routes that the cuts went, at last. `crest_s`, `hump_speed_m_s`. `time_s` (…, elements, marks).
    (…, positions): `begin_s` and `entry_m_s` of a pass, `unbraked_m_s` with which it would end unbraked,
    `command_m_s`, `exit_m_s`, `end_s`, `strokes` of valves;
    `ruled_m_s`, what the position was set to while the cut was in it, also where it was in contact.
    Columns of elements, the number of elements where none: `misrouted_at`, `contact_at`; `behind`, the cut with which
    it is in contact from `since_s` on, −1 for none. (…, elements): `unseparated`, `foul`. At the track: `free_m` that
    the cut found, head at its end `end_m` with `end_speed_m_s` at `end_time_s`; where it is `caught_on_track`, because
    it touched the cut ahead while that still rolled, the speed is the difference of both; it did so at `touch_s` with
    its head at `touch_m`, and both rolled on as one, with `together_m_s` at first. `tail_m`: where the last axle
    stands at last, from `still_s` on, also of cuts in contact.
    (trains, routes): `found_free_m` and `left_free_m`, where the standing cars of each track began before the train,
    and behind it. (trains,): tracks that were `pushed_up`, and `pulled`, for it.
    """

    def __init__(self, trains: int, cuts: int, routes: HumpRoutes) -> None:
        shape, elements, positions = (trains, cuts), routes.elements, routes.positions
        self.route = np.full(shape, -1)
        self.crest_s, self.hump_speed_m_s = np.full(shape, np.nan), np.full(shape, np.nan)
        self.time_s = np.full((*shape, elements, len(Mark)), np.nan)
        self.begin_s, self.entry_m_s, self.unbraked_m_s, self.command_m_s = (
            np.full((*shape, positions), np.nan) for _ in range(4)
        )
        self.exit_m_s, self.end_s, self.ruled_m_s = (np.full((*shape, positions), np.nan) for _ in range(3))
        self.strokes = np.zeros((*shape, positions), dtype=np.int64)
        self.misrouted_at, self.contact_at = np.full(shape, elements), np.full(shape, elements)
        self.unseparated, self.foul = np.zeros((*shape, elements), bool), np.zeros((*shape, elements), bool)
        self.behind, self.since_s = np.full(shape, -1), np.full(shape, np.nan)
        self.caught_on_track = np.zeros(shape, bool)
        self.touch_s, self.touch_m, self.together_m_s = (np.full(shape, np.nan) for _ in range(3))
        self.tail_m, self.still_s = np.full(shape, np.nan), np.full(shape, np.nan)
        self.found_free_m, self.left_free_m = (np.full((trains, len(routes.routes)), np.nan) for _ in range(2))
        self.pushed_up, self.pulled = (np.zeros(trains, dtype=np.int64) for _ in range(2))
        self.free_m, self.end_m, self.end_speed_m_s, self.end_time_s = (np.full(shape, np.nan) for _ in range(4))


@frozen_arrays
class Asked:
    """A control is asked for the exit speeds of cut number `cut` of the trains `lanes` (n,) in `position`.

    `routes` (n,): the rows on which they roll. `start`: the cuts when their first axles are at the entrance. `free_m`
    (n,): where the standing cars begin, or will begin if the cut that still rolls there couples. `memory`: what
    happened so far. It tells later times, too; a control may only look at what is over when it is asked.
    """

    cut: int
    position: int
    lanes: Ints
    routes: Ints
    start: Moving
    free_m: Floats
    memory: TrainMemory

    def chosen(self, which: Bools) -> Asked:
        """Some of the cuts."""
        lanes, routes, start = self.lanes[which], self.routes[which], self.start.chosen(which)
        return Asked(self.cut, self.position, lanes, routes, start, self.free_m[which], self.memory)


class ExitSpeeds(Protocol):
    """Commands the exit speeds of the positions."""

    def command(self, asked: Asked) -> Floats:
        """Exit speeds (n,), m/s."""


class HumpSpeeds(Protocol):
    """Chooses the speeds at which the trains are pushed over the crest."""

    def speed(self, cut: int, memory: TrainMemory) -> Floats:
        """Speed of the trains (trains,) when the middle of cut number `cut` is at the crest, m/s."""
