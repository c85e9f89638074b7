"""Rules by which speeds are chosen. Hump speeds of a train follow from the headways that its pairs of cuts need at the
crest: pair by pair, or all together. Which choice of exit speeds is taken follows from its margins to both neighbours:
how much later than needed a cut comes to the element where it is least, or how much earlier it leaves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints
from synth.hump.planning.forecast import Compared
from synth.kernels import crest_speeds as kernel

SHORT_COSTS = 1e3
"""Seconds of humping that one second less than a needed headway is worth: no headway is given up to be faster."""


@dataclass(frozen=True)
class HumpSpeedLimits:
    """Speeds over the crest, m/s, that uncoupling, signals and the locomotive allow; `steps_m_s` rise.

    `acceleration_m_s2`: most of the locomotive with its train, either way (assumed; 0.02 to 0.1 are usual).
    """

    steps_m_s: tuple[float, ...]
    acceleration_m_s2: float = 0.05

    def reachable(self, apart_m: Floats) -> Bools:
        """(…, steps, steps): from which step to which the train can change on `apart_m`; to a neighbour always."""
        steps = np.array(self.steps_m_s)
        change = np.abs(steps[:, None] ** 2 - steps[None, :] ** 2)
        places = np.arange(len(steps))
        near = np.abs(places[:, None] - places[None, :]) <= 1
        return np.asarray(near | (change <= 2.0 * self.acceleration_m_s2 * apart_m[..., None, None]))


SpeedMethod = Callable[[Floats, Floats, HumpSpeedLimits], Floats]
"""From headways to speeds (trains, cuts) over the crest.

Its arguments: `apart_m` (trains, cuts), from the middle of each cut to that ahead; `headway_s` (trains, cuts, leaders),
how much later than the cut 1, 2, … ahead of it a cut must come, as far as the limits allow that, −∞ where there is
none.
"""


def whole_train(apart_m: Floats, headway_s: Floats, limits: HumpSpeedLimits) -> Floats:
    """The speeds with which the whole train is over the crest the soonest: a dynamic programme over the steps.

    Time between two cuts: 2·apart/(v1 + v2), the train being pushed at an even rate in between. Its state is the speed
    alone: headways behind cuts farther ahead count along the best way to that speed.
    """
    steps = np.array(limits.steps_m_s)
    trains, cuts, leaders = headway_s.shape
    speeds, work = np.empty((trains, cuts)), np.zeros((2, len(steps), leaders + 1))
    came = np.zeros((cuts, len(steps)), dtype=np.int64)
    most = 2.0 * limits.acceleration_m_s2
    kernel.soonest_over_the_crest(apart_m, headway_s, steps, most, SHORT_COSTS, work, came, speeds)
    return speeds


def pair_by_pair(apart_m: Floats, headway_s: Floats, limits: HumpSpeedLimits) -> Floats:
    """Each cut as fast as the pairs with the cuts ahead of it allow ([hump-computer-1970s], after Шафит), then slower
    where the locomotive could not brake for those behind, or not gather speed."""
    steps = np.array(limits.steps_m_s)
    trains, cuts, leaders = headway_s.shape
    at = np.full((trains, cuts), len(steps) - 1)
    since = np.zeros((trains, leaders))
    for cut in range(1, cuts):
        time = apart_m[:, cut, None] / (0.5 * (steps[at[:, cut - 1], None] + steps))
        needs = (headway_s[:, cut] - since)[:, : min(leaders, cut)].max(axis=1, initial=0.0)
        enough = time >= needs[:, None] - 1e-9
        at[:, cut] = np.where(enough.any(axis=1), len(steps) - 1 - enough[:, ::-1].argmax(axis=1), 0)
        since = since + time[np.arange(trains), at[:, cut], None]
        since = np.concatenate((np.zeros((trains, 1)), since[:, :-1]), axis=1)
    for order in (range(cuts - 1, 0, -1), range(1, cuts)):
        for cut in order:
            one, other = (cut, cut - 1) if order.step < 0 else (cut - 1, cut)
            allowed = limits.reachable(apart_m[:, cut])[np.arange(trains), at[:, one]]
            fastest = len(steps) - 1 - allowed[:, ::-1].argmax(axis=1)
            at[:, other] = np.minimum(at[:, other], fastest)
    return np.asarray(steps[at])


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
