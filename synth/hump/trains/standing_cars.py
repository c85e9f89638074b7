"""Where the cars stand on each track of many trains, and who rolled there last: written by one cut after the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synth.hump.trains.coupling_on_track import OnTrack, closing_speed_m_s
from synth.hump.trains.motion import Cars, Moving

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class StandingCars:
    """Arrays (trains, routes): `free_m`, where the standing cars of each track begin, metres from the crest; of the
    last cut there: its row, −1 for none, its last free roll from `head_m`, `speed_m_s`, `time_s` to `end_m`, `still_s`,
    when it stopped, its `length_m`, and `found_m`, what was seen to be free when it began to roll there."""

    def __init__(self, free_m: Floats) -> None:
        self.free_m, self.row = free_m.copy(), np.full(free_m.shape, -1)
        self.found_m = free_m.copy()
        self.head_m, self.speed_m_s, self.time_s, self.end_m, self.still_s, self.length_m = (
            np.zeros(free_m.shape) for _ in range(6)
        )

    def seen_m(self, lanes: Ints, routes: Ints, now_s: Floats) -> Floats:
        """Where the standing cars begin, (n,), as far as one knows at `now_s`: a cut that rolls is taken to couple."""
        at = lanes, routes
        return np.where(self.still_s[at] <= now_s, self.free_m[at], self.found_m[at] - self.length_m[at])

    def block(self, lanes: Ints, routes: Ints, length_m: Floats) -> None:
        """Cuts (n,) that do not come by themselves stand at the end of those ahead."""
        self.free_m[lanes, routes] -= length_m

    def add(self, lanes: Ints, cars: Cars, start: Moving, end: Moving, length_m: Floats) -> Floats:
        """Cuts (n,) of the trains `lanes` roll freely from `start` to `end`. Returned: how much faster they are than
        the last ones on their tracks, when they touch them while these still roll; NaN where they do not."""
        at = lanes, cars.routes
        closing = np.full(len(lanes), np.nan)
        met = np.flatnonzero((self.row[at] >= 0) & (start.time_s < self.still_s[at]))
        if len(met):
            ahead = lanes[met], cars.routes[met]
            last = Cars(cars.rolls, self.row[ahead], cars.routes[met])
            was = Moving(self.head_m[ahead], self.speed_m_s[ahead], self.time_s[ahead])
            closing[met] = closing_speed_m_s(
                OnTrack(last, was, self.end_m[ahead], self.still_s[ahead]),
                OnTrack(cars.chosen(met), start.chosen(met), end.head_m[met], end.time_s[met]),
                self.length_m[ahead],
            )
        self.found_m[at] = self.seen_m(lanes, cars.routes, start.time_s)
        self.row[at], self.end_m[at], self.length_m[at] = cars.rows, end.head_m, length_m
        self.head_m[at], self.speed_m_s[at], self.time_s[at] = start.head_m, start.speed_m_s, start.time_s
        self.still_s[at] = np.maximum(self.still_s[at], end.time_s)
        self.free_m[at] = np.minimum(self.free_m[at], end.head_m - length_m)
        return closing
