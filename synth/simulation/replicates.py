"""Means over all cuts from weighted passes, with their 95 % intervals from independent replicates.

Consecutive `REPLICATE_PASSES` passes are one replicate: independent of all others, and alike. So the spread between
replicates is the error of the mean, whatever the strata within them and however heavy the tail, and a quantile of
Student's law bounds it. Plain passes are replicates too. How often these intervals hold the truth is tested
(`retarder-synth study coverage`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Bools, Floats

REPLICATE_PASSES = 100
"""Passes of one replicate; ten of them, 1000 passes, are the fewest that a user's interval is told from."""

LEAST_REPLICATES = 2
UPPER_TAIL = 0.025
"""Probability above a 95 % interval, and below it."""

Interval = tuple[float, float]
"""Low and high end."""


@dataclass(frozen=True)
class Mean:
    """A mean over all cuts: `value`, and `half_width` of its 95 % interval value ± half_width."""

    value: float
    half_width: float

    @property
    def ci95(self) -> Interval:
        """The interval."""
        return self.value - self.half_width, self.value + self.half_width


def mean_of(values: Floats, weight: Floats) -> Mean:
    """Weighted mean of `values` (n,), its interval from the replicates; `ValueError` for fewer than two of these."""
    value = float(weight @ values / weight.sum())
    return Mean(value, half_width(weight * (values - value), weight))


def half_width(deviations: Floats, weight: Floats) -> float:
    """Half the 95 % interval of Σ `deviations` / Σ `weight`, where the deviations (n,) sum to 0.

    A last replicate that is cut short counts as one of its own.
    """
    starts = np.arange(0, len(deviations), REPLICATE_PASSES)
    count = len(starts)
    if count < LEAST_REPLICATES:
        raise ValueError(
            f"replicates: {len(deviations)} passes; at least {(LEAST_REPLICATES - 1) * REPLICATE_PASSES + 1} are needed"
        )
    square = float(np.square(np.add.reduceat(deviations, starts)).sum()) * count / (count - 1)
    return student_quantile(count - 1) * math.sqrt(square) / float(weight.sum())


def student_quantile(freedom: int) -> float:
    """97.5 % quantile of Student's law."""
    from scipy.special import stdtrit  # start-up: scipy only where it is needed

    return float(stdtrit(freedom, 1.0 - UPPER_TAIL))


def rms_of(errors: Floats, weight: Floats) -> tuple[float, Interval]:
    """Root mean square of `errors` (n,), and its 95 % interval.

    The interval is that of the logarithm of the mean square (delta method), so its low end is never negative.
    """
    square = mean_of(errors**2, weight)
    rms = math.sqrt(square.value)
    if rms == 0.0:
        return 0.0, (0.0, 0.0)
    spread = math.exp(0.5 * square.half_width / square.value)
    return rms, (rms / spread, rms * spread)


def share_of(hits: Bools, weight: Floats) -> tuple[float, Interval]:
    """Share of all cuts that `hits` (n,) marks, and its 95 % interval.

    The interval is that of log(p / (1 − p)). Where no pass is marked, or every one: the event has at least p / (largest
    weight) of the passes, so of n passes all or none are met with probability (1 − p / largest weight)ⁿ at most.
    """
    found = mean_of(hits.astype(np.float64), weight)
    if not hits.any() or hits.all():
        unseen = min(float(weight.max()) * -math.expm1(math.log(UPPER_TAIL) / len(hits)), 1.0)
        return (1.0, (1.0 - unseen, 1.0)) if hits.all() else (0.0, (0.0, unseen))
    p, rest = found.value, float(weight[~hits].sum() / weight.sum())  # 1 − p may round to 0
    spread = math.exp(min(found.half_width / (p * rest), 300.0))
    odds = p / rest
    low, high = odds / spread, odds * spread
    return p, (low / (1.0 + low), high / (1.0 + high))


def quantiles_of(values: Floats, weight: Floats, levels: Sequence[float]) -> list[tuple[float, Interval]]:
    """Quantiles of `values` (n,) over all cuts, with 95 % intervals (Woodruff 1952: from that of the share below)."""
    order = np.argsort(values)
    share = np.cumsum(weight[order])
    share /= share[-1]

    def value_at(p: float) -> float:
        return float(values[order[min(int(np.searchsorted(share, p)), len(order) - 1)]])

    found = []
    for level in levels:
        quantile = value_at(level)
        half = mean_of((values <= quantile).astype(np.float64), weight).half_width
        found.append((quantile, (value_at(level - half), value_at(level + half))))
    return found


def rms_quotient(errors: Floats, others: Floats, weight: Floats) -> tuple[float, Interval]:
    """rms of `errors` / rms of `others`, both (n,) and of the same passes, with its 95 % interval (paired)."""
    a, b = errors**2, others**2
    mean_a, mean_b = float(weight @ a), float(weight @ b)
    if mean_a == 0.0 or mean_b == 0.0:
        raise ValueError("rms quotient: a sample without any error has no quotient")
    total = float(weight.sum())
    of_log = 0.5 * half_width(weight * (a * (total / mean_a) - b * (total / mean_b)), weight)
    ratio = math.sqrt(mean_a / mean_b)
    return ratio, (ratio * math.exp(-of_log), ratio * math.exp(of_log))
