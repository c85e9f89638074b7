"""The rounds of a polish."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.resolution import Resolution, finer_for_check
from synth.simulation.common_passes import common_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.chain import check_chain, persistent_chain
from synth.solver.evaluation import Gradient
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tuned_lines import cost_at_full_brake, remembering


def test_the_same_lines_are_evaluated_once() -> None:
    """Equal lines have the answer of before, others their own: lower and upper lines are not taken for one another."""
    asked: list[SwitchingLines] = []

    def evaluate(lines: SwitchingLines) -> Gradient:
        asked.append(lines)
        return float(len(asked)), lines.lower_m_s

    def lines(lower: float, upper: float) -> SwitchingLines:
        return SwitchingLines(np.zeros(1), np.full((2, 1), lower), np.full((2, 1), upper))

    answer = remembering(evaluate)
    costs = [answer(lines(*each))[0] for each in ((1.0, 2.0), (2.0, 1.0), (1.0, 2.0), (1.0, 2.0 + 1e-12), (2.0, 1.0))]
    assert costs == [1.0, 2.0, 1.0, 3.0, 2.0]
    assert len(asked) == 3


def test_what_no_lines_avoid_is_what_passes_at_full_brake_cost(plant_of: Callable[[float], Plant]) -> None:
    """The recursion at the highest stage all the way against simulated passes; nothing for a cut that it stops."""
    heavy, light = plant_of(85.0), plant_of(22.0)
    found = cost_at_full_brake(check_chain(heavy, finer_for_check(Resolution())), Aim(2.0))
    slowest = common_passes(heavy, stratified_passes(5, 0, 20_000)).at_full_brake
    excess = np.maximum(slowest.exit_speed_m_s - 2.0, 0.0)
    assert found == pytest.approx(np.average(excess**2, weights=slowest.weight), rel=0.05)
    assert found > 0.01
    assert cost_at_full_brake(persistent_chain(light, Resolution(friction_nodes=4)), Aim(3.0)) < 1e-6
