"""Control charts of a drift: Page's sums of the logarithms of likelihood ratios, and running medians for the picture.

Without a drift the mean of exp(ratio) of a pass is 1, so a sum that begins anew at each pass goes above h with a mean
run length of e^h at least (Lorden 1971). A ratio cut off above only makes the sum smaller, so the bound stays; and no
single pass can then give the alarm.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.logs.drift.causes import Cause
from synth.logs.drift.evidence import Evidence

RUN_LENGTH = 10_000.0
"""Passes between two false alarms, at least, of all charts together."""

MOST = 4.0
"""A ratio counts by so much at most: then an alarm takes three passes at least."""

WINDOW, FEWEST = 25, 10
"""Passes of a running median: so many, and at its beginning so many at least."""


@frozen_arrays
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


def charts_of(evidence: Evidence, run_length: float = RUN_LENGTH) -> Charts:
    """All charts along the passes."""
    kinds = kinds_of(evidence.causes)
    return Charts(kinds, page_sums(steps_of(evidence)), limit_of(len(kinds), run_length))


def page_sums(steps: Floats, before: Floats | float = 0.0) -> Floats:
    """S = max(0, S + step) along the first axis, S = `before` ahead of it: the running sum less its lowest value so
    far."""
    total = before + np.cumsum(steps, axis=0)
    lowest = np.minimum(np.minimum.accumulate(total, axis=0), 0.0)
    return np.asarray(total - lowest)


@frozen_arrays
class CategoryExits:
    """Exits of the passes of one weight category, with a known target: `numbers` of the passes, `errors_m_s` of exit
    speed less target, `medians_m_s` running (`running_medians`). They are for the eye: no alarm comes from them."""

    category: str
    numbers: Ints
    errors_m_s: Floats
    medians_m_s: Floats


def running_medians(errors: Floats) -> Floats:
    """Of each of `errors` (m,) and the `WINDOW` − 1 before it, or as many as there are; NaN for fewer than `FEWEST`.

    A few cuts that saturated the brake hardly move them.
    """
    medians = np.full(len(errors), np.nan)
    for i in range(FEWEST - 1, len(errors)):
        medians[i] = np.median(errors[max(0, i + 1 - WINDOW) : i + 1])
    return medians
