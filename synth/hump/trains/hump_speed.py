"""Hump speeds of a train from the headways that its pairs of cuts need at the crest: pair by pair, or all together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Bools, Floats
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
