"""Curves of cars an hour against catch-ups, and where they meet the share that is allowed, or pass a speed, with
intervals from bootstrap samples.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.frame.interval import Interval
from synth.hump.capacity.variants import Variant
from synth.hump.rolling.outcomes import TrainOutcomes, same_trains
from synth.hump.trains.train_figures import TrainFigure, shift_sums, shifts_in, train_figures

REPLICATES = 2000

FEWEST_EVENTS = 10.0
"""Catch-ups that the trains must have at a limit; with fewer the bootstrap has nothing to draw from."""


@frozen_arrays
class Sums:
    """Of each bootstrap replicate (rows; the first is the sample itself) and each program, safest first: share of
    catch-ups, mean hump speed, cars an hour."""

    catch_ups: Floats
    hump_speed_m_s: Floats
    cars_per_hour: Floats

    def crossing(self, limit: float) -> tuple[Floats, Floats]:
        """Speed and cars an hour (rows,) where the share passes `limit`, linear in between; −∞ and ∞ where it does so
        ahead of the first program or behind the last."""
        beyond = self.catch_ups > limit
        behind = beyond.argmax(axis=1)
        rows = np.arange(len(beyond))
        ahead = np.maximum(behind - 1, 0)
        low, high = self.catch_ups[rows, ahead], self.catch_ups[rows, behind]
        part = np.where(high > low, (limit - low) / np.where(high > low, high - low, 1.0), 0.0)
        found = []
        for values in (self.hump_speed_m_s, self.cars_per_hour):
            between = values[rows, ahead] + part * (values[rows, behind] - values[rows, ahead])
            between = np.where(behind == 0, -np.inf, between)
            found.append(np.where(beyond.any(axis=1), between, np.inf))
        return found[0], found[1]

    def at_speed(self, hump_speed_m_s: float) -> Floats:
        """Share of catch-ups (rows,) where the mean hump speed is passed first, linear in between; NaN if it is not."""
        faster = self.hump_speed_m_s >= hump_speed_m_s
        behind, rows = faster.argmax(axis=1), np.arange(len(faster))
        ahead = np.maximum(behind - 1, 0)
        low, high = self.hump_speed_m_s[rows, ahead], self.hump_speed_m_s[rows, behind]
        part = np.where(high > low, (hump_speed_m_s - low) / np.where(high > low, high - low, 1.0), 0.0)
        share = self.catch_ups[rows, ahead] + part * (self.catch_ups[rows, behind] - self.catch_ups[rows, ahead])
        return np.where(faster.any(axis=1) & (behind > 0), share, np.nan)


def sums_of(outcomes: list[TrainOutcomes], weights: Floats, shift: Ints | None = None) -> Sums:
    """Those of the programs of a curve; `weights` (rows, shifts): how often each shift is drawn; `shift` (trains,):
    other shifts that the trains are counted in."""

    def total(name: str) -> Floats:
        return np.stack([weights @ shift_sums(each, getattr(each, name), shift) for each in outcomes], axis=1)

    seconds = total("span_s")
    return Sums(total("caught") / total("cuts"), total("span_m") / seconds, 3600.0 * total("span_cars") / seconds)


def drawn_weights(shifts: int, seed: int) -> Floats:
    """Bootstrap weights (1 + REPLICATES, shifts); the first row is one each."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    drawn = rng.multinomial(shifts, np.full(shifts, 1.0 / shifts), REPLICATES)
    return np.concatenate((np.ones((1, shifts)), drawn.astype(float)))


def enough_for(limit: float, cuts: int) -> bool:
    """Whether so many cuts carry a share as small as this."""
    return limit * cuts >= FEWEST_EVENTS


def decided(values: Floats, trains: int) -> Interval | None:
    """The value of the sample of `trains` (the first) with the percentile interval of its replicates (the others), if
    all three are finite."""
    if not np.isfinite(values[0]):
        return None
    ordered = np.sort(values[1:])
    low, high = (float(ordered[int(q * (len(ordered) - 1))]) for q in (0.025, 0.975))
    value = float(values[0])
    if not np.isfinite((low, high)).all():
        return None
    return Interval(value, min(low, value), max(high, value), trains)


