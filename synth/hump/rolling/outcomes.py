"""What trains came to, a row each: catch-ups, misroutes, couplings, gaps, time over the crest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.configuration.sections import CouplingLimits
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.meeting import tightest_pairs
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory

USUAL_COUPLINGS = CouplingLimits()
"""By the practice of most yards."""

SAME_M_S = 1e-6
"""Speeds that differ by less are the same."""

SPEED_BINS_M_S = np.linspace(0.0, 6.0, 61)
GAP_BINS_M = np.linspace(0.0, 600.0, 61)
"""Bins of the histograms; what is beyond the last one is in it."""


@frozen_arrays
class TrainOutcomes:
    """n trains. Counts of cuts unless told otherwise, (n,).

    `train`: its number; `shift`: that of its shift, whose trains come to the same tracks one after the other.
    `occupied`: share of the length of all tracks that cars, and gaps between them, took before it; `pushed_up`,
    `pulled`: tracks that were so for it; `no_room`: cuts whose track had less free than their length. `span_s`: from
    the first cut at the crest to the last, in which `span_m` and `span_cars` went over it, counted from middle to
    middle. (n, elements), by the numbers of the routes: `misrouted`, `contact`,
    `unseparated`, `foul`. `caught`: cuts misrouted or in contact, but not in the last position (`caught_in_last`).
    `caught_on_track`: cuts that coupled to the one ahead while that rolled. `stopped`: on the way. `judged`: all
    others, which reached a track; of these `overspeed` (n, 3) coupled in each class of speed, `gap_m` is what they left
    free, all together. `speed_bins`, `gap_bins`: histograms. `passes`, `strokes`, `error2_m2_s2` (n, positions):
    passes, commands to valves, and squares of (exit less command) summed up; `short`: passes that ended faster than
    commanded for want of brake, `at_lowest`: those commanded the lowest speed that there is. (n, positions,
    categories): `commanded` passes, and `commands_m_s`, their commands summed up. `tightest_s`: least interval of the
    train between a cut and the next one on an element, at `tightest_at`, the column of the element, −1 for none,
    `tightest_ahead` and `tightest_behind` being the places of the weight categories of both.
    """

    train: Ints
    shift: Ints
    occupied: Floats
    pushed_up: Ints
    pulled: Ints
    no_room: Ints
    cuts: Ints
    cars: Ints
    span_s: Floats
    span_m: Floats
    span_cars: Floats
    misrouted: Ints
    contact: Ints
    unseparated: Ints
    foul: Ints
    caught: Ints
    caught_in_last: Ints
    caught_on_track: Ints
    stopped: Ints
    judged: Ints
    overspeed: Ints
    gap_m: Floats
    speed_bins: Ints
    gap_bins: Ints
    passes: Ints
    strokes: Ints
    error2_m2_s2: Floats
    short: Ints
    at_lowest: Ints
    commanded: Ints
    commands_m_s: Floats
    tightest_s: Floats
    tightest_at: Ints
    tightest_ahead: Ints
    tightest_behind: Ints

    def __repr__(self) -> str:
        return f"TrainOutcomes({len(self)} trains, {int(self.cuts.sum())} cuts)"

    def __len__(self) -> int:
        return len(self.train)


def same_trains(one: TrainOutcomes, other: TrainOutcomes) -> bool:
    """Whether both are of trains that have as many cuts and cars, each."""
    return np.array_equal(one.cuts, other.cuts) and np.array_equal(one.cars, other.cars)


def joined(parts: Sequence[TrainOutcomes]) -> TrainOutcomes:
    """Trains of several batches, in order."""
    return TrainOutcomes(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(TrainOutcomes)))


def in_order(turns: Sequence[TrainOutcomes]) -> TrainOutcomes:
    """The same by the number of the train; where shifts were humped side by side, each of `turns` has one train of
    each."""
    found = joined(turns)
    return some_of(found, np.argsort(found.train))


def some_of(found: TrainOutcomes, rows: Ints) -> TrainOutcomes:
    """Some rows of trains."""
    return TrainOutcomes(*(getattr(found, each.name)[rows] for each in fields(TrainOutcomes)))


@frozen_arrays
class PassLimits:
    """What positions can do with some cuts, (rows, positions): `lowest_m_s`, the lowest command that the control may
    give, NaN where there is no choice; `braked_m2_s2`, most loss of v² to the brake, at mean friction."""

    lowest_m_s: Floats
    braked_m2_s2: Floats


def outcomes(
    routes: HumpRoutes, trains: TrainCuts, memory: TrainMemory, able: PassLimits | None = None,
    couplings: CouplingLimits = USUAL_COUPLINGS, of_shift: int = 1,
) -> TrainOutcomes:  # fmt: skip
    """What is to be told of `trains` that were humped, `of_shift` a shift; without `able` no pass is counted as
    limited."""
    shape = trains.trains, trains.cuts
    ends = ends_of(routes, memory)
    speed = np.where(ends.judged, memory.end_speed_m_s, 0.0)
    stands = ends.judged & (memory.end_speed_m_s <= 0.0) & ~memory.caught_on_track
    gap = np.where(stands, np.maximum(memory.free_m - memory.end_m, 0.0), 0.0)
    bounds = (*couplings.classes_m_s, np.inf)
    over = [((speed > low) & (speed <= high)).sum(axis=1) for low, high in pairwise(bounds)]
    length, cars = trains.length_m.reshape(shape), trains.cars.reshape(shape)
    passed = np.isfinite(memory.exit_m_s)
    error2 = np.where(passed, memory.exit_m_s - memory.command_m_s, 0.0) ** 2
    short, at_lowest = limited(memory, able)
    tightest = tightest_pairs(routes, trains, memory)
    return TrainOutcomes(
        train=trains.numbers,
        shift=trains.numbers // of_shift,
        occupied=occupied(routes, memory.found_free_m),
        pushed_up=memory.pushed_up,
        pulled=memory.pulled,
        no_room=(ends.alone & (memory.free_m < routes.standing_from_m[memory.route] + length)).sum(axis=1),
        cuts=np.full(trains.trains, trains.cuts),
        cars=cars.sum(axis=1),
        span_s=memory.crest_s[:, -1] - memory.crest_s[:, 0],
        span_m=length.sum(axis=1) - 0.5 * (length[:, 0] + length[:, -1]),
        span_cars=cars.sum(axis=1) - 0.5 * (cars[:, 0] + cars[:, -1]),
        misrouted=at_elements(routes, memory.route, memory.misrouted_at),
        contact=at_elements(routes, memory.route, memory.contact_at),
        unseparated=over_elements(routes, memory.route, memory.unseparated),
        foul=over_elements(routes, memory.route, memory.foul),
        caught=ends.caught.sum(axis=1),
        caught_in_last=ends.in_last.sum(axis=1),
        caught_on_track=(memory.caught_on_track & ends.alone).sum(axis=1),
        stopped=ends.stopped.sum(axis=1),
        judged=ends.judged.sum(axis=1),
        overspeed=np.stack(over, axis=1),
        gap_m=gap.sum(axis=1),
        speed_bins=histograms(np.where(speed > 0.0, speed, np.nan), SPEED_BINS_M_S),
        gap_bins=histograms(np.where(gap > 0.0, gap, np.nan), GAP_BINS_M),
        passes=passed.sum(axis=1),
        strokes=memory.strokes.sum(axis=1),
        error2_m2_s2=error2.sum(axis=1),
        short=short.sum(axis=1),
        at_lowest=at_lowest.sum(axis=1),
        commanded=by_category(trains, passed.astype(np.int64)),
        commands_m_s=by_category(trains, np.where(passed, memory.command_m_s, 0.0)),
        tightest_s=tightest.interval_s,
        tightest_at=tightest.at,
        tightest_ahead=tightest.ahead,
        tightest_behind=tightest.behind,
    )


@frozen_arrays
class Ends:
    """How cuts ended, (trains, cuts): `caught` ahead of the last position, or `in_last`; `stopped` on the way."""

    caught: Bools
    in_last: Bools
    stopped: Bools

    @property
    def alone(self) -> Bools:
        """Neither misrouted nor in contact."""
        return ~self.caught & ~self.in_last

    @property
    def judged(self) -> Bools:
        """They reached a track."""
        return self.alone & ~self.stopped


def ends_of(routes: HumpRoutes, memory: TrainMemory) -> Ends:
    """Those of all cuts."""
    none, last = routes.elements, routes.retarder[memory.route].max(axis=2)
    in_last = (memory.misrouted_at == none) & (memory.contact_at == last)
    caught = ((memory.misrouted_at < none) | (memory.contact_at < none)) & ~in_last
    return Ends(caught, in_last, ~caught & ~in_last & (memory.end_m < routes.release_m[memory.route]))


def occupied(routes: HumpRoutes, free_m: Floats) -> Floats:
    """Share of the length of all tracks that is not free where `free_m` (trains, routes) begins what stands."""
    begins, most = routes.standing_from_m, routes.length_m
    return np.asarray((most - np.clip(free_m, begins, most)).sum(axis=1) / (most - begins).sum())


def limited(memory: TrainMemory, able: PassLimits | None) -> tuple[Bools, Bools]:
    """(passes that ended faster than commanded because the full brake can no more, passes commanded the lowest speed
    that there is), (trains, cuts, positions) both."""
    command, shape = memory.command_m_s, memory.command_m_s.shape
    if able is None:
        return np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool)
    least2 = memory.unbraked_m_s**2 - able.braked_m2_s2.reshape(shape)
    short = (least2 > command**2) & (memory.exit_m_s > command)
    at_lowest = np.isfinite(memory.exit_m_s) & (np.abs(command - able.lowest_m_s.reshape(shape)) < SAME_M_S)
    return short, at_lowest


def by_category(trains: TrainCuts, values: NDArray[Any]) -> NDArray[Any]:
    """`values` (trains, cuts, positions) of the passes summed up, (trains, positions, categories)."""
    place = trains.category.reshape(values.shape[:2])
    members = np.arange(len(trains.population.categories.members))
    return np.stack([(values * (place == k)[:, :, None]).sum(axis=1) for k in members], axis=2)


def caught_at(routes: HumpRoutes, found: TrainOutcomes) -> Ints:
    """Misroutes, and contacts ahead of a last position, of all trains at each element, (numbers,)."""
    return np.asarray(found.misrouted.sum(axis=0) + np.where(routes.is_last, 0, found.contact.sum(axis=0)))


def at_elements(routes: HumpRoutes, route: Ints, column: Ints) -> Ints:
    """How many cuts have their `column` (trains, cuts) at each element, (trains, numbers)."""
    found = column[:, :, None] == np.arange(routes.elements)
    return over_elements(routes, route, found)


def over_elements(routes: HumpRoutes, route: Ints, found: Bools) -> Ints:
    """How often `found` (trains, cuts, elements) is True at each element, (trains, numbers)."""
    train, cut, column = np.nonzero(found)
    counts = np.zeros((len(found), len(routes.numbers)), dtype=np.int64)
    np.add.at(counts, (train, routes.vertex[route[train, cut], column]), 1)
    return counts


def histograms(values: Floats, bins: Floats) -> Ints:
    """Of the values of each row that are not NaN, (rows, bins)."""
    row, column = np.nonzero(~np.isnan(values))
    place = np.clip(np.searchsorted(bins, values[row, column], side="right") - 1, 0, len(bins) - 2)
    counts = np.zeros((len(values), len(bins) - 1), dtype=np.int64)
    np.add.at(counts, (row, place), 1)
    return counts
