"""What the design test of a hump has found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.hump.design.hump_under_test import HumpUnderTest
from synth.hump.design.intervals import Intervals, intervals, least_margins_s
from synth.hump.design.runners_unbraked import Unbraked, unbraked
from synth.hump.design.triples import CARS, GOOD, Triples, margins_s, triples
from synth.hump.trains.asked_trial import AskedTrial
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_plan import TrainPlan
from synth.hump.trains.train_trace import TrainTrace

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
