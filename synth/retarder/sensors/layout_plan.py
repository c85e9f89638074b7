"""How many point sensors, and where: the best layout found for each number, judged by the tables that it gives.

What is chosen, is chosen on passes of its own; what is told of it, is of others, which nothing else uses.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from plant_models import PointSensors, first_axle
from plant_models.library import load_wheel_sensor
from synth.frame.workers.engine import Tell
from synth.problem.resolution import Resolution
from synth.retarder.configuration.plant_settings import DEFAULT_WHEEL_SENSOR
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.sensors.layout import (
    LAST_SECTION_M,
    LayoutCase,
    candidate_places,
    equal_layout,
    first_sensor_m,
    with_layout,
)
from synth.retarder.sensors.layout_search import ForEach, LayoutSearch
from synth.retarder.sensors.layout_tables import ExitErrors, LayoutTable, errors_of, polished, solutions
from synth.simulation.random_passes import RandomPasses
from synth.simulation.stratified_passes import stratified_passes

PLACE_STEP_M = 0.5
"""Sensors may stand at multiples of it from the entrance: about the distance of the sleepers."""

FARTHEST_AHEAD = 1.5
"""The first sensor may stand so many times as far ahead as the rule asks for."""

NEAR_BEST = 1.5
"""Equal sections that cost at most so many times as much as the layout found are compared with it by their tables."""

CHOOSING_PASSES = 2_000
FIRST_CHOOSING = 1_000_000
"""Number of the first pass to choose on: no figure is told from so many passes."""


@dataclass(frozen=True)
class PlanPasses:
    """Passes to choose on, and others to tell figures from."""

    choosing: RandomPasses
    final: RandomPasses


def plan_passes(seed: int, count: int) -> PlanPasses:
    """`count` passes for figures, the first of the row of `seed`, and those to choose on, far behind them."""
    return PlanPasses(stratified_passes(seed, FIRST_CHOOSING, CHOOSING_PASSES), stratified_passes(seed, 0, count))


@dataclass(frozen=True)
class JudgedLayout:
    """Places of the deciding sensors, and their tables for every case and aim, in their order.

    `chosen_by_m_s`: rms over all tables on the passes to choose on; `errors`: on the final ones.
    """

    deciding_m: tuple[float, ...]
    tables: tuple[LayoutTable, ...]
    chosen_by_m_s: float
    errors: ExitErrors

    @property
    def deciding(self) -> int:
        """Number of sensors that decide; one more stands behind the exit."""
        return len(self.deciding_m)


@dataclass(frozen=True)
class LayoutProblem:
    """What a layout is for: the cases, the sensors (all but their places), the grid that tables are tuned on."""

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

    def search(self, for_each: ForEach = map) -> LayoutSearch:
        """The search over all places at which sensors may stand; `for_each` of the cases."""
        places = np.arange(-self.farthest_m, self.exit_m - LAST_SECTION_M, PLACE_STEP_M)
        cases = tuple(candidate_places(case, self.sensors, self.farthest_m) for case in self.cases)
        return LayoutSearch(cases, tuple(places.tolist()), self.first_m, self.exit_m, for_each)

    def placed(self, deciding_m: tuple[float, ...]) -> PointSensors:
        """The sensors of a layout, with the one behind the exit of the longest cut."""
        return with_layout(self.sensors, deciding_m, max(case.plant.exit_m for case in self.cases))

    def judged(self, candidates: Sequence[tuple[float, ...]], passes: PlanPasses) -> JudgedLayout:
        """The best of the candidates, by their tables."""
        made = [(layout, self.tables_at(layout)) for layout in candidates]
        rms_m_s = [errors_of(tables, passes.choosing).rms.value for _, tables in made]
        best = int(np.argmin(rms_m_s))
        layout, tables = made[best]
        return JudgedLayout(layout, tables, rms_m_s[best], errors_of(tables, passes.final))

    def tables_at(self, layout: tuple[float, ...]) -> tuple[LayoutTable, ...]:
        """The tables of all cases with these deciding sensors."""
        sensors = self.placed(layout)
        made = (pair for case in self.cases for pair in solutions(case, sensors, self.resolution))
        return tuple(polished(*pair) for pair in made)


def ended(search: Future[dict[int, Future[JudgedLayout]]]) -> tuple[JudgedLayout, ...]:
    """What `searched` has handed out, when all of it is judged, by number."""
    return tuple(each.result() for _, each in sorted(search.result().items()))


def searched(
    problem: LayoutProblem,
    counts: Sequence[int],
    passes: PlanPasses,
    pools: tuple[ThreadPoolExecutor, ThreadPoolExecutor],
    tell: Tell,
) -> dict[int, Future[JudgedLayout]]:
    """Search on the first pool, and hand each layout to the second as soon as it is found.

    What is judged, by number of deciding sensors. Equal sections are a candidate where they are near the best.
    """
    searching, judging = pools
    judged: dict[int, Future[JudgedLayout]] = {}
    search = problem.search(searching.map)
    for layout in search.best_layouts(max(counts)):
        count = len(layout)
        tell(f"places of {count + 1} sensors found")
        if count in counts:
            candidates = [search.places_m(layout)]
            cost, equal = search.costs([layout, search.equal(count)])
            if layout != search.equal(count) and equal <= NEAR_BEST * cost:
                candidates.append(equal_layout(problem.first_m, problem.exit_m, count))
            judged[count] = judging.submit(told_judged, problem, candidates, passes, tell)
    return judged


def told_judged(
    problem: LayoutProblem, candidates: Sequence[tuple[float, ...]], passes: PlanPasses, tell: Tell
) -> JudgedLayout:
    """`LayoutProblem.judged`, and told of."""
    found = problem.judged(candidates, passes)
    tell(f"{found.deciding + 1} sensors, the first at {found.deciding_m[0]:g} m: rms {found.errors.rms.value:.4f} m/s")
    return found


def steps_of_plan(counts: Sequence[int]) -> int:
    """How many steps `plan_layouts` tells of."""
    return max(counts) + len(counts)


def fewest_for(plans: Sequence[JudgedLayout], rms_m_s: float) -> JudgedLayout | None:
    """The plan of the fewest sensors whose rms is at most `rms_m_s` on the passes to choose on; None if none is."""
    enough = [plan for plan in plans if plan.chosen_by_m_s <= rms_m_s]
    return min(enough, key=lambda plan: plan.deciding, default=None)


def layout_problem(config: ResolvedConfig) -> tuple[LayoutProblem, tuple[str, ...]]:
    """The problem of all cut classes and targets, and the labels of the classes; [sensors] path_m is not read."""
    cases = tuple(LayoutCase(plant, config.aims_of(label)) for label, plant in config.plants())
    return LayoutProblem(cases, sensors_of(config), config.resolution), tuple(label for label, _ in config.plants())


def sensors_of(config: ResolvedConfig) -> PointSensors:
    """The sensors of [sensors], or the usual ones that decide on the first axle; their places mean nothing."""
    if config.sensors is not None:
        return config.sensors.sensors
    return load_wheel_sensor(DEFAULT_WHEEL_SENSOR).at((0.0,), first_axle)
