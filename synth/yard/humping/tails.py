"""The last axles of cuts on their way, which those in contact with them follow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.yard.humping.hump_routes import OF_FIRST_AXLE
from synth.yard.humping.motion import Cars, Moving, rolled_free

Floats = NDArray[np.float64]

STATIONS = 40
"""Places on the last free roll of a leader where its time is worked out."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Tails:
    """Last axles of n leaders: `place_m`, `time_s` (n, elements, marks) of their routes, and further places `last_m`
    (n, k) where they are at `last_s`, the last one being where they stand. Between two places they move evenly."""

    place_m: Floats
    time_s: Floats
    last_m: Floats
    last_s: Floats

    def followed(self, own_s: Floats, since_s: Floats, base_m: Floats) -> Floats:
        """Times of marks (n, elements, marks) of cuts that have `own_s` until they touch, at `since_s` (n,), and follow
        with their first axles then; their last axles are `base_m` (n,) behind. Infinite where they do not come."""
        times = np.where(own_s <= since_s[:, None, None], own_s, np.nan)
        for row in range(len(own_s)):
            place, when = self.track_of(row)
            if len(place) == 0:  # the leader stands where it is in contact
                times[row][np.isnan(times[row])] = np.inf
                continue
            wanted = self.place_m[row] + np.where(OF_FIRST_AXLE, 0.0, base_m[row])
            behind = np.interp(wanted, place, when, left=since_s[row], right=np.inf)
            missing = np.isnan(times[row])
            times[row][missing] = np.maximum(behind[missing], since_s[row])
        return np.where(np.isfinite(self.place_m), times, np.inf)

    def track_of(self, row: int) -> tuple[Floats, Floats]:
        """(places, times) of one last axle, in order; it comes no farther than the last place."""
        place = np.append(self.place_m[row][:, ~OF_FIRST_AXLE], self.last_m[row])
        when = np.append(self.time_s[row][:, ~OF_FIRST_AXLE], self.last_s[row])
        known = np.isfinite(place) & np.isfinite(when)
        order = np.argsort(place[known], kind="stable")
        rising = np.maximum.accumulate(when[known][order])
        return place[known][order], rising


def stations_of(cars: Cars, start: Moving, end_m: Floats) -> tuple[Floats, Floats]:
    """(places of the heads, times) of cuts (n,) on their last free rolls from `start` to `end_m`, (n, `STATIONS`); NaN
    for cuts that did not come to that by themselves."""
    heads, when = np.full((2, len(end_m), STATIONS), np.nan)
    rolls = np.flatnonzero(np.isfinite(start.time_s) & np.isfinite(end_m) & (start.speed_m_s > 0.0))
    if len(rolls):
        begins, to = start.head_m[rolls], np.maximum(end_m[rolls], start.head_m[rolls])
        heads[rolls] = begins[:, None] + (to - begins)[:, None] * np.linspace(0.0, 1.0, STATIONS + 1)[None, :-1]
        _, times = rolled_free(cars.chosen(rolls), start.chosen(rolls), to, heads[rolls])
        times[:, 0] = start.time_s[rolls]
        when[rolls] = times
    return heads, when
