"""Passes made ready once are the passes that `simulate` and `trace` would run."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models import Plant
from synth.simulation.closed_loop import LineController, simulate, trace
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.random_passes import random_passes
from synth.solver.switching_lines import SwitchingLines


@pytest.fixture
def prepared(plant_52t: Plant) -> CommonPasses:
    return common_passes(plant_52t, random_passes(3, 0, 150))


@pytest.fixture
def controller(plant_52t: Plant) -> LineController:
    stages = plant_52t.top_stage + 1
    lower, upper = np.full((stages, 2), 2.9), np.full((stages, 2), 3.2)
    lower[0], upper[-1] = -np.inf, np.inf
    return LineController(SwitchingLines(np.array([0.0, plant_52t.exit_m]), lower, upper))


def test_passes_run_as_without_preparation(prepared: CommonPasses, controller: LineController) -> None:
    alone = simulate(prepared.plant, controller, prepared.passes)
    np.testing.assert_array_equal(prepared.run(controller).exit_speed_m_s, alone.exit_speed_m_s)
    assert len(np.unique(alone.exit_speed_m_s)) > 100


def test_the_first_passes_are_the_same_passes(prepared: CommonPasses, controller: LineController) -> None:
    all_speeds = prepared.run(controller).exit_speed_m_s
    assert len(prepared.first(40)) == 40
    np.testing.assert_array_equal(prepared.first(40).run(controller).exit_speed_m_s, all_speeds[:40])
    assert len(prepared.first(1000)) == len(prepared) == 150


def test_other_passes_share_the_loop_and_not_the_chance(prepared: CommonPasses, controller: LineController) -> None:
    others = random_passes(4, 0, 20)
    other = prepared.of_others(others)
    assert other.loop(controller.stages) is prepared.loop(controller.stages)
    alone = simulate(prepared.plant, controller, others)
    np.testing.assert_array_equal(other.run(controller).exit_speed_m_s, alone.exit_speed_m_s)


def test_a_trace_is_that_of_the_pass(prepared: CommonPasses, controller: LineController) -> None:
    one, other = prepared.trace(controller, 7, 1.2), trace(prepared.plant, controller, prepared.passes, 7, 1.2)
    np.testing.assert_array_equal(one.speed_m_s, other.speed_m_s)
    assert one.speed_m_s[0] == simulate_entry(prepared, 7)


def simulate_entry(prepared: CommonPasses, index: int) -> float:
    return float(prepared.plant.entry.speed_m_s(prepared.passes.entry_u)[index])
