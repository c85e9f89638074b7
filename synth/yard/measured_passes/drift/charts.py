"""Control charts of a drift: Page's sums of the logarithms of likelihood ratios, and moving means for the picture.

Without a drift the mean of exp(ratio) of a pass is 1, so a sum that begins anew at each pass goes above h with a mean
run length of e^h at least (Lorden 1971). A ratio cut off above only makes the sum smaller, so the bound stays; and no
single pass can then give the alarm.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.yard.measured_passes.drift.causes import Cause
from synth.yard.measured_passes.drift.evidence import Evidence

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

RUN_LENGTH = 10_000.0
"""Passes between two false alarms, at least, of all charts together."""

MOST = 4.0
"""A ratio counts by so much at most: then an alarm takes three passes at least."""

MEMORY = 0.1
"""Weight of the newest pass in a moving mean."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Charts:
    """The sums of all watched drifts: `sums` (m, charts) after each pass; `kinds`: (number of the cause, size)."""

    kinds: tuple[tuple[int, float], ...]
    sums: Floats
    limit: float

    @property
    def alarm(self) -> tuple[int, int] | None:
        """(pass, chart) of the first alarm; the highest chart where several are above the limit at once."""
        over = np.flatnonzero((self.sums >= self.limit).any(axis=1))
        return None if len(over) == 0 else (int(over[0]), int(np.argmax(self.sums[over[0]])))

    def zero_before(self, number: int, chart: int) -> int:
        """The pass after which `chart` last was 0 before pass `number`, −1 for the beginning."""
        zeros = np.flatnonzero(self.sums[: number + 1, chart] <= 0.0)
        return int(zeros[-1]) if len(zeros) else -1


def kinds_of(causes: Sequence[Cause]) -> tuple[tuple[int, float], ...]:
    """(number of the cause, size) of all charts."""
    return tuple((number, size) for number, cause in enumerate(causes) for size in cause.watched)


def limit_of(charts: int, run_length: float = RUN_LENGTH) -> float:
    """h of each of so many charts: e^−h is the rate of false alarms of one at most, and rates add up."""
    return math.log(run_length * charts)


def steps_of(evidence: Evidence) -> Floats:
    """What each pass adds to each chart, (m, charts)."""
    columns = [
        evidence.ratios[number][:, evidence.causes[number].sizes.index(size)]
        for number, size in kinds_of(evidence.causes)
    ]
    return np.minimum(np.array(columns).T, MOST)


def charts_of(evidence: Evidence) -> Charts:
    """All charts along the passes."""
    kinds = kinds_of(evidence.causes)
    return Charts(kinds, page_sums(steps_of(evidence)), limit_of(len(kinds)))


def page_sums(steps: Floats) -> Floats:
    """S = max(0, S + step) along the first axis, S = 0 before: the running sum less its lowest value so far."""
    total = np.cumsum(steps, axis=0)
    lowest = np.minimum(np.minimum.accumulate(total, axis=0), 0.0)
    return np.asarray(total - lowest)


@frozen_arrays
@dataclass(frozen=True, eq=False)
class MovingMean:
    """Of the exit errors of one category: `numbers` of its passes, `means` after each, `centre` and limits around."""

    category: str
    numbers: Ints
    means: Floats
    centre: float
    low: Floats
    high: Floats


def moving_mean(category: str, numbers: Ints, errors: Floats, in_order: int) -> MovingMean:
    """Exponentially weighted mean with limits at three standard deviations of it (Roberts 1959).

    Centre and spread are median and quartiles of those of `errors` whose number is below `in_order`; of all where these
    are fewer than 10.
    """
    calm = errors[numbers < in_order]
    calm = errors if len(calm) < 10 else calm
    low, centre, high = np.quantile(calm, [0.25, 0.5, 0.75])
    std = (high - low) / 1.3489795
    means, mean = np.empty(len(errors)), float(centre)
    for i, error in enumerate(errors.tolist()):
        mean += MEMORY * (error - mean)
        means[i] = mean
    memory = (1.0 - MEMORY) ** (2 * np.arange(1, len(errors) + 1))
    reach = 3.0 * std * np.sqrt(MEMORY / (2.0 - MEMORY) * (1.0 - memory))
    return MovingMean(category, numbers, means, float(centre), centre - reach, centre + reach)
