"""Which drift it is that an alarm tells of, since which pass, and how large: the most likely size on the passes
that have it, by the likelihood itself.

Each cause is given its most likely size and beginning on the passes up to now; the one with the largest likelihood is
named.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from plant_models.frozen_arrays import Floats
from synth.logs.drift.causes import TIMES, Cause
from synth.logs.drift.charts import Charts
from synth.logs.drift.evidence import Evidence, evidence_of
from synth.logs.estimate import FALL95
from synth.logs.fitting_passes import FittingPasses

BACK = 30
"""A drift may have begun so many passes before the chart that gave the alarm left 0."""

FURTHER = 250
"""Passes after an alarm that the decision takes at most."""

ODDS = 500.0
"""A cause is named where it is so many times as likely as the next one.

Each has its best size and beginning, and the question is asked anew after every pass until the answer is yes: with 50,
5 in 100 names of a slow exhaust without gauge were wrong."""

NEAR = 8.0
"""Sizes whose logarithms of likelihood differ by less have a parabola through them."""


@dataclass(frozen=True)
class Gain:
    """Of one cause: its most likely size and beginning, and the logarithm of its likelihood over that of no drift."""

    cause: Cause
    size: float
    begin: int
    log_gain: float


@dataclass(frozen=True)
class Diagnosis:
    """What is behind an alarm, known by the passes up to and with `until`.

    `gains`: of all causes, the most likely first; `begins95`: earliest and latest pass that the drift of the first one
    may have begun with.
    """

    alarm: int
    until: int
    gains: tuple[Gain, ...]
    begins95: tuple[int, int]

    @property
    def first(self) -> Gain:
        """The most likely cause."""
        return self.gains[0]

    @property
    def odds(self) -> float:
        """How many times as likely as the next one the first one is, each at its own best."""
        return math.exp(min(self.gains[0].log_gain - self.gains[1].log_gain, 700.0))

    @property
    def decided(self) -> bool:
        """Whether the first cause is the cause."""
        return self.odds >= ODDS


def diagnosed(evidence: Evidence, charts: Charts) -> Diagnosis | None:
    """What is behind the first alarm, decided as early as the odds allow; None without an alarm."""
    if charts.alarm is None:
        return None
    alarm = charts.alarm[0]
    last = min(alarm + FURTHER, len(evidence) - 1)
    for until in range(alarm, last):
        found = gains_of(evidence, charts, until)
        if found[0].log_gain - found[1].log_gain >= math.log(ODDS):
            return diagnosis(evidence, charts, until, found)
    return diagnosis(evidence, charts, last, gains_of(evidence, charts, last))


def first_begin(charts: Charts) -> int:
    """The earliest pass that the drift behind the first alarm is taken to have begun with."""
    assert charts.alarm is not None
    return max(0, charts.zero_before(*charts.alarm) + 1 - BACK)


def gains_of(evidence: Evidence, charts: Charts, until: int) -> tuple[Gain, ...]:
    """All causes by the passes up to `until`, the most likely first."""
    begin = first_begin(charts)
    found = []
    for cause, ratio in zip(evidence.causes, evidence.ratios, strict=True):
        sums = from_each(ratio[begin : until + 1])
        number = int(np.argmax(sums.max(axis=1)))
        size, gain = highest(cause, sums[number])
        found.append(Gain(cause, size, begin + number, gain))
    return tuple(sorted(found, key=lambda gain: -gain.log_gain))


def diagnosis(evidence: Evidence, charts: Charts, until: int, gains: tuple[Gain, ...]) -> Diagnosis:
    """`gains`, with the interval of the beginning."""
    assert charts.alarm is not None
    first, begin = gains[0], first_begin(charts)
    ratio = evidence.ratios[evidence.causes.index(first.cause)]
    by_begin = np.array([highest(first.cause, row)[1] for row in from_each(ratio[begin : until + 1])])
    near = begin + np.flatnonzero(by_begin >= by_begin.max() - FALL95)
    return Diagnosis(charts.alarm[0], until, gains, (int(near[0]), int(near[-1])))


def from_each(ratio: Floats) -> Floats:
    """Sums from each pass to the last, (m, sizes)."""
    return np.asarray(np.cumsum(ratio[::-1], axis=0)[::-1])


def scaled(cause: Cause, sizes: Sequence[float] | Floats) -> Floats:
    """Sizes on the scale of their steps: logarithms of factors."""
    values = np.asarray(sizes, dtype=np.float64)
    return np.asarray(np.log(values)) if cause.scale is TIMES else values


def unscaled(cause: Cause, value: float) -> float:
    """The size at a place on that scale."""
    return math.exp(value) if cause.scale is TIMES else value


def highest(cause: Cause, total: Floats) -> tuple[float, float]:
    """(most likely size, gain there) of summed ratios (sizes,): the best of the sizes.

    Where its neighbours are not far below, by the parabola through the three. Farther apart a parabola is no likelihood
    any more: it would rise above the best size by more than the truth does.
    """
    k = int(np.argmax(total))
    if not 0 < k < len(total) - 1 or total[k] - min(total[k - 1], total[k + 1]) > NEAR:
        return cause.sizes[k], float(total[k])
    at = scaled(cause, cause.sizes)
    slope, bend = 0.5 * (total[k + 1] - total[k - 1]), total[k + 1] - 2.0 * total[k] + total[k - 1]
    if bend >= 0.0:
        return cause.sizes[k], float(total[k])
    return unscaled(cause, float(at[k] - slope / bend * (at[k + 1] - at[k]))), float(total[k] - 0.5 * slope**2 / bend)


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
