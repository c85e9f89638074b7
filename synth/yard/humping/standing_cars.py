"""Where the cars stand on each track of many trains, and since when: written by one cut after the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


class StandingCars:
    """`free_m` (trains, routes): where the standing cars of each track begin, metres from the crest; `still_s`: when
    the last of them came to a stop."""

    def __init__(self, free_m: Floats) -> None:
        self.free_m, self.still_s = free_m.copy(), np.zeros(free_m.shape)

    def add(self, routes: Ints, head_m: Floats, length_m: Floats, ended_s: Floats) -> Bools:
        """A cut of each train stands with its head at `head_m`, from `ended_s` on; (trains,) all of them. Returned:
        whether it came up with the last one while that still rolled."""
        lanes = np.arange(len(routes))
        caught = ended_s < self.still_s[lanes, routes]
        self.still_s[lanes, routes] = np.maximum(self.still_s[lanes, routes], ended_s)
        self.free_m[lanes, routes] = np.minimum(self.free_m[lanes, routes], head_m - length_m)
        return np.asarray(caught)
