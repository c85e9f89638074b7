"""Intervals between cuts: how much later than needed a cut comes to the elements that it shares with its neighbours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.yard.humping.forecast import Forecast

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Neighbours:
    """The cuts ahead of and behind n cuts, as they are expected, (n, elements).

    `free_from_s`: when the last axle of the cut ahead is out, and the points are thrown if they must be; −∞ where
    nobody is. `free_by_s`: when the element must be left for a cut behind; ∞ where nobody comes.
    """

    free_from_s: Floats
    free_by_s: Floats

    def margins_s(self, forecast: Forecast) -> tuple[Floats, Floats]:
        """Least margins of each choice to the cuts ahead and behind, (n, c) each; infinite without one."""
        ahead = forecast.first_in_s - self.free_from_s[:, None, :]
        behind = self.free_by_s[:, None, :] - forecast.last_out_s
        return least(ahead), least(behind)


def least(margins_s: Floats) -> Floats:
    """The least along the last axis; NaN, where nothing is known, does not count."""
    return np.asarray(np.where(np.isnan(margins_s), np.inf, margins_s).min(axis=2))


class IntervalRule(Protocol):
    """Which choice of exit speeds is taken."""

    def best(self, forecast: Forecast, ahead_s: Floats, behind_s: Floats) -> Ints:
        """Column of the choice for each cut, from its margins to the cuts ahead and behind, (n, c) each."""


@dataclass(frozen=True)
class EarlyRule:
    """As early as the margin `ahead_s` to the cut ahead allows; where none does, what leaves it the most."""

    ahead_s: float

    def best(self, forecast: Forecast, ahead_s: Floats, behind_s: Floats) -> Ints:
        """See above."""
        able = possible(forecast)
        enough = able & (ahead_s >= self.ahead_s)
        early = np.where(enough, -forecast.arrival_s, -np.inf).argmax(axis=1)
        most = np.where(able, ahead_s, -np.inf).argmax(axis=1)
        return np.asarray(np.where(enough.any(axis=1), early, most))


@dataclass(frozen=True)
class CentredRule:
    """The least of both margins as large as can be: in the middle between both neighbours, τ = (δ2 − δ1)/2.

    More than `ample_s` is not asked for: among such choices the one with the lowest speeds is taken, since slow cuts
    leave more brake power to the positions behind.
    """

    ample_s: float = 5.0

    def best(self, forecast: Forecast, ahead_s: Floats, behind_s: Floats) -> Ints:
        """See above."""
        margin = np.minimum(np.minimum(ahead_s, behind_s), self.ample_s)
        slower = forecast.speeds_m_s.sum(axis=2)
        return np.asarray(np.where(possible(forecast), margin - 1e-6 * slower, -np.inf).argmax(axis=1))


def possible(forecast: Forecast) -> Bools:
    """Choices that the cut can have, and with which it arrives; all, where there is none."""
    arrives = np.isfinite(forecast.arrival_s)
    both, none = forecast.able & arrives, ~forecast.able.any(axis=1, keepdims=True)
    return np.asarray(np.where(both.any(axis=1, keepdims=True), both, forecast.able | none))
