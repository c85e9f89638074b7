"""The figures of humped trains with their intervals, and how they differ between two variants.

Figures and differences are by the names of `HumpRates`. Differences are paired by train where both variants humped the
same trains.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from plant_models.errors import require
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.computer.economics.ranges import Range, range_of
from synth.computer.economics.traffic import RATES, HumpChange, HumpRates
from synth.frame.interval import Interval
from synth.frame.settings.settings_file import made
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trains.train_figures import FEWEST_TRAINS, longer_shifts, share, shift_sums, train_figures

SECONDS_PER_H = 3600.0

NAMES = {
    "cars_per_h": "cars_per_hour",
    "catch_ups": "catch_ups",
    "misrouted": "misrouted",
    "over_speeds_to_1_5": "overspeed_slight",
    "over_speeds_to_2": "overspeed_rough",
    "over_speeds_above_2": "overspeed_harmful",
    "gap_m": "gap_per_cut",
}
"""Our figures, and what `hump simulate` calls them in `summary.json`; it does not tell `on_track`."""


@frozen_arrays
class TrainSums:
    """Of n trains, or shifts of them, what each figure of `HumpRates` counts and what it is a share of: `hits`, `base`
    (8, n)."""

    hits: Floats
    base: Floats

    def rates(self, weight: Floats | None = None) -> HumpRates:
        """The figures of all trains; `weight` (n,): how often each train counts, 1 if not told."""
        counts = np.ones(self.hits.shape[1]) if weight is None else weight
        ratios = (self.hits @ counts) / (self.base @ counts)
        return HumpRates(**{name: float(ratio) for name, ratio in zip(RATES, ratios, strict=True)})


def train_sums(found: TrainOutcomes, shift: Ints | None = None) -> TrainSums:
    """What the trains of a hump trial count, in the order of `HumpRates`, by shift: its own, or others (n,)."""
    cuts, judged = found.cuts.astype(float), found.judged.astype(float)
    hits = (
        SECONDS_PER_H * found.span_cars,
        found.caught,
        found.misrouted.sum(axis=1),
        judged,
        *found.overspeed.T,
        found.gap_m,
    )
    base = (found.span_s, cuts, cuts, cuts, judged, judged, judged, judged)
    summed = (np.array([shift_sums(found, np.asarray(each), shift) for each in rows]) for rows in (hits, base))
    return TrainSums(*summed)


def figures_of_trains(found: TrainOutcomes) -> dict[str, Interval]:
    """The figures of trains that were humped, with the intervals that `train_figures` gives them."""
    require(len(found) >= FEWEST_TRAINS, f"a hump variant has {len(found)} trains; an interval takes two")
    told = {figure.name: figure for figure in train_figures(found)}
    figures = {ours: told[theirs] for ours, theirs in NAMES.items()}
    intervals = {name: Interval(each.value, each.low95, each.high95, each.n) for name, each in figures.items()}
    p, low, high, _ = share(found.judged.astype(float), found.cuts.astype(float))
    return {**intervals, "on_track": Interval(p, low, high, int(found.cuts.sum()))}


def rates_of(figures: Mapping[str, Interval]) -> HumpRates:
    """The figures without their intervals; `PlantError` for one outside its range."""
    return made(HumpRates, **{name: figures[name].value for name in RATES})


def change_of(differences: Mapping[str, Interval]) -> HumpChange:
    """The differences without their intervals."""
    return HumpChange(**{name: differences[name].value for name in RATES})


def change_of_trains(today: TrainOutcomes, new: TrainOutcomes) -> dict[str, Interval]:
    """New less today where both humped the same trains, in the same order (`PlantError` otherwise).

    Ratios of sums over trains, linearised: residual of train k = (h'_k − r'b'_k)/b̄' − (h_k − r·b_k)/b̄; its standard
    error over the trains with Student's quantile is half the interval. What the trains have in common cancels. It held
    the truth in 93 to 96 % of 1000 sets of 100 trains, with shares from 0.01 to 0.07.
    """
    one, other = same_trains(today, new)
    trains = one.hits.shape[1]
    residual, value = np.zeros_like(one.hits), np.zeros(len(one.hits))
    for sign, sums in ((-1.0, one), (1.0, other)):
        ratio = sums.hits.sum(axis=1) / sums.base.sum(axis=1)
        value += sign * ratio
        residual += sign * (sums.hits - ratio[:, None] * sums.base) / sums.base.mean(axis=1)[:, None]
    half = student_975(trains - 1) * residual.std(axis=1, ddof=1) / math.sqrt(trains)
    found = [Interval(float(v), float(v - h), float(v + h), trains) for v, h in zip(value, half, strict=True)]
    return dict(zip(RATES, found, strict=True))


def same_trains(today: TrainOutcomes, new: TrainOutcomes) -> tuple[TrainSums, TrainSums]:
    """The sums of both; `PlantError` unless they are of the same trains, at least two."""
    require(
        len(today) == len(new) and np.array_equal(today.train, new.train) and np.array_equal(today.cuts, new.cuts),
        f"the variants humped {len(today)} and {len(new)} trains that are not the same; pairs must be",
    )
    require(len(today) >= FEWEST_TRAINS, f"the variants have {len(today)} trains; intervals take two or more")
    shift = longer_shifts(today, new)
    return train_sums(today, shift), train_sums(new, shift)


def change_of_figures(today: Mapping[str, Interval], new: Mapping[str, Interval]) -> dict[str, Interval]:
    """New less today from two sets of figures, as if their trains had nothing in common.

    The halves of both intervals are added as squares, each towards its end. With common trains the interval
    is wider than it need be, as long as what is good for a train in one variant is good for it in the other.
    """
    return {name: unpaired(today[name], new[name]) for name in RATES}


def ranges_of_change(differences: Mapping[str, Interval]) -> dict[str, Range]:
    """The differences as inputs of an `EconomicCase` by name, each within its interval and independent of the
    others."""
    return {f"change.{name}": range_of(differences[name]) for name in RATES}


def unpaired(today: Interval, new: Interval) -> Interval:
    """New less today of independent figures (Zou and Donner, Statistics in Medicine 27 (2008), 1693)."""
    value = new.value - today.value
    low = math.hypot(new.value - new.low95, today.high95 - today.value)
    high = math.hypot(new.high95 - new.value, today.value - today.low95)
    return Interval(value, value - low, value + high, min(today.n, new.n))


def student_975(freedom: int) -> float:
    """97.5 % quantile of Student's law."""
    from scipy.special import stdtrit  # start-up: scipy only where it is needed

    return float(stdtrit(freedom, 0.975))
