"""How large a drift is: the most likely size on the passes that have it, by the likelihood itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from synth.logs.drift.causes import Cause
from synth.logs.drift.diagnosis import FALL95, scaled, unscaled
from synth.logs.drift.evidence import evidence_of
from synth.logs.fitting_passes import FittingPasses


@dataclass(frozen=True)
class DriftSize:
    """The most likely size and its 95 % interval, by the fall of the likelihood.

    An end that lies at the edge of the sizes of the cause is that edge: the truth may lie beyond.
    """

    size: float
    low95: float
    high95: float


def drift_size(
    passes: FittingPasses, values: Mapping[str, float], cause: Cause, slope_key: str, near: float
) -> DriftSize:
    """Of `cause` on all of `passes`, which have the drift, from the numbers `values`; sought around the size `near`."""
    at = scaled(cause, cause.sizes)
    step, edges = float(at[1] - at[0]), (float(at[0]), float(at[-1]))

    def gain(place: float) -> float:
        one = replace(cause, sizes=(unscaled(cause, place),))
        return float(evidence_of(passes, values, [one], slope_key).ratios[0].sum())

    place = float(scaled(cause, [near])[0])
    low, high = max(edges[0], place - 1.5 * step), min(edges[1], place + 1.5 * step)
    found = minimize_scalar(lambda x: -gain(x), bounds=(low, high), method="bounded", options={"xatol": 1e-4 * step})
    best, most = float(found.x), -float(found.fun)

    def fall(x: float) -> float:
        return gain(x) - most + FALL95

    ends = []
    for sign, edge in zip((-1.0, 1.0), edges, strict=True):
        reach = 0.05 * step
        while fall(beyond := float(np.clip(best + sign * reach, *edges))) > 0.0 and beyond != edge:
            reach *= 2.0
        ends.append(beyond if fall(beyond) > 0.0 else float(brentq(fall, best, beyond, xtol=1e-4 * step)))
    return DriftSize(unscaled(cause, best), unscaled(cause, ends[0]), unscaled(cause, ends[1]))
