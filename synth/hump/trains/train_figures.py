"""Figures of many trains with their 95 % intervals, and whether the brake of a position is strong enough for them.

Trains of one shift come to the same tracks, so they are not independent: a shift, which may be a single train, is
drawn, and is what intervals count.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv, stdtrit

from plant_models.frozen_arrays import Floats, Ints
from synth.frame.interval import Interval
from synth.hump.rolling.outcomes import TrainOutcomes


def in_shifts(found: TrainOutcomes) -> bool:
    """Whether some of the trains are of one shift."""
    return shifts_in(found) < len(found)


def shifts_in(found: TrainOutcomes) -> int:
    """How many shifts the trains are of."""
    return len(np.unique(found.shift))


def shift_sums(found: TrainOutcomes, values: NDArray[Any], shift: Ints | None = None) -> Floats:
    """The sum of `values` (n, …) of the trains `found` over each shift, (shifts, …); `shift` (n,): other shifts that
    the trains are counted in."""
    numbers = found.shift if shift is None else shift
    begins = np.flatnonzero(np.diff(numbers, prepend=numbers[:1] - 1))
    return np.asarray(np.add.reduceat(values.astype(float), begins, axis=0))


def longer_shifts(one: TrainOutcomes, other: TrainOutcomes) -> Ints:
    """The shifts of two runs of the same trains in which both are independent: the longer ones of both."""
    return one.shift if shifts_in(one) <= shifts_in(other) else other.shift


CONFIDENCE = 0.95
FEWEST_TRAINS = 2

WANTED = 0.005
"""How exactly a share is wanted, either way, unless told otherwise."""

NEGLIGIBLE = 1e-3
"""So small a part of a share is nothing."""


@dataclass(frozen=True)
class TrainFigure:
    """A figure of `n` cuts (or trains), with its 95 % interval, NaN where the trains are too few.

    `enough_n`: how many would tell it as exactly as it is wanted, N = t²·p(1 − p)/ε² times what cuts of one train have
    in common; NaN for what is no share.
    """

    name: str
    unit: str
    value: float
    low95: float
    high95: float
    n: int
    enough_n: float = float("nan")

    @property
    def is_share(self) -> bool:
        """A share is of cuts, a mean of trains."""
        return not np.isnan(self.enough_n)

    @property
    def told(self) -> Interval | float:
        """The figure as it is shown."""
        return interval_of(self.value, self.low95, self.high95, self.n)


def interval_of(value: float, low95: float, high95: float, n: int) -> Interval | float:
    """The figure with its interval; alone where the trains are too few for one, NaN where there is none."""
    return value if np.isnan(low95) or np.isnan(high95) else Interval(value, low95, high95, n)


def ratio(hits: Floats, base: Floats) -> tuple[float, float, float]:
    """Σ hits / Σ base over trains, with the interval of a ratio: Student's, linearised, trains being independent.

    It covered the truth in 94 to 96 % of 1000 sets of at least 20 trains that had 80 hits or more together; of rare
    hits it covers less: these are told by `share`.
    """
    trains, total = len(base), float(base.sum())
    if total == 0.0:
        return float("nan"), float("nan"), float("nan")
    value = float(hits.sum()) / total
    if trains < FEWEST_TRAINS:
        return value, float("nan"), float("nan")
    residual = (hits - value * base) / (total / trains)
    half = float(stdtrit(trains - 1, 0.5 + 0.5 * CONFIDENCE)) * float(residual.std(ddof=1)) / np.sqrt(trains)
    return value, value - half, value + half


def share(hits: Floats, base: Floats) -> tuple[float, float, float, float]:
    """Share of cuts with its interval, and how much larger its variance is than that of independent cuts.

    Korn and Graubard, Survey Methodology 24 (1998): the exact interval (Clopper and Pearson) of as many independent
    cuts as these are worth, with Student's quantile for few trains; valid for rare events, too, also if there was none.
    It covered the truth in 95 to 100 % of 1000 sets of 20 to 1000 trains with 40 cuts and shares of 0.001 to 0.1, where
    the cuts of a train are independent. Where they have a correlation of 0.1: in 94 to 95 % of the sets with 80
    expected hits or more, in 92 to 94 % with 40, but only in 78 to 83 % with 4 to 8. So few hits do not tell how they
    cluster, and the upper end is then too low.

    Two or three trains are worth so few cuts that the lower end may be 1e-60: one below `NEGLIGIBLE` of the share is 0;
    likewise the upper end 1, by the share of the other cuts.
    """
    trains, total, found = len(base), float(base.sum()), float(hits.sum())
    if total == 0.0:
        return float("nan"), float("nan"), float("nan"), float("nan")
    p = found / total
    effect = 1.0
    if trains >= FEWEST_TRAINS and 0.0 < p < 1.0:
        residual = (hits - p * base) / (total / trains)
        effect = max(float(residual.var(ddof=1)) / trains * total / (p * (1.0 - p)), 1.0)
    few = 1.0
    if trains >= FEWEST_TRAINS:
        few = float(stdtrit(trains - 1, 0.975) / stdtrit(max(total - 1.0, 1.0), 0.975)) ** 2
    n = total / (effect * few)
    k = p * n
    tail = 0.5 * (1.0 - CONFIDENCE)
    low = float(betaincinv(k, n - k + 1.0, tail)) if k > 0.0 else 0.0
    high = float(betaincinv(k + 1.0, n - k, 1.0 - tail)) if k < n else 1.0
    return p, low if low >= NEGLIGIBLE * p else 0.0, high if 1.0 - high >= NEGLIGIBLE * (1.0 - p) else 1.0, effect


Of = Callable[[TrainOutcomes], Floats]
"""A number of each train, (n,)."""


@dataclass(frozen=True)
class FigureOf:
    """How a figure follows from trains: Σ `hits` / Σ `base`; `is_share`: of cuts, else a mean over trains."""

    name: str
    unit: str
    hits: Of
    base: Of
    is_share: bool

    def figure(self, found: TrainOutcomes, wanted_share: float = WANTED) -> TrainFigure:
        """The figure of some trains with its interval; `wanted_share`: for `enough_n`."""
        hits, base = (shift_sums(found, of(found)) for of in (self.hits, self.base))
        if not self.is_share:
            return TrainFigure(self.name, self.unit, *ratio(hits, base), len(base))
        p, low, high, effect = share(hits, base)
        enough = 1.959964**2 * p * (1.0 - p) / wanted_share**2 * effect
        return TrainFigure(self.name, self.unit, p, low, high, int(base.sum()), enough)

    def difference(self, found: TrainOutcomes, other: TrainOutcomes) -> tuple[float, float, float]:
        """By how much the figure of `found` is more than that of `other`, which are the same trains, with the interval
        of Student's, linearised, paired by train, or by shift; NaN where there is none."""
        shift = longer_shifts(found, other)
        shifts = len(np.unique(shift))
        residual, value = np.zeros(shifts), 0.0
        for sign, trains in ((1.0, found), (-1.0, other)):
            hits, base = (shift_sums(trains, of(trains), shift) for of in (self.hits, self.base))
            if len(base) < FEWEST_TRAINS or base.sum() == 0.0:
                return float("nan"), float("nan"), float("nan")
            p = float(hits.sum() / base.sum())
            value += sign * p
            residual += sign * (hits - p * base) / base.mean()
        half = float(stdtrit(shifts - 1, 0.5 + 0.5 * CONFIDENCE)) * float(residual.std(ddof=1)) / np.sqrt(shifts)
        return value, value - half, value + half


