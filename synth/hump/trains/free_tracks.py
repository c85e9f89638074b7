"""How much of each track is free before a train comes: as the hump file tells, or drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats
from plant_models.rolling.random_numbers import Purpose, uniform_numbers
from synth.hump.trains.hump_routes import HumpRoutes


class FreeTracks(Protocol):
    """Where standing cars begin."""

    def free_m(self, routes: HumpRoutes, seed: int, first: int, count: int) -> Floats:
        """Of each route, from the crest, before the trains `first` … `first + count − 1`: (count, routes)."""


@dataclass(frozen=True)
class AsInFile:
    """As the hump file tells, before every train."""

    def free_m(self, routes: HumpRoutes, seed: int, first: int, count: int) -> Floats:
        """See `FreeTracks`."""
        return np.tile(np.array([route.free_to_m for route in routes.routes]), (count, 1))


@dataclass(frozen=True)
class DrawnFree:
    """Every share of the length of a track behind its last position and fouling point, from `low` to `high`, is free
    equally often."""

    low: float = 0.2
    high: float = 0.9

    def __post_init__(self) -> None:
        require_between("tracks: free_low", self.low, 0.0, 1.0)
        require_between("tracks: free_high", self.high, 0.0, 1.0)
        require(self.low <= self.high, f"tracks: free_low is {self.low:g}; it must not be above {self.high:g}")

    def free_m(self, routes: HumpRoutes, seed: int, first: int, count: int) -> Floats:
        """See `FreeTracks`."""
        u = uniform_numbers(seed, Purpose.STANDING, first, count, len(routes.routes))
        begins = routes.standing_from_m
        return np.asarray(begins + (self.low + (self.high - self.low) * u) * (routes.length_m - begins))
