"""How far apart the cars of triples stay at a hump speed, and up to which hump speed they stay apart."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.frame.settings.section import setting_limits
from synth.hump.configuration.sections import DesignSettings
from synth.hump.design.hump_under_test import HumpUnderTest
from synth.hump.design.triples import Triples, margins_s, pairs_of, triples
from synth.hump.rolling.hump_routes import HumpRoutes

NEARLY_M_S: Final = 0.01
"""How exactly the highest hump speed is found."""

COARSE: Final = 7
"""Exit speeds of a position that are compared of triples of which most are not the worst."""


@dataclass(frozen=True)
class Parting:
    """Pairs of tracks that part at the `depth`-th switch of their ways: `worst`, the row of the pair with the least
    margin `least_s` at the hump speed of the test; up to `highest_m_s` no margin is below 0, None where that is so at
    no speed."""

    depth: int
    pairs: int
    worst: int
    least_s: float
    highest_m_s: float | None


@frozen_arrays
class Intervals:
    """All `pairs` (t, 3) of tracks as rows of routes, with the least margin of each, `least_s` (t,); `partings`: the
    same by the switch that parts them, from the crest on."""

    pairs: Ints
    least_s: Floats
    partings: tuple[Parting, ...]

    @property
    def worst(self) -> Ints:
        """The routes (1, 3) of the pair with the least margin."""
        return self.pairs[[int(self.least_s.argmin())]]

    @property
    def highest_m_s(self) -> float | None:
        """The highest hump speed at which no margin of any pair is below 0."""
        found = [each.highest_m_s for each in self.partings]
        return None if None in found else min(speed for speed in found if speed is not None)


def least_margins_s(cars: Triples, hump_speed_m_s: Floats) -> Floats:
    """The least margin of each triple (t,) at its hump speed (t,)."""
    return np.asarray(margins_s(cars, cars.planned(hump_speed_m_s)).min(axis=(1, 2)))


def intervals(hump: HumpUnderTest) -> Intervals:
    """Those of every two tracks of a hump that has two or more."""
    pairs = pairs_of(hump.routes)
    depth = depths(hump.routes, pairs)
    levels = np.unique(depth)
    cars = AllTriples(triples(hump.with_choices(COARSE), pairs), triples(hump, pairs), np.searchsorted(levels, depth))
    least = cars.least_margins_s(np.full(len(levels), hump.asked.hump_speed_m_s))
    return Intervals(pairs, least, tuple(partings(depth, least, highest_speeds_m_s(cars, cars.worst(least)))))


@frozen_arrays
class AllTriples:
    """Triples of which the worst of each `level` (t,) are wanted: with few exit speeds that are compared, `coarse`, and
    with many, `fine`."""

    coarse: Triples
    fine: Triples
    level: Ints

    def worst(self, margin_s: Floats) -> Ints:
        """Row of the least margin (t,) of each level, (levels,)."""
        rows = (np.flatnonzero(self.level == k) for k in range(int(self.level.max()) + 1))
        return np.array([of_level[margin_s[of_level].argmin()] for of_level in rows], dtype=np.int64)

    def least_margins_s(self, hump_speed_m_s: Floats) -> Floats:
        """The least margin of each triple (t,) at the hump speed of its level (levels,); the least of each level is
        that of the fine triples.

        More exit speeds to choose from are taken to make no margin smaller. So a triple whose coarse margin is not
        below the fine one of another is not the worst.
        """
        speeds = hump_speed_m_s[self.level]
        margins = least_margins_s(self.coarse, speeds)
        worst = self.worst(margins)
        bound = least_margins_s(self.fine.chosen(worst), speeds[worst])
        margins[worst] = bound
        again = np.flatnonzero(margins < bound[self.level])
        if len(again):
            margins[again] = least_margins_s(self.fine.chosen(again), speeds[again])
        return margins


def partings(depth: Ints, least_s: Floats, highest_m_s: Floats) -> Iterator[Parting]:
    """A row for each depth; `highest_m_s` by it, NaN for none."""
    for level, speed in zip(np.unique(depth), highest_m_s, strict=True):
        rows = np.flatnonzero(depth == level)
        worst = int(rows[least_s[rows].argmin()])
        yield Parting(
            depth=int(level),
            pairs=len(rows),
            worst=worst,
            least_s=float(least_s[worst]),
            highest_m_s=None if np.isnan(speed) else float(speed),
        )


def depths(routes: HumpRoutes, pairs: Ints) -> Ints:
    """Which switch of their ways parts each pair, (t,); 1 is the first."""
    shared = routes.shared(pairs[:, 0], pairs[:, 1])
    is_switch = routes.points[pairs[:, 0]] >= 0
    return np.asarray((is_switch & (np.arange(routes.elements) < shared[:, None])).sum(axis=1))


def tried_m_s() -> tuple[float, float]:
    """Lowest and highest hump speed that is tried: those that a test may have."""
    limits = setting_limits(DesignSettings.model_fields["hump_speed_m_s"])
    assert limits is not None
    return limits


def highest_speeds_m_s(cars: AllTriples, worst: Ints) -> Floats:
    """The highest hump speed (levels,) at which no triple of a level has a margin below 0, NaN for none.

    A triple that is the `worst` (levels,) at some speed bounds that of its level; where another one is below 0 at the
    bound, that one bounds it further.
    """
    highest = np.full(len(worst), tried_m_s()[1])
    while True:
        highest = np.fmin(highest, bound_m_s(cars.fine.chosen(worst), highest))
        margins = cars.least_margins_s(highest)
        below = cars.worst(margins)
        if (margins[below] >= 0.0).all() or (below == worst).all():
            return np.where(margins[below] >= 0.0, highest, np.nan)
        worst = below


def bound_m_s(cars: Triples, most_m_s: Floats) -> Floats:
    """The highest speed (t,) up to `most_m_s` (t,), to `NEARLY_M_S`, at which the margin of each triple is not below
    0; the lowest that is tried where it is below at every speed. A margin is taken to fall with the speed."""
    low, high = np.full(len(cars), tried_m_s()[0]), most_m_s
    low = np.where(least_margins_s(cars, high) >= 0.0, high, low)
    while (high - low).max() > NEARLY_M_S:
        middle = 0.5 * (low + high)
        enough = least_margins_s(cars, middle) >= 0.0
        low, high = np.where(enough, middle, low), np.where(enough, high, middle)
    return low
