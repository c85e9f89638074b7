"""The reference that is told the friction: better than lines that are not, on the same passes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import LineController, close_loop
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.evaluation import Evaluation
from synth.solver.tuned_lines import fitted
from synth.studies.told_friction import best_polished, told_friction

COARSE = Resolution(path_step_m=1.0, speed_step_m_s=0.05)
CRITERION = Criterion(switching_tolerance_m2_s2=0.0)


def test_knowing_more_is_never_worse(plant_of: Callable[[float], Plant]) -> None:
    """On the same passes, running resistance and all; and a pass has the friction that is told."""
    plant = plant_of(22.0)
    design, aim = persistent_chain(plant, COARSE), Aim(3.0, CRITERION)
    told = told_friction(design, aim, 3, 3)
    assert told.weight.sum() == pytest.approx(1.0)
    fit = fitted(solve(design, aim), 3)
    common = best_polished(Evaluation(design, aim), [(fit.lines, fit)])
    loop, passes = close_loop(plant, plant.top_stage + 1), stratified_passes(1, 0, 6001)
    nodes = np.linspace(0.0, plant.exit_m, 301)
    unknown = loop.run(LineController(common.at(nodes)), loop.draws(passes))
    found = told.sample(loop, passes)
    assert len(found.weight) == 6000
    assert exit_statistics(found, 3.0).rms_ci95_m_s[1] < exit_statistics(unknown, 3.0).rms_ci95_m_s[0]
    middle = loop.run(
        LineController(told.lines[1].at(nodes)), loop.draws(passes.part(0, 6000).every(3, 1), told.factor[1])
    )
    assert np.array_equal(found.exit_speed_m_s[1::3], middle.exit_speed_m_s)


def test_the_best_beginning_is_kept(plant_of: Callable[[float], Plant]) -> None:
    design = persistent_chain(plant_of(22.0), Resolution(path_step_m=1.0, speed_step_m_s=0.04))
    fit, other = (fitted(solve(design, Aim(target, CRITERION)), 3) for target in (3.0, 2.8))
    evaluation, nodes = Evaluation(design, Aim(3.0, CRITERION)), design.grid.path_m
    costs = [
        evaluation.cost(best_polished(evaluation, begins).at(nodes))
        for begins in ([(fit.lines, fit)], [(other.lines, fit)], [(fit.lines, fit), (other.lines, fit)])
    ]
    assert costs[2] == pytest.approx(min(costs[:2]))
