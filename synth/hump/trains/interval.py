"""Rules for the interval between cuts: which choice of exit speeds is taken, from its margins to both neighbours.

A margin is how much later than needed a cut comes to the element where it is least, or how much earlier it leaves.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from plant_models.frozen_arrays import Bools, Ints
from synth.hump.trains.forecast import Compared

NONE_S = -1e6
"""Margins behind a cut that blocks the way are infinitely short; where all choices have such, a possible one is
taken."""


IntervalRule = Callable[[Compared], Ints]
"""Which choice of exit speeds is taken: its column for each cut, (n,)."""


def early(compared: Compared, ahead_s: float) -> Ints:
    """As early as the margin `ahead_s` to the cut ahead allows; where none does, what leaves it the most."""
    able = possible(compared)
    enough = able & (compared.ahead_s >= ahead_s)
    soonest = np.where(enough, -compared.arrival_s, -np.inf).argmax(axis=1)
    most = np.where(able, np.maximum(compared.ahead_s, NONE_S), -np.inf).argmax(axis=1)
    return np.asarray(np.where(enough.any(axis=1), soonest, most))


AMPLE_S = 5.0
"""More margin is not asked for."""


def centred(compared: Compared) -> Ints:
    """The least of both margins as large as can be: in the middle between both neighbours, τ = (δ2 − δ1)/2.

    Among choices with ample margins the one with the lowest speeds is taken, since slow cuts leave more brake power to
    the positions behind.
    """
    margin = np.clip(np.minimum(compared.ahead_s, compared.behind_s), NONE_S, AMPLE_S)
    return np.asarray(np.where(possible(compared), margin - 1e-6 * compared.speeds_m_s, -np.inf).argmax(axis=1))


NEARLY_M_S = 0.1
"""Choices whose worst entry is so near to the best one are all possible, so that the margins decide."""


def possible(compared: Compared) -> Bools:
    """Choices that the cut can have and with which it arrives; of these, those within the limits of entry, or, where
    none is, nearest to them. All, where there is none."""
    arrives, able = np.isfinite(compared.arrival_s), compared.able
    both, none = able & arrives, ~able.any(axis=1, keepdims=True)
    found = np.where(both.any(axis=1, keepdims=True), both, able | none)
    beyond = np.where(found, compared.beyond_m_s, np.inf)
    least = beyond.min(axis=1, keepdims=True)
    return np.asarray(found & (beyond <= np.where(least > 0.0, least + NEARLY_M_S, 0.0)))