def of_cuts(name: str, hits: Callable[[TrainOutcomes], Ints]) -> FigureOf:
    """A share of all cuts."""
    return FigureOf(name, "1", lambda found: hits(found).astype(float), lambda found: found.cuts.astype(float), True)


def of_judged(name: str, hits: Callable[[TrainOutcomes], Ints]) -> FigureOf:
    """A share of the cuts that reached a track."""
    return FigureOf(name, "1", lambda found: hits(found).astype(float), lambda found: found.judged.astype(float), True)


def mean(name: str, unit: str, hits: Of, base: Of) -> FigureOf:
    """A mean over trains."""
    return FigureOf(name, unit, hits, base, False)


def trains_in(found: TrainOutcomes) -> Floats:
    """One for each train."""
    return np.ones(len(found))


FIGURES: Final = (
    mean("hump_speed", "m/s", lambda found: found.span_m, lambda found: found.span_s),
    mean("cars_per_hour", "1/h", lambda found: 3600.0 * found.span_cars, lambda found: found.span_s),
    of_cuts("catch_ups", lambda found: found.caught),
    of_cuts("misrouted", lambda found: found.misrouted.sum(axis=1)),
    of_cuts("contacts", lambda found: found.contact.sum(axis=1)),
    of_cuts("contacts_in_last_position", lambda found: found.caught_in_last),
    of_cuts("caught_on_track", lambda found: found.caught_on_track),
    of_cuts("stopped_on_the_way", lambda found: found.stopped),
    of_cuts("no_room", lambda found: found.no_room),
    mean(
        "unseparated_elements_per_cut",
        "1",
        lambda found: found.unseparated.sum(axis=1).astype(float),
        lambda found: found.cuts.astype(float),
    ),
    of_judged("overspeed", lambda found: found.overspeed.sum(axis=1)),
    of_judged("overspeed_slight", lambda found: found.overspeed[:, 0]),
    of_judged("overspeed_rough", lambda found: found.overspeed[:, 1]),
    of_judged("overspeed_harmful", lambda found: found.overspeed[:, 2]),
    mean("gap_per_cut", "m", lambda found: found.gap_m, lambda found: found.judged.astype(float)),
    mean("occupied_share", "1", lambda found: found.occupied, trains_in),
)
"""The figures that are told of all trains."""

