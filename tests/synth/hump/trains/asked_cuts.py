"""Cuts that come to a position of the large hump, as a control is asked for them, on ways in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from plant_models.library import load_hump
from synth.hump.rolling.hump_routes import HumpRoutes, hump_routes
from synth.hump.rolling.motion import Moving
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import Asked, TrainMemory
from synth.simulation.free_roll import Rolled

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

GRAVITY_M_S2 = 9.5
GRADE = 0.008
CUT_M, FIRST_M, LAST_M = 14.0, 2.0, 12.0


def large() -> HumpRoutes:
    """The routes of the large hump."""
    return hump_routes(load_hump("large").graph, 201)


@dataclass(frozen=True)
class EvenSlope:
    """Rolls whose energy changes evenly: v² = u² + 2 g' (GRADE − w/1000) L; `n_per_kn` (rows,) is their own w."""

    n_per_kn: Floats

    def roll_on(
        self,
        rows: Ints,
        routes: Ints,
        start_m: Floats,
        speed_m_s: Floats,
        stations_m: Floats,
        resistance_n_per_kn: Floats | None = None,
    ) -> Rolled:
        """Times are not told."""
        w = self.n_per_kn[rows] if resistance_n_per_kn is None else resistance_n_per_kn
        path = stations_m - start_m[:, None]
        squares = speed_m_s[:, None] ** 2 + 2.0 * GRAVITY_M_S2 * (GRADE - 1e-3 * w[:, None]) * path
        return Rolled(np.sqrt(np.maximum(squares, 0.0)), np.full(path.shape, np.nan), np.full(len(path), np.inf))


@frozen_arrays
@dataclass(frozen=True, eq=False)
class AlikeCuts:
    """`trains` of one cut each, all of one length."""

    trains: int
    category: Ints
    cars: Ints
    first: int = 0
    seed: int = 3
    cuts: int = 1

    @property
    def numbers(self) -> Ints:
        """Of each train."""
        return self.first + np.arange(self.trains)

    @property
    def length_m(self) -> Floats:
        """Over couplers."""
        return np.full(self.trains, CUT_M)

    @property
    def first_axle_m(self) -> Floats:
        """Behind the head."""
        return np.full(self.trains, FIRST_M)

    @property
    def last_axle_m(self) -> Floats:
        """Behind the head."""
        return np.full(self.trains, LAST_M)


def alike_cuts(trains: int, category: Ints, cars: Ints, seed: int = 3) -> TrainCuts:
    """What controls ask of cuts."""
    return cast(TrainCuts, AlikeCuts(trains, category, cars, seed=seed))


def asked_at(routes: HumpRoutes, position: int, memory: TrainMemory, comes_m_s: Floats, free_m: Floats) -> Asked:
    """One cut of every train comes to `position` with `comes_m_s`."""
    lanes = np.arange(len(comes_m_s))
    own = np.zeros(len(lanes), dtype=np.int64)
    start = Moving(routes.entrance_m[own, position] + FIRST_M, comes_m_s, np.full(len(lanes), 100.0))
    return Asked(0, position, lanes, own, start, free_m, memory)
