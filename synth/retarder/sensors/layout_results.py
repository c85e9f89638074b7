"""A plan of point sensors beside what it is compared with: equal sections, the rule, and the radar."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.resolution import Resolution, finer_for_check
from synth.retarder.case_result import PolicyMap
from synth.retarder.sensors.anywhere import policy_anywhere
from synth.retarder.sensors.candidate_places import LayoutCase
from synth.retarder.sensors.layout import rule_layout, with_layout
from synth.retarder.sensors.layout_plan import JudgedLayout, LayoutProblem, PlannedLayout, fewest_for, plan_layouts
from synth.retarder.sensors.layout_search import Tell
from synth.solver.chain.chain import check_chain, persistent_chain
from synth.solver.resolved_density import resolved_density
from synth.solver.tuned_lines import tuned_lines

RADAR_DEGREE = 3
"""Of the polynomial lines of the radar's tables."""

NEAR_RADAR = 1.1
"""Times the radar's rms is wanted where no rms is asked for."""


@dataclass(frozen=True)
class LayoutResults:
    """Plans by number of sensors, rising; the layout by the rule; the radar's predicted rms by case and aim.

    `labels`: of the cases. `anywhere`: what a regulator would command that could decide anywhere, in the first case for
    its first aim. `wanted_rms_m_s`: as asked for, or as the radar has it. `chosen`: the plan of the fewest
    sensors that reach it, None if none does.
    """

    problem: LayoutProblem
    labels: tuple[str, ...]
    plans: tuple[PlannedLayout, ...]
    rule: JudgedLayout
    radar_rms_m_s: tuple[tuple[float, ...], ...]
    anywhere: PolicyMap
    wanted_rms_m_s: float
    chosen: PlannedLayout | None

    @property
    def shown(self) -> PlannedLayout:
        """The plan that is drawn: the chosen one, else the one of most sensors."""
        return self.chosen or self.plans[-1]

    @property
    def radar_mean_rms_m_s(self) -> float:
        """Root of the mean square over all cases and aims."""
        return root_mean_square(self.radar_rms_m_s)

    def places_of(self, layout: JudgedLayout) -> tuple[float, ...]:
        """The places of all sensors of a layout, with the one behind the exit of the longest cut."""
        exit_m = max(case.plant.exit_m for case in self.problem.cases)
        return with_layout(self.problem.sensors, layout.deciding_m, exit_m).path_m


def root_mean_square(rms_m_s: Sequence[Sequence[float]]) -> float:
    """Of all cases and aims."""
    return float(np.sqrt(np.mean([rms**2 for case in rms_m_s for rms in case])))


def layout_results(
    problem: LayoutProblem,
    labels: Sequence[str],
    sensors: Sequence[int],
    wanted_rms_m_s: float | None,
    threads: int,
    tell: Tell,
) -> LayoutResults:
    """Plans for each of these numbers of `sensors`, the one behind the exit counted, with what stands beside them."""
    plans = plan_layouts(problem, [number - 1 for number in sensors], threads, tell)
    slowest = min(aim.target_speed_m_s for case in problem.cases for aim in case.aims)
    longest = max(problem.cases, key=lambda case: case.plant.exit_m)
    rule = problem.judged(rule_layout(longest.plant, problem.sensors, slowest))
    with ThreadPoolExecutor(max_workers=threads) as pool:
        radar = tuple(pool.map(lambda case: radar_rms(case, problem.resolution), problem.cases))
    tell("the layout by the rule and the radar's tables tuned")
    anywhere = policy_anywhere(problem.cases[0], problem.sensors, problem.farthest_m)
    wanted = NEAR_RADAR * root_mean_square(radar) if wanted_rms_m_s is None else wanted_rms_m_s
    chosen = fewest_for(plans, wanted)
    return LayoutResults(problem, tuple(labels), plans, rule, radar, anywhere, wanted, chosen)


def radar_rms(case: LayoutCase, resolution: Resolution) -> tuple[float, ...]:
    """Predicted rms of the radar's table for every aim, its regulator as the plant has it."""
    return tuple(radar_rms_for(case.plant, aim, resolution) for aim in case.aims)


def radar_rms_for(plant: Plant, aim: Aim, resolution: Resolution) -> float:
    """Predicted rms of the polished polynomial lines of one aim."""
    lines = tuned_lines(persistent_chain(plant, resolution), aim, RADAR_DEGREE).best
    check = check_chain(plant, finer_for_check(resolution))
    density = resolved_density(check, lines.at(check.grid.path_m), aim.target_speed_m_s)
    return density.rms_m_s(aim.target_speed_m_s)
