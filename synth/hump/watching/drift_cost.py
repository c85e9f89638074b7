"""What a drift of one retarder costs over the hump: the same trains with the exits of before and with those of now; and
how cuts left, mean and spread of exit speed less target.

Exits are those that were measured, whatever law they have: a cut leaves with its command and a measured error. Each
train has errors drawn anew, with replacement, from those measured, so that few passes tell a cost less well.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import reduce
from typing import Final

import numpy as np
from scipy.special import stdtrit
from scipy.stats import chi2

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.frame.interval import Interval
from synth.hump.rolling.hump_position import Arrivals, HumpPosition, LibraryBrake, Passed, error_uniform, passed_with
from synth.hump.rolling.outcomes import TrainOutcomes, joined
from synth.hump.trains.batch import trains_of_batch
from synth.hump.trains.train_figures import Of, shift_sums
from synth.hump.trial.trial import HumpTrial
from synth.hump.watching.settings import CostSettings

FEWEST = 3
"""Passes; fewer have no spread."""


@dataclass(frozen=True)
class ExitLaw:
    """Mean and standard deviation of exit errors; intervals are Student's, and that of χ² for a normal law."""

    mean_m_s: Interval
    std_m_s: Interval


def exit_law(errors_m_s: Floats) -> ExitLaw | None:
    """Of the errors that are known; None for fewer than `FEWEST`."""
    known = errors_m_s[np.isfinite(errors_m_s)]
    n = len(known)
    if n < FEWEST:
        return None
    mean, std = float(known.mean()), float(known.std(ddof=1))
    half = float(stdtrit(n - 1, 0.975)) * std / math.sqrt(n)
    low, high = (std * math.sqrt((n - 1) / float(chi2.ppf(q, n - 1))) for q in (0.975, 0.025))
    return ExitLaw(Interval(mean, mean - half, mean + half, n), Interval(std, low, high, n))


FEWEST_ERRORS: Final = 10
"""Passes on each side of the beginning of a drift; fewer do not tell how cuts leave."""

HIDDEN_EVENTS: Final = 3.69
"""So many events may be expected, and none is seen with a chance of 2.5 % (Poisson)."""

SUMMED: Final = ("value", "residual", "slope", "least")
"""What adds up where figures do."""


@frozen_arrays
class MeasuredRetarder:
    """A position of which one `retarder` lets cuts go with measured errors, and the others as `others` do.

    `errors_m_s` (trains, n): of each train, rising; `brake` holds what is possible.
    """

    others: HumpPosition
    retarder: int
    errors_m_s: Floats
    brake: LibraryBrake

    def passed(self, arrivals: Arrivals) -> Passed:
        """See `HumpPosition`."""
        own = arrivals.retarder == self.retarder
        exit_m_s, time_s, switchings = np.empty(len(own)), np.empty(len(own)), np.empty(len(own), np.int64)
        for which, model in ((own, self.of_own), (~own, self.others.passed)):
            if which.any():
                part = model(arrivals.chosen(which))
                exit_m_s[which], time_s[which], switchings[which] = part.exit_m_s, part.time_s, part.switchings
        return Passed(exit_m_s, time_s, switchings)

    def of_own(self, arrivals: Arrivals) -> Passed:
        """Those of the measured retarder."""
        place = (error_uniform(arrivals) * self.errors_m_s.shape[1]).astype(np.int64)
        return passed_with(arrivals, self.errors_m_s[arrivals.train, place], self.brake(arrivals))


@dataclass(frozen=True)
class Retarder:
    """One retarder of the hump of `trial`, by its number, that of its position from 0, and its `brake`."""

    trial: HumpTrial
    number: int
    position: int
    brake: LibraryBrake

    def humped(self, errors_m_s: Floats, trains: int) -> TrainOutcomes:
        """The first trains where it lets cuts go with these errors (trains, n)."""
        positions = list(self.trial.positions)
        positions[self.position] = MeasuredRetarder(
            positions[self.position], self.number, np.sort(errors_m_s, axis=1), self.brake
        )
        trial, most = replace(self.trial, positions=tuple(positions)), trains_of_batch(self.trial.tracks.shift_trains)
        parts = [trial.batch(first, min(most, trains - first)) for first in range(0, trains, most)]
        return joined(parts)


