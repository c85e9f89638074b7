"""The layouts that are compared: planned, equal sections, the rule of zhukovitsky-2012."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from synth.book.sensors.candidate_places import CandidatePlaces, candidate_places
from synth.book.sensors.layout import LAST_SECTION_M, equal_layout, rule_layout
from synth.book.sensors.layout_plan import FARTHEST_AHEAD, PLACE_STEP_M, LayoutProblem
from synth.book.sensors.layout_search import LayoutSearch
from synth.problem.resolution import Resolution

Places = tuple[float, ...]
"""Of the deciding sensors, m from the entrance, rising."""

Layouts = Callable[[LayoutProblem, Sequence[int]], tuple[Places, ...]]
"""Layouts of a problem with one case, for several numbers of deciding sensors."""

SEARCH = Resolution(path_step_m=0.5, speed_step_m_s=0.03, friction_nodes=7)
"""On four frictions and a speed step of 0.06 m/s the search finds places that tell the four from each other, and costs
below zero."""

LEAST_COST_M2_S2 = 1e-6
"""Costs below it are errors of the grid: the search must not descend into them."""


@dataclass(frozen=True)
class HonestPlaces(CandidatePlaces):
    """Costs of layouts that a table can have: the first sensor ahead of the entrance; none below the grid's errors."""

    def mean_cost(self, sensors_m: Sequence[float]) -> float:
        """See `CandidatePlaces.mean_cost`."""
        if sensors_m[0] >= 0.0:
            return float("inf")
        return max(CandidatePlaces.mean_cost(self, sensors_m), LEAST_COST_M2_S2)


def planned(problem: LayoutProblem, deciding: Sequence[int]) -> tuple[Places, ...]:
    """Those of least expected cost that the search of the planner finds."""
    if not deciding:
        return ()
    (case,) = problem.cases
    ahead_m = float(PLACE_STEP_M * np.ceil(-FARTHEST_AHEAD * problem.first_m / PLACE_STEP_M))
    every = candidate_places(case, problem.sensors, ahead_m, SEARCH)
    places = tuple(np.arange(-ahead_m, problem.exit_m - LAST_SECTION_M, PLACE_STEP_M).tolist())
    honest = HonestPlaces(every.chain, every.aims, every.axle_offsets_m)
    search = LayoutSearch((honest,), places, problem.first_m, problem.exit_m)
    found = search.best_layouts(deciding)
    return tuple(search.places_m(found[count]) for count in deciding)


def equal_sections(problem: LayoutProblem, deciding: Sequence[int]) -> tuple[Places, ...]:
    """One ahead as the rule has it, the others in equal sections from the entrance on."""
    return tuple(equal_layout(problem.first_m, problem.exit_m, count) for count in deciding)


def by_rule(problem: LayoutProblem) -> Places:
    """Every section as long as the longest change of stage takes; the rule says how many sensors that needs."""
    (case,) = problem.cases
    return rule_layout(case.plant, problem.sensors, case.aims[0].target_speed_m_s)
