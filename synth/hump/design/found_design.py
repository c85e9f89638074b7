"""What the design test of a hump has found, and what it asks: fall, brakes, speeds at the entrances, intervals."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.frame.command import Limit
from synth.hump.design.hump_under_test import HumpUnderTest, Unbraked, unbraked
from synth.hump.design.intervals import Intervals, intervals, least_margins_s
from synth.hump.design.triples import CARS, GOOD, Triples, margins_s, triples
from synth.hump.design_runners import bad_runner, very_good_runner
from synth.hump.planning.train_plan import TrainPlan
from synth.hump.rolling.train_memory import TrainMemory
from synth.hump.trains.train_trace import TrainTrace
from synth.hump.trial.asked_trial import AskedTrial

KEPT_M_S = 0.01
"""A command is kept where the exit is not faster than this above it."""


@frozen_arrays
class WorstTriple:
    """The triple with the least margin: its cars with their `plan`, and what becomes of each of them `alone`.

    `margin_s` (pairs, elements): see `margins_s`. `grid_s`: how much larger the least margin is where twice as many
    exit speeds are compared.
    """

    cars: Triples
    plan: TrainPlan
    alone: TrainMemory
    margin_s: Floats
    grid_s: float

    @property
    def tightest(self) -> tuple[int, int]:
        """(place among the pairs, column of the element) of the least margin."""
        pair, column = np.unravel_index(self.margin_s.argmin(), self.margin_s.shape)
        return int(pair), int(column)

    @property
    def least_s(self) -> float:
        """The least margin."""
        return float(self.margin_s.min())

    @property
    def tracks(self) -> tuple[int, int]:
        """Of the bad runners, and of the good one."""
        tracks = self.cars.trains.track
        return int(tracks[0]), int(tracks[1])

    def together(self) -> TrainTrace:
        """The three as they would be humped."""
        return self.cars.together(self.plan)


@dataclass(frozen=True)
class Entries:
    """Of position `number`, over all pairs of tracks: `fastest_m_s` at which a car comes to it in the test, 0
    where none comes; `allowed_m_s`, infinite for no limit; `beyond_m_s`: by how much the good runner leaves it faster
    than commanded at most."""

    number: int
    fastest_m_s: float
    allowed_m_s: float
    beyond_m_s: float

    @property
    def kept(self) -> bool:
        """Every car comes slowly enough."""
        return self.fastest_m_s <= self.allowed_m_s


@dataclass(frozen=True)
class FoundDesign:
    """The test of `hump`, which is that of the trial `asked`."""

    asked: AskedTrial
    hump: HumpUnderTest
    unbraked: Unbraked
    intervals: Intervals
    worst: WorstTriple
    entries: tuple[Entries, ...]


def found_design(asked: AskedTrial, hump: HumpUnderTest) -> FoundDesign:
    """The whole test."""
    found = intervals(hump)
    return FoundDesign(asked, hump, unbraked(hump), found, worst_triple(hump, found), entries(hump, found))


def worst_triple(hump: HumpUnderTest, found: Intervals) -> WorstTriple:
    """The triple with the least margin at the hump speed of the test."""
    cars, speed = triples(hump, found.worst), np.array([hump.asked.hump_speed_m_s])
    plan = cars.planned(speed)
    finer = triples(hump.with_choices(2 * hump.choices - 1), found.worst)
    margin = margins_s(cars, plan)[0]
    grid = float(least_margins_s(finer, speed)[0] - margin.min()) if np.isfinite(margin.min()) else 0.0
    return WorstTriple(cars, plan, cars.alone(plan), margin, grid)


def entries(hump: HumpUnderTest, found: Intervals) -> tuple[Entries, ...]:
    """Of all positions."""
    cars = triples(hump, found.pairs)
    alone = cars.alone(cars.planned(np.full(len(cars), hump.asked.hump_speed_m_s)))
    entry = alone.entry_m_s[:, 0]
    beyond = (alone.exit_m_s[:, 0] - alone.command_m_s[:, 0])[GOOD::CARS]
    return tuple(
        Entries(
            number=place + 1,
            fastest_m_s=float(np.fmax.reduce(entry[:, place], initial=0.0)),
            allowed_m_s=allowed_m_s(hump, place),
            beyond_m_s=float(np.fmax.reduce(beyond[:, place], initial=0.0)),
        )
        for place in range(hump.routes.positions)
    )


def allowed_m_s(hump: HumpUnderTest, place: int) -> float:
    """How fast cuts may come to a position, by its settings; infinite for no limit."""
    exits = hump.planner.roles.exits[place]
    category = np.array([0])
    return float(np.max(exits.choices(category).most_entry_m_s))


BETWEEN = ("bad and good", "good and bad", "bad and bad")
"""What the intervals of a triple lie between, as its pairs are ordered."""


def design_limits(found: FoundDesign) -> Iterator[Limit]:
    """All of them, a sentence each."""
    yield of_fall(found)
    yield from of_brakes(found)
    yield from of_entries(found)
    yield of_intervals(found)


def of_fall(found: FoundDesign) -> Limit:
    """The bad runner must come into its track."""
    fall, runner = found.unbraked.fall, bad_runner(found.hump.asked)
    where = f"{fall.into_m:.0f} m into track {found.hump.routes.graph.track_called(fall.route.track)}"
    who = f"the bad runner ({runner.mass_t:g} t, {runner.resistance_n_per_kn:g} N/kN)"
    if fall.left_m >= 0.0:
        return Limit(f"{who} comes {where} with {fall.left_m:.2f} m of energy head left", True)
    return Limit(
        f"{who} stops {fall.stop_m:.0f} m behind the crest and does not come {where}: {fall.needed_m:.2f} m of fall "
        f"are needed, and there are {fall.fall_m:.2f} m",
        False,
    )


def of_brakes(found: FoundDesign) -> Iterator[Limit]:
    """The brakes must stop the very good runner at the exit of a last position."""
    runner = very_good_runner(found.hump.asked)
    for need in found.unbraked.positions:
        if need.last:
            words = (
                f"up to the exit of position {need.number} the brakes can take {need.there_m:.2f} m of energy head "
                f"from the very good runner ({runner.mass_t:g} t, {runner.resistance_n_per_kn:g} N/kN) on the way to "
                f"track {found.hump.routes.graph.track_called(need.track)}, which has {need.needed_m:.2f} m there"
            )
            yield Limit(words, need.left_m >= 0.0)


def of_entries(found: FoundDesign) -> Iterator[Limit]:
    """Cars must come to positions as slowly as is allowed there, and leave them as commanded."""
    for each in found.entries:
        if math.isfinite(each.allowed_m_s):
            words = (
                f"cars of the test come to position {each.number} at {each.fastest_m_s:.2f} m/s or less; "
                f"{each.allowed_m_s:g} m/s are allowed"
            )
            yield Limit(words, each.kept)
        if each.beyond_m_s > KEPT_M_S:
            words = f"the good runner leaves position {each.number} up to {each.beyond_m_s:.2f} m/s faster than it may"
            yield Limit(f"{words}, for want of brake", False)


def of_intervals(found: FoundDesign) -> Limit:
    """No car may come before the points are right, and the retarder free."""
    worst, asked = found.worst, found.hump.asked
    graph, (pair, _) = found.hump.routes.graph, worst.tightest
    there, tracks = graph.element_called(tightest_element(found)), " and ".join(map(graph.track_called, worst.tracks))
    where = f"between {BETWEEN[pair]} at {there}, to tracks {tracks}, pushed at {asked.hump_speed_m_s:g} m/s"
    if worst.least_s >= 0.0:
        return Limit(f"the least interval is {worst.least_s:.2f} s longer than needed, {where}", True)
    if math.isinf(worst.least_s):
        return Limit(f"a car stands in the way of the next one, {where}", False)
    return Limit(f"the least interval is {-worst.least_s:.2f} s too short, {where}", False)


def tightest_element(found: FoundDesign) -> int:
    """Number of the element of the least margin."""
    routes, (pair, column) = found.hump.routes, found.worst.tightest
    row = found.worst.cars.route[0, 0 if pair != 1 else 1]
    return routes.numbers[int(routes.vertex[row, column])]
