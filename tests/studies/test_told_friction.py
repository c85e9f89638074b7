"""The reference with more effort: better than lines that are not told, on the same passes, as exact costs foretell."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from plant_models import Plant
from scripts.studies.told_friction import THOROUGH, simulate_told, thorough, told_friction
from synth.problem.aim import Aim
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import LineController, simulate
from synth.simulation.exit_statistics import rms_ratio
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.chain import persistent_chain
from synth.solver.told_lines import SQUARED_ERROR_ALONE
from synth.solver.tuned_lines import tuned_lines

COARSE = Resolution(path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=4, resistance_nodes=1)


def test_knowing_more_is_never_worse(plant_of: Callable[[float], Plant]) -> None:
    """On the same passes, running resistance and all."""
    plant = plant_of(22.0)
    design = persistent_chain(plant, COARSE)
    passes = stratified_passes(1, 0, 6000)
    common = tuned_lines(design, Aim(3.0, SQUARED_ERROR_ALONE), 3).best
    unknown = simulate(plant, LineController(common.at(common.nodes_m(301))), passes)
    told = simulate_told(plant, told_friction(design, 3.0, 3, thorough(5, 10)), passes)
    assert np.array_equal(told.weight, unknown.weight)
    assert rms_ratio(unknown, told, 3.0)[1][0] > 1.0


@pytest.mark.parametrize("frictions", [1, 5])
def test_effort_is_what_is_asked(plant_of: Callable[[float], Plant], frictions: int) -> None:
    effort = thorough(frictions, 7)
    assert (effort.frictions, effort.iterations) == (frictions, (7, 7))
    assert effort.resistance_nodes == THOROUGH.resistance_nodes
    told = told_friction(persistent_chain(plant_of(52.0), COARSE), 3.0, 3, thorough(frictions, 1))
    low, high = told(0.7), told(1.3)
    assert isinstance(low, LineController)
    assert isinstance(high, LineController)
    assert np.array_equal(low.lines.upper_m_s, high.lines.upper_m_s) == (frictions == 1)
