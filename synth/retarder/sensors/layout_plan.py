"""How many point sensors, and where: the best layout found for each number, judged by the tables that it gives."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np

from plant_models import PointSensors
from synth.problem.resolution import Resolution
from synth.retarder.sensors.candidate_places import LayoutCase, candidate_places
from synth.retarder.sensors.layout import LAST_SECTION_M, equal_layout, first_sensor_m, with_layout
from synth.retarder.sensors.layout_search import LayoutSearch, Tell, silent
from synth.retarder.sensors.tuned_passages import TunedPassages, passage_chains, tuned_passages
from synth.solver.chain.sensor_passages import with_point_sensors

PLACE_STEP_M = 0.5
"""Sensors may stand at multiples of it from the entrance: about the distance of the sleepers."""

FARTHEST_AHEAD = 1.5
"""The first sensor may stand so many times as far ahead as the rule asks for."""


@dataclass(frozen=True)
class JudgedLayout:
    """Places of the deciding sensors, and the tables that they give in every case and for every aim, in their order."""

    deciding_m: tuple[float, ...]
    tuned: tuple[tuple[TunedPassages, ...], ...]

    @property
    def rms_m_s(self) -> float:
        """Root of the mean predicted square error over all cases and aims."""
        squares = [each.rms_m_s**2 for case in self.tuned for each in case]
        return float(np.sqrt(np.mean(squares)))


@dataclass(frozen=True)
class PlannedLayout:
    """For one number of sensors: the better of the layout found and of equal sections, and equal sections."""

    best: JudgedLayout
    equal: JudgedLayout

    @property
    def deciding(self) -> int:
        """Number of sensors that decide; one more stands behind the exit."""
        return len(self.best.deciding_m)


@dataclass(frozen=True)
class LayoutProblem:
    """What a layout is for: the cases, the sensors (all but their places), the grid that tables are made on."""

    cases: tuple[LayoutCase, ...]
    sensors: PointSensors
    resolution: Resolution

    @property
    def exit_m(self) -> float:
        """S_exit of the shortest cut: a sensor behind it would decide nothing for that cut."""
        return min(case.plant.exit_m for case in self.cases)

    @property
    def first_m(self) -> float:
        """The first sensor by the rule, of all cases and aims the one farthest ahead."""
        return min(
            first_sensor_m(case.plant, self.sensors, aim.target_speed_m_s) for case in self.cases for aim in case.aims
        )

    @property
    def farthest_m(self) -> float:
        """How far ahead of the entrance the first sensor may stand."""
        return float(PLACE_STEP_M * np.ceil(-FARTHEST_AHEAD * self.first_m / PLACE_STEP_M))

    def judged(self, deciding_m: tuple[float, ...]) -> JudgedLayout:
        """The tables of a layout in every case, tuned and predicted."""
        return JudgedLayout(deciding_m, tuple(self._tuned(case, deciding_m) for case in self.cases))

    def _tuned(self, case: LayoutCase, deciding_m: tuple[float, ...]) -> tuple[TunedPassages, ...]:
        sensors = with_layout(self.sensors, deciding_m, max(each.plant.exit_m for each in self.cases))
        chains = passage_chains(with_point_sensors(case.plant, sensors), sensors, self.resolution)
        return tuple(tuned_passages(chains, aim) for aim in case.aims)


def plan_layouts(
    problem: LayoutProblem, counts: Sequence[int], threads: int = 1, tell: Tell = silent
) -> tuple[PlannedLayout, ...]:
    """The best layout found for each number of deciding sensors, never worse than equal sections by its prediction."""
    asked = [*found_layouts(problem, counts, threads, tell)]
    asked += [equal_layout(problem.first_m, problem.exit_m, count) for count in counts]
    with ThreadPoolExecutor(max_workers=threads) as pool:
        judged = list(pool.map(partial(told_judged, problem, tell), asked))
    pairs = zip(judged[: len(counts)], judged[len(counts) :], strict=True)
    return tuple(PlannedLayout(min(pair, key=lambda each: each.rms_m_s), pair[1]) for pair in pairs)


def steps_of_plan(counts: Sequence[int]) -> int:
    """How many steps `plan_layouts` tells of."""
    return max(counts) + 2 * len(counts)


def told_judged(problem: LayoutProblem, tell: Tell, deciding_m: tuple[float, ...]) -> JudgedLayout:
    """A layout judged, and told of."""
    found = problem.judged(deciding_m)
    tell(f"{len(deciding_m) + 1} sensors, the first at {deciding_m[0]:g} m: rms {found.rms_m_s:.4f} m/s predicted")
    return found


def best_places(problem: LayoutProblem, counts: Sequence[int]) -> tuple[tuple[float, ...], ...]:
    """Places of the deciding sensors of the best plan for each of their numbers."""
    return tuple(plan.best.deciding_m for plan in plan_layouts(problem, counts))


def found_layouts(
    problem: LayoutProblem, counts: Sequence[int], threads: int = 1, tell: Tell = silent
) -> tuple[tuple[float, ...], ...]:
    """Places of the deciding sensors, for each of their numbers, of least expected cost before any polish."""
    if not counts:
        return ()
    places = np.arange(-problem.farthest_m, problem.exit_m - LAST_SECTION_M, PLACE_STEP_M)
    cases = tuple(candidate_places(case, problem.sensors, problem.farthest_m) for case in problem.cases)
    search = LayoutSearch(cases, tuple(places.tolist()), problem.first_m, problem.exit_m, threads)
    found = search.best_layouts(counts, tell)
    return tuple(search.places_m(found[count]) for count in counts)


def fewest_for(plans: Sequence[PlannedLayout], rms_m_s: float) -> PlannedLayout | None:
    """The plan of the fewest sensors whose predicted rms is at most `rms_m_s`; None if none is."""
    enough = [plan for plan in plans if plan.best.rms_m_s <= rms_m_s]
    return min(enough, key=lambda plan: plan.deciding, default=None)
