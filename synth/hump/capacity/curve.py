"""A curve of cars an hour against catch-ups, and where it meets the share that is allowed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np

from synth.frame.interval import Interval
from synth.hump.capacity.crossings import FEWEST_EVENTS, Sums, decided, drawn_weights, enough_for, sums_of
from synth.hump.capacity.variants import Variant
from synth.hump.trains.outcomes import TrainOutcomes, same_trains
from synth.hump.trains.shift_sums import shifts_in
from synth.hump.trains.train_figures import TrainFigure, train_figures


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
