"""Free rolls that a control expects, worked out once: a plan and its feedback ask for the same ones again and again.

Where the train is pushed at another speed, most cuts still come fast enough for the same exit speeds; behind a position
they then roll as before.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.trains.motion import Cars

MOST_NUMBERS: Final = 8_000_000
"""So many are kept of each leg, 64 MB; of longer trains every roll is worked out anew."""

Leg = tuple[str, int, int]
"""What is rolled: a name, the position, and how many speeds are tried."""


@frozen_arrays
class Legs:
    """n cuts that roll with c speeds each, from time 0 on: when the heads are at k marks, `marks_s` (n, c, k); when,
    and with what speed, they are at the end of the leg, (n, c)."""

    marks_s: Floats
    ends_s: Floats
    ends_m_s: Floats


class KnownRolls:
    """What was worked out for the cuts of some trains, `rows` of them, by leg."""

    def __init__(self, rows: int) -> None:
        self.rows = rows
        self.kept: dict[Leg, Kept] = {}

    def found(self, leg: Leg, cars: Cars, begins: Floats, roll: Callable[[Ints], Legs]) -> Legs:
        """The rolls of `cars` over `leg`, which follow from how each of them `begins` (n, m), its speeds first; `roll`
        works out those of some of them."""
        kept = self.kept.get(leg)
        if kept is None:
            first = roll(np.arange(len(begins)))
            if self.rows * first.marks_s[0].size <= MOST_NUMBERS:
                kept = self.kept[leg] = Kept(self.rows, begins.shape[1], *first.marks_s.shape[1:])
                kept.keep(cars, begins, first)
            return first
        known = kept.has(cars, begins)
        told = kept.told(cars.rows)
        if not known.all():
            new = np.flatnonzero(~known)
            rolled = roll(new)
            kept.keep(cars.chosen(new), begins[new], rolled)
            for all_cuts, some in zip(told, (rolled.marks_s, rolled.ends_s, rolled.ends_m_s), strict=True):
                all_cuts[new] = some
        return Legs(*told)


class Kept:
    """Rolls over one leg, and how they began: a row each cut."""

    def __init__(self, rows: int, begins: int, speeds: int, marks: int) -> None:
        self.route, self.resistance_n_per_kn = np.full(rows, -1), np.full(rows, np.nan)
        self.begins = np.full((rows, begins), np.nan)
        self.marks_s = np.empty((rows, speeds, marks))
        self.ends_s, self.ends_m_s = (np.empty((rows, speeds)) for _ in range(2))

    def has(self, cars: Cars, begins: Floats) -> Bools:
        """Whether the rolls of `cars` that begin so are known, (n,)."""
        rows = cars.rows
        same = (self.route[rows] == cars.routes) & (self.resistance_n_per_kn[rows] == cars.resistance_n_per_kn)
        return np.asarray(same & (self.begins[rows] == begins).all(axis=1))

    def keep(self, cars: Cars, begins: Floats, rolled: Legs) -> None:
        """Those of `cars` are known from now on."""
        rows = cars.rows
        self.route[rows], self.resistance_n_per_kn[rows] = cars.routes, cars.resistance_n_per_kn
        self.begins[rows], self.marks_s[rows] = begins, rolled.marks_s
        self.ends_s[rows], self.ends_m_s[rows] = rolled.ends_s, rolled.ends_m_s

    def told(self, rows: Ints) -> tuple[Floats, Floats, Floats]:
        """What is kept of the cuts `rows`, copied: marks, times, speeds."""
        return self.marks_s[rows], self.ends_s[rows], self.ends_m_s[rows]
