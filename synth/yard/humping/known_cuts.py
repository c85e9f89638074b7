"""Cuts as a control knows them before they roll: their list, and the resistances of their categories."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.yard.humping.forecast import Expected, Given
from synth.yard.humping.motion import Cars, Rolls

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@frozen_arrays
@dataclass(frozen=True, eq=False)
class KnownCuts:
    """All cuts of some trains, a row each: `rolls` with mean bends and wind; resistance: `mean_n_per_kn`, and that of
    good and of bad runners, `good_n_per_kn` and `bad_n_per_kn` (rows,). `aim_m_s`: the exit speed of the last position
    by the aim, as it is expected before the train, and `most_entry_m_s` there."""

    rolls: Rolls
    trains: int
    cuts: int
    route: Ints
    length_m: Floats
    first_axle_m: Floats
    last_axle_m: Floats
    mean_n_per_kn: Floats
    good_n_per_kn: Floats
    bad_n_per_kn: Floats
    aim_m_s: Floats
    most_entry_m_s: Floats

    def of_cut(self, cut: int) -> Ints:
        """Rows of cut number `cut` of every train."""
        return np.arange(self.trains) * self.cuts + cut

    def expected(self, rows: Ints, routes: Ints, resistance_n_per_kn: Floats) -> Expected:
        """The cuts `rows` on `routes`, with the resistance (n,) that is expected of them."""
        cars = Cars(self.rolls, rows, routes, resistance_n_per_kn)
        return Expected(cars, self.first_axle_m[rows], self.last_axle_m[rows])

    def aim(self, rows: Ints) -> Given:
        """What the last position is expected to make of the cuts `rows`."""
        return Given(self.aim_m_s[rows], self.most_entry_m_s[rows])
