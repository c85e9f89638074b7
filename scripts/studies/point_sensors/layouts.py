"""The layouts that are compared: planned, equal sections, the rule of zhukovitsky-2012."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

from synth.frame.workers.engine import silent
from synth.retarder.sensors.layout import equal_layout, rule_layout
from synth.retarder.sensors.layout_plan import (
    JudgedLayout,
    LayoutProblem,
    PlanPasses,
    ended,
    plan_passes,
    searched,
)

Places = tuple[float, ...]
"""Of the deciding sensors, m from the entrance, rising."""

Layouts = Callable[[LayoutProblem, Sequence[int]], tuple[Places, ...]]
"""Layouts of a problem with one case, for several numbers of deciding sensors."""


def equal_sections(problem: LayoutProblem, deciding: Sequence[int]) -> tuple[Places, ...]:
    """One ahead as the rule has it, the others in equal sections from the entrance on."""
    return tuple(equal_layout(problem.first_m, problem.exit_m, count) for count in deciding)


def planned(problem: LayoutProblem, deciding: Sequence[int]) -> tuple[Places, ...]:
    """The best found, as `sensors` has it."""
    if not deciding:
        return ()
    passes = plan_passes(seed=1, count=1000)
    return tuple(each.deciding_m for each in plan_layouts(problem, deciding, passes))


def plan_layouts(
    problem: LayoutProblem,
    counts: Sequence[int],
    passes: PlanPasses,
    threads: int = 1,
) -> tuple[JudgedLayout, ...]:
    """The best layout found for each number of deciding sensors; how many `threads` there are changes nothing of it."""
    with ThreadPoolExecutor(max_workers=threads) as searching, ThreadPoolExecutor(max_workers=threads) as judging:
        return ended(judging.submit(searched, problem, counts, passes, (searching, judging), silent))


def by_rule(problem: LayoutProblem) -> Places:
    """Every section as long as the longest change of stage takes; the rule says how many sensors that needs."""
    (case,) = problem.cases
    return rule_layout(case.plant, problem.sensors, case.aims[0].target_speed_m_s)