@dataclass(frozen=True)
class Axis:
    """What changes along a curve: the `key` of the trial, what people call it, its unit, its values, safest first."""

    key: str
    name: str
    unit: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class Point:
    """One value of the axis, and what its trains came to."""

    value: float
    hump_speed_m_s: TrainFigure
    cars_per_hour: TrainFigure
    catch_ups: TrainFigure


@dataclass(frozen=True)
class AtLimit:
    """Where a curve has the allowed share of catch-ups, by lines between its points, with bootstrap intervals of whole
    shifts, which may be single trains; without them, `why` tells what the trains do not decide."""

    hump_speed_m_s: Interval | None
    cars_per_hour: Interval | None
    why: str = ""


@dataclass(frozen=True)
class Curve:
    """The points of a variant; `more_cars_per_hour`: at the limit, than the first curve, where both hump the same
    trains."""

    variant: Variant
    points: tuple[Point, ...]
    at_limit: AtLimit
    more_cars_per_hour: Interval | None


def point_of(value: float, found: TrainOutcomes) -> Point:
    """The figures of one trial."""
    told = {figure.name: figure for figure in train_figures(found)}
    return Point(value, told["hump_speed"], told["cars_per_hour"], told["catch_ups"])


def curves(
    variants: Sequence[Variant], axis: Axis, found: Sequence[Sequence[TrainOutcomes]], limit: float, seed: int
) -> Iterator[Curve]:
    """A curve each of `variants`, from the outcomes `found` of its points, as many trains each; `seed`: of the
    bootstrap, whose draws are common to all curves."""
    first, trains = found[0][0], len(found[0][0])
    shift = min((each[0] for each in found), key=shifts_in).shift
    drawn = len(np.unique(shift))
    weights = drawn_weights(drawn, seed)
    first_sums = sums_of(list(found[0]), weights, shift)
    for place, (variant, outcomes) in enumerate(zip(variants, found, strict=True)):
        cuts, sums = int(outcomes[0].cuts.sum()), sums_of(list(outcomes), weights, shift)
        points = tuple(map(point_of, axis.values, outcomes))
        more = None
        if place > 0 and same_trains(first, outcomes[0]):
            more = difference(sums, first_sums, limit, Drawn(drawn, trains, cuts))
        yield Curve(variant, points, at_limit(sums, points, limit, Drawn(drawn, trains, cuts)), more)


@dataclass(frozen=True)
class Drawn:
    """What a point of a curve is drawn from: `shifts`, which are independent, of so many trains and cuts together."""

    shifts: int
    trains: int
    cuts: int


def at_limit(sums: Sums, points: Sequence[Point], limit: float, drawn: Drawn) -> AtLimit:
    """Where a curve has the share `limit`, or why it is not told."""
    if not enough_for(limit, drawn.cuts):
        wanted = ceil(FEWEST_EVENTS / limit / (drawn.cuts / drawn.trains))
        return AtLimit(None, None, f"{drawn.cuts} cuts are too few for so small a share; take {wanted} trains or more")
    speed, cars = sums.crossing(limit)
    told = AtLimit(decided(speed, drawn.shifts), decided(cars, drawn.shifts))
    if told.cars_per_hour is not None:
        return told
    slowest, fastest = points[0], points[-1]
    if np.isneginf(cars[0]):
        return AtLimit(None, None, f"{cell(slowest)} pass it already; begin the curve with a safer point")
    if np.isposinf(cars[0]):
        return AtLimit(None, None, f"{cell(fastest)} still keep it; end the curve with a faster point")
    return AtLimit(None, None, "the interval reaches beyond the ends of the curve; add points or trains")


def cell(point: Point) -> str:
    """'612 cars an hour'."""
    return f"{point.cars_per_hour.value:.0f} cars an hour"


def difference(sums: Sums, first: Sums, limit: float, drawn: Drawn) -> Interval | None:
    """Cars an hour at the limit that one curve has more than another; None where the trains do not decide it."""
    if not enough_for(limit, drawn.cuts):
        return None
    with np.errstate(invalid="ignore"):  # ∞ − ∞ decides nothing
        return decided(sums.crossing(limit)[1] - first.crossing(limit)[1], drawn.shifts)
