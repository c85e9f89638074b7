"""What rolls over a reference track: axles, and where the first of them is at which time."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.errors import require
from plant_models.frozen_arrays import Floats, frozen_arrays


@frozen_arrays
@dataclass(frozen=True, eq=False)
class MovingCut:
    """An object of number `cut` that rolls from the lead with this place in the list of leads.

    `axles_m`: how far each axle is behind the first one, from 0 on, rising. Its first axle is at `places_m` from the
    crest at `times_s`, both rising, with constant speed between; behind the last place it stands. `PlantError` for
    others.
    """

    cut: int
    axles_m: Floats
    times_s: Floats
    places_m: Floats
    lead: int = 0

    def __post_init__(self) -> None:
        require(self.cut > 0, f"moving cut: its number is {self.cut}; it must be more than 0")
        require(len(self.times_s) == len(self.places_m) >= 2, "moving cut: it needs two places and times at least")
        require(len(self.axles_m) > 0 and self.axles_m[0] == 0.0, "moving cut: its first axle must be at 0")
        for name, rising in (("axles_m", self.axles_m), ("times_s", self.times_s), ("places_m", self.places_m)):
            require(
                bool(np.all(np.isfinite(rising)) and np.all(np.diff(rising) > 0.0)),
                f"moving cut {self.cut}: {name} must be finite numbers that rise",
            )

    def arrivals_s(self, place_m: float) -> list[float]:
        """When each axle is at `place_m`; infinite for those that never are, the first time where it began beyond."""
        at = self.axles_m + place_m
        return [
            float(time)
            for time in np.where(at <= self.places_m[-1], np.interp(at, self.places_m, self.times_s), np.inf)
        ]

    def place_m(self, time_s: float) -> float:
        """Where the first axle is."""
        return float(np.interp(time_s, self.times_s, self.places_m))

    def speed_m_s(self, time_s: float) -> float:
        """How fast it is; 0 before it begins and after it stands."""
        leg = bisect_right(self.times_s.tolist(), time_s) - 1
        if not 0 <= leg < len(self.times_s) - 1:
            return 0.0
        return float((self.places_m[leg + 1] - self.places_m[leg]) / (self.times_s[leg + 1] - self.times_s[leg]))


def moving_cut(
    cut: int, axles_m: Sequence[float], start_s: float, legs: Sequence[tuple[float, float]], lead: int = 0
) -> MovingCut:
    """A cut whose first axle is at the crest at `start_s`; `legs`: up to which metre it has which speed."""
    places, times = [0.0], [start_s]
    for to_m, speed_m_s in legs:
        require(speed_m_s > 0.0, f"moving cut {cut}: a speed is {speed_m_s:g} m/s; it must be more than 0")
        times.append(times[-1] + (to_m - places[-1]) / speed_m_s)
        places.append(to_m)
    return MovingCut(cut, np.array(axles_m, dtype=np.float64), np.array(times), np.array(places), lead)