OF_SHIFTS: Final = (
    mean("pushed_up_per_train", "1", lambda found: found.pushed_up.astype(float), trains_in),
    mean("pulled_per_train", "1", lambda found: found.pulled.astype(float), trains_in),
)
"""Those of trains in shifts."""

OF_VALVES: Final = mean(
    "strokes_per_pass",
    "1",
    lambda found: found.strokes.sum(axis=1).astype(float),
    lambda found: found.passes.sum(axis=1).astype(float),
)
"""That of positions which model their valves."""


def figures_told(found: TrainOutcomes) -> tuple[FigureOf, ...]:
    """The figures that these trains have."""
    shifts = OF_SHIFTS if in_shifts(found) else ()
    return (*FIGURES, *shifts, *((OF_VALVES,) if found.strokes.any() else ()))


def train_figures(found: TrainOutcomes, wanted_share: float = WANTED) -> tuple[TrainFigure, ...]:
    """The figures of trains; `wanted_share`: for `enough_n` of shares."""
    return tuple(each.figure(found, wanted_share) for each in figures_told(found))


MOST_SHORT: Final = 0.01
"""A position with a larger share of cuts that left too fast for want of brake is too weak for them: assumed."""


def weak(short: TrainFigure) -> bool:
    """Whether the share is for sure above the limit."""
    return short.low95 > MOST_SHORT


def strengths(found: TrainOutcomes) -> tuple[TrainFigure, ...]:
    """Of all positions, in order from the crest: the share of the passes that ended faster than commanded for want of
    brake; NaN where there was no pass."""
    sums = (
        [shift_sums(found, each[:, place]) for each in (found.short, found.passes)]
        for place in range(found.passes.shape[1])
    )
    return tuple(TrainFigure("short", "1", *share(short, passes)[:3], int(passes.sum())) for short, passes in sums)
