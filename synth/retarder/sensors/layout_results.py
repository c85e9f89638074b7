"""A plan of point sensors beside what it is compared with: the rule, and the radar."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.frame.interval import Interval
from synth.frame.workers.engine import Tell, silent
from synth.retarder.configuration.config_file import ConfigSource
from synth.retarder.sensors.layout import policy_anywhere, rule_layout
from synth.retarder.sensors.layout_plan import (
    JudgedLayout,
    LayoutProblem,
    PlanPasses,
    ended,
    fewest_for,
    plan_passes,
    searched,
    steps_of_plan,
)
from synth.retarder.sensors.layout_tables import ExitErrors, radar_errors
from synth.solver.backward_induction import PolicyMap

NEAR_RADAR = 1.1
"""Times the radar's rms is wanted where no rms is asked for."""


@dataclass(frozen=True)
class AskedLayouts:
    """A problem of all cut classes and targets, the labels of the classes, and what is asked.

    `source`: the configuration; `sensors`: numbers of them, the one behind the exit counted; `rms_m_s`: None where 1.1
    times the radar's is wanted.
    """

    source: ConfigSource
    problem: LayoutProblem
    labels: tuple[str, ...]
    sensors: tuple[int, ...]
    rms_m_s: float | None
    seed: int
    passes: int

    @property
    def steps(self) -> int:
        """How many steps `layout_results` tells of: those of the plan, the rule, the radar's classes."""
        return steps_of_plan([number - 1 for number in self.sensors]) + 1 + len(self.labels)


@dataclass(frozen=True)
class LayoutResults:
    """Plans by number of sensors, rising; the layout by the rule; the radar's errors on the same final passes.

    `anywhere`: what a regulator would command that could decide anywhere, in the first case for its first aim.
    `chosen`: the plan of the fewest sensors that reach what is wanted on the passes to choose on, None if none does.
    """

    asked: AskedLayouts
    plans: tuple[JudgedLayout, ...]
    rule: JudgedLayout
    radar: ExitErrors
    anywhere: PolicyMap
    chosen: JudgedLayout | None

    @property
    def shown(self) -> JudgedLayout:
        """The plan that is drawn: the chosen one, else the one of most sensors."""
        return self.chosen or self.plans[-1]

    @property
    def wanted_rms_m_s(self) -> float:
        """As asked for, or as the radar has it on the final passes."""
        return NEAR_RADAR * self.radar.rms.value if self.asked.rms_m_s is None else self.asked.rms_m_s

    def is_reached(self, layout: JudgedLayout) -> bool | None:
        """Whether a layout has what is wanted on the final passes; None where its 95 % interval holds the limit.

        The radar's rms is compared pass by pass.
        """
        told: Interval = layout.errors.rms
        limit = self.wanted_rms_m_s
        if self.asked.rms_m_s is None:
            told, limit = layout.errors.over(self.radar), NEAR_RADAR
        return True if told.high95 <= limit else False if told.low95 > limit else None

    def places_of(self, layout: JudgedLayout) -> tuple[float, ...]:
        """The places of all sensors of a layout, with the one behind the exit of the longest cut."""
        return self.asked.problem.placed(layout.deciding_m).path_m


def layout_results(asked: AskedLayouts, threads: int, tell: Tell = silent) -> LayoutResults:
    """Plans for each number of sensors, with what stands beside them.

    The result does not depend on how many `threads` work.
    """
    problem, passes = asked.problem, plan_passes(asked.seed, asked.passes)
    with ThreadPoolExecutor(max_workers=threads) as searching, ThreadPoolExecutor(max_workers=threads) as pool:
        counts = [number - 1 for number in asked.sensors]
        search = pool.submit(searched, problem, counts, passes, (searching, pool), tell)
        radar = [pool.submit(told_radar, asked, number, passes, tell) for number in range(len(asked.labels))]
        rule = pool.submit(judged_rule, problem, passes, tell)
        anywhere = pool.submit(policy_anywhere, problem.cases[0], problem.sensors, problem.farthest_m)
        plans = ended(search)
        choosing, final = radar_on([each.result() for each in radar], passes)
        wanted = NEAR_RADAR * choosing.rms.value if asked.rms_m_s is None else asked.rms_m_s
        chosen = fewest_for(plans, wanted)
        return LayoutResults(asked, plans, rule.result(), final, anywhere.result(), chosen)


def judged_rule(problem: LayoutProblem, passes: PlanPasses, tell: Tell) -> JudgedLayout:
    """The layout by the rule, for the slowest aim and the longest cut."""
    slowest = min(aim.target_speed_m_s for case in problem.cases for aim in case.aims)
    longest = max(problem.cases, key=lambda case: case.plant.exit_m)
    found = problem.judged([rule_layout(longest.plant, problem.sensors, slowest)], passes)
    tell(f"{found.deciding + 1} sensors by the rule: rms {found.errors.rms.value:.4f} m/s")
    return found


def told_radar(asked: AskedLayouts, number: int, passes: PlanPasses, tell: Tell) -> tuple[Floats, ...]:
    """`radar_errors` of the case `number`, and told of."""
    found = radar_errors(asked.problem.cases[number], asked.problem.resolution, (passes.choosing, passes.final))
    tell(f"the radar's lines for {asked.labels[number]} found")
    return found


def radar_on(by_case: Sequence[tuple[Floats, ...]], passes: PlanPasses) -> tuple[ExitErrors, ExitErrors]:
    """The radar's errors over all cases, on the passes to choose on and on the final ones."""
    choosing, final = zip(*by_case, strict=True)
    return (
        ExitErrors(np.concatenate(choosing), passes.choosing.weight),
        ExitErrors(np.concatenate(final), passes.final.weight),
    )
