"""The reference that is told the friction: never worse than lines that are not, and an exact mixture."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.evaluation import Evaluation
from synth.solver.policy_density import exit_density
from synth.solver.tuned_lines import fitted
from synth.studies.told_friction import best_polished, told_friction

COARSE = Resolution(path_step_m=1.0, speed_step_m_s=0.05)
CRITERION = Criterion(switching_tolerance_m2_s2=0.0)


def test_knowing_more_is_never_worse(plant_of: Callable[[float], Plant]) -> None:
    design = persistent_chain(plant_of(22.0), COARSE)
    told = told_friction(design, Aim(3.0, CRITERION), 3, 3)
    fit = fitted(solve(design, Aim(3.0, CRITERION)), 3)
    common = best_polished(Evaluation(design, Aim(3.0, CRITERION)), [(fit.lines, fit)])
    unknown = exit_density(design, common.at(design.grid.path_m))
    assert told.rms_m_s(3.0) < unknown.rms_m_s(3.0)
    assert told.weight.sum() == pytest.approx(1.0)
    # The mixture's rms is that of the parts, and the passes near the target are most of them.
    parts = [density.rms_m_s(3.0) ** 2 for density in told.densities]
    assert told.rms_m_s(3.0) ** 2 == pytest.approx(float(told.weight @ np.array(parts)))
    core, share = told.near(3.0, 0.3)
    assert core <= told.rms_m_s(3.0)
    assert 0.95 < share <= 1.0 + 1e-6


def test_the_best_beginning_is_kept(plant_of: Callable[[float], Plant]) -> None:
    design = persistent_chain(plant_of(22.0), Resolution(path_step_m=1.0, speed_step_m_s=0.04))
    fit, other = (fitted(solve(design, Aim(target, CRITERION)), 3) for target in (3.0, 2.8))
    evaluation, nodes = Evaluation(design, Aim(3.0, CRITERION)), design.grid.path_m
    costs = [
        evaluation.cost(best_polished(evaluation, begins).at(nodes))
        for begins in ([(fit.lines, fit)], [(other.lines, fit)], [(fit.lines, fit), (other.lines, fit)])
    ]
    assert costs[2] == pytest.approx(min(costs[:2]))
