"""The highest command that keeps the probability of over-speed: a quantile of a sorted list of thresholds."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays


@frozen_arrays
class Thresholds:
    """Commands above which n cuts couple too fast at k places: `sorted_m_s` (n, k), each column sorted, and `order`
    (n, k): whose they are. Build it with `thresholds_of`."""

    sorted_m_s: Floats
    order: Ints

    def overspeed(self, commanded_m_s: Floats) -> Floats:
        """Share of the cuts that couple too fast at place k when all are commanded `commanded_m_s` (k,)."""
        columns = range(self.sorted_m_s.shape[1])
        below = [np.searchsorted(self.sorted_m_s[:, k], commanded_m_s[k], side="left") for k in columns]
        return np.array(below) / len(self.sorted_m_s)

    def limit_speeds(self, p_overspeed: float, bounds_m_s: tuple[float, float]) -> Floats:
        """The highest command for each place, (k,), that at most the share `p_overspeed` of the cuts couples too fast
        with; at most the upper bound, and NaN where even the lower bound is too fast."""
        return bounded(self.sorted_m_s[int(p_overspeed * len(self.sorted_m_s))], bounds_m_s)

    def weighted_limit_speeds(self, weights: Floats, p_overspeed: float, bounds_m_s: tuple[float, float]) -> Floats:
        """As `limit_speeds`, each cut counting by its weight (n,)."""
        kept = p_overspeed * weights.sum()
        places = [place_beyond(kept, weights, order) for order in self.order.T]
        return bounded(self.sorted_m_s[places, np.arange(len(places))], bounds_m_s)


def thresholds_of(thresholds_m_s: Floats) -> Thresholds:
    """The list of `thresholds_m_s` (n, k), sorted."""
    order = np.argsort(thresholds_m_s, axis=0, kind="stable")
    return Thresholds(np.take_along_axis(thresholds_m_s, order, axis=0), order)


def place_beyond(limit: float, weights: Floats, order: Ints) -> int:
    """First place at which the weights (n,) in `order` (n,) add up to more than `limit`, or the last one.

    The first quarter of the places is added up first, as it mostly is enough.
    """
    for count in (len(order) // 4, len(order)):
        passed = np.cumsum(weights[order[:count]])
        if passed.size and passed[-1] > limit:
            break
    return min(int(np.searchsorted(passed, limit, side="right")), len(order) - 1)


def bounded(speeds_m_s: Floats, bounds_m_s: tuple[float, float]) -> Floats:
    """Speeds down to the upper bound, NaN below the lower one."""
    low, high = bounds_m_s
    return np.where(speeds_m_s >= low, np.minimum(speeds_m_s, high), np.nan)