@frozen_arrays
class Difference:
    """A figure with the drift less without: its `value`, what each shift of trains differs from that by (shifts,), its
    `slope` (2,) over mean and spread of the drawn errors, whose covariance `law` is (2, 2), and the `least` half width
    of its interval: what events that these trains hide by chance would make."""

    value: float
    residual: Floats
    slope: Floats
    law: Floats
    least: float
    trains: int

    @property
    def by_passes(self) -> float:
        """Variance of the value because few passes were measured."""
        return float(self.slope @ self.law @ self.slope)

    @property
    def told(self) -> Interval:
        """With its 95 % interval."""
        half = max(self.least, half_width(self.residual, self.by_passes))
        return Interval(self.value, self.value - half, self.value + half, self.trains)

    def times(self, weight: float) -> Difference:
        """With a weight."""
        return replace(self, **{name: weight * getattr(self, name) for name in SUMMED})

    def plus(self, other: Difference) -> Difference:
        """Together with another one of the same drift."""
        return replace(self, **{name: getattr(self, name) + getattr(other, name) for name in SUMMED})

    def above(self, other: Difference) -> bool:
        """Whether it is larger than that of another drift for sure; both are of the same trains."""
        half = half_width(self.residual - other.residual, self.by_passes + other.by_passes)
        return self.value - other.value > max(half, self.least, other.least)


def half_width(residual: Floats, more_variance: float) -> float:
    """Of a 95 % interval, Student's."""
    count = len(residual)
    return float(stdtrit(count - 1, 0.975) * np.sqrt(residual.var(ddof=1) / count + more_variance))


@dataclass(frozen=True)
class DriftCost:
    """More over-speed couplings an hour, cars an hour that are lost, and more metres of gap an hour."""

    overspeeds_per_hour: Difference
    cars_lost_per_hour: Difference
    gap_m_per_hour: Difference

    def weight_per_hour(self, weights: CostSettings) -> Difference:
        """All that has become worse, in cars an hour. What has become better does not make up for it: a drift towards
        slow exits has fewer over-speeds, and is a drift all the same."""
        parts = (
            (1.0, self.cars_lost_per_hour),
            (weights.cars_per_overspeed, self.overspeeds_per_hour),
            (weights.cars_per_gap_m, self.gap_m_per_hour),
        )
        worse = [part.times(weight) for weight, part in parts if part.value > 0.0]
        return reduce(Difference.plus, worse) if worse else self.cars_lost_per_hour


def drift_cost(retarder: Retarder, before_m_s: Floats, since_m_s: Floats, trains: int) -> DriftCost | None:
    """Of exits whose errors were `before_m_s` and are now `since_m_s`; None where too few are known."""
    known = [each[np.isfinite(each)] for each in (before_m_s, since_m_s)]
    if min(map(len, known)) < FEWEST_ERRORS:
        return None
    rng = np.random.Generator(np.random.SFC64(np.random.SeedSequence(retarder.number)))
    drawn = [each[rng.integers(0, len(each), (trains, len(each)))] for each in known]
    found = [retarder.humped(each, trains) for each in drawn]
    law = np.stack([moment(drawn[1], axis=1) - moment(drawn[0], axis=1) for moment in (np.mean, np.std)], axis=1)

    hours = float(found[0].span_s.sum()) / 3600.0

    def more(of: Of, event: float) -> Difference:
        return difference(found, of, law, HIDDEN_EVENTS * event / hours)

    cars = float(found[0].cars.sum() / found[0].cuts.sum())
    gap_m = float(found[0].gap_m.sum() / found[0].judged.sum())
    return DriftCost(
        more(overspeeds, 1.0),
        more(lambda trains_of: -good_cars(trains_of), cars),
        more(lambda trains_of: trains_of.gap_m, gap_m),
    )


def overspeeds(found: TrainOutcomes) -> Floats:
    """Couplings of each train that are too fast."""
    return np.asarray(found.overspeed.sum(axis=1).astype(float))


def good_cars(found: TrainOutcomes) -> Floats:
    """Cars of each train that need not be humped again: those of cuts that caught up must be."""
    return np.asarray(found.span_cars - found.caught * found.cars / found.cuts)


def difference(found: list[TrainOutcomes], of: Of, law: Floats, least: float) -> Difference:
    """By how much `of`, an hour, is more in the second of `found` than in the first; `law` (trains, 2): how much the
    drawn errors of each train differ in mean and spread; `least` half width of the interval.

    The slope of the figure over both says what the passes that were measured leave open.
    """
    value, residual = 0.0, 0.0
    for sign, trains in ((-1.0, found[0]), (1.0, found[1])):
        hits, hours = (shift_sums(trains, each) for each in (of(trains), trains.span_s / 3600.0))
        rate = float(hits.sum() / hours.sum())
        value += sign * rate
        residual = residual + sign * (hits - rate * hours) / hours.mean()
    of_shift = shift_sums(found[0], law)
    of_shift *= len(of_shift) / len(law)
    slope = np.linalg.lstsq(of_shift - of_shift.mean(axis=0), residual, rcond=None)[0]
    return Difference(value, np.asarray(residual), np.asarray(slope), np.cov(law.T), least, len(found[0]))
