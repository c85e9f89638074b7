"""From lines to a table: rounding, forbidden stages, prediction of exactly what is exported."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from plant_models import Plant
from synth.problem.resolution import Resolution
from synth.solver.chain.chain import persistent_chain
from synth.solver.exit_density import ExitDensity
from synth.solver.policy_density import commands_of, exit_density
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import lines_of, prediction_of, tabulate
from tuning_tables import ControllerTable, Generator, InvalidTable, Predicted, decide_for

GENERATOR = Generator("retarder-synth", "0.1.0", "0" * 64)


def cubic(plant: Plant, gap_m_s: float) -> PolynomialLines:
    """Falling lines `gap_m_s` apart for all stages that the plant may use."""
    stages = plant.top_stage + 1
    coefficients = np.zeros((stages, 2, 4))
    coefficients[:, :, 0] = 3.1 + 0.1 * np.arange(stages)[:, None] + np.array([0.0, gap_m_s])
    coefficients[:, :, 1], coefficients[:, :, 3] = -0.3, 0.0123456789
    has_line = np.ones((stages, 2), dtype=bool)
    has_line[0, 0] = has_line[-1, 1] = False
    return PolynomialLines(plant.start_m, plant.exit_m, coefficients, has_line)


def table_of(plant: Plant, gap_m_s: float = 0.3) -> ControllerTable:
    unknown = Predicted(0.0, 0.0, 0.0, 0.0)
    return tabulate(plant, cubic(plant, gap_m_s), 3.0, unknown, GENERATOR, "t", "2026-11-20T00:00:00Z")


def test_lines_survive_rounding_to_single_precision(plant_52t: Plant) -> None:
    s = np.linspace(0.0, plant_52t.exit_m, 77)
    exported, wanted = lines_of(table_of(plant_52t), s), cubic(plant_52t, 0.3).at(s)
    finite = np.isfinite(wanted.upper_m_s)
    assert np.array_equal(np.isfinite(exported.upper_m_s), finite)
    assert exported.upper_m_s[finite] == pytest.approx(wanted.upper_m_s[finite], abs=5e-6)


@pytest.mark.requirement("RULE-09")
def test_a_forbidden_stage_is_left_at_once_and_never_entered(plant_22t: Plant) -> None:
    table = table_of(plant_22t)
    top = plant_22t.top_stage
    assert len(table.stages) == plant_22t.position.top_stage + 1 > top + 1
    assert table.stages[top].upper is None
    for v in (0.5, 3.0, 8.9):
        assert decide_for(table, top, 10.0, v) <= top
        for k in range(top + 1, len(table.stages)):
            assert decide_for(table, k, 10.0, v) <= top


def test_touching_lines_are_refused(plant_52t: Plant) -> None:
    with pytest.raises(InvalidTable):
        table_of(plant_52t, gap_m_s=0.0)


def test_prediction_counts_stalls_and_overspeed() -> None:
    speed = np.sqrt(2 * np.arange(0.0, 10.0, 0.01))
    probability = np.zeros(len(speed))
    probability[np.searchsorted(speed, 2.0)], probability[np.searchsorted(speed, 3.0)] = 0.5, 0.4
    density = ExitDensity(speed, probability, stalled=0.1, escaped=0.0, switchings=4.0)
    found = prediction_of(density, 2.0)
    assert found.rms_m_s == pytest.approx(np.sqrt(0.4 * 1.0 + 0.1 * 4.0), rel=5e-3)
    assert found.bias_m_s == pytest.approx(0.4 - 0.2, abs=5e-3)
    assert found.p_overspeed == pytest.approx(0.4, abs=1e-9)
    assert found.p_stall == pytest.approx(0.1)


def test_the_staircase_of_the_sensor_is_the_exact_quantisation(plant_of: Callable[[float], Plant]) -> None:
    """P(round((v + noise)/q)·q > line), by the definition of rounding, against the command probabilities."""
    plant = plant_of(52.0)
    design = persistent_chain(
        plant, Resolution(path_step_m=4.0, speed_step_m_s=0.1, friction_nodes=1, resistance_nodes=1)
    )
    nodes = design.grid.path_m
    level = 3.017
    shape = (design.actuator.stages, len(nodes))
    upper = np.full(shape, level)
    upper[-1] = np.inf
    below_top = design.actuator.stages - 2  # all stages have one line: from here a command goes one stage
    found = commands_of(design.quantised(), SwitchingLines(nodes, np.full(shape, -np.inf), upper))[1, 0, below_top]
    q, noise = plant.sensor.resolution_m_s, plant.sensor.noise_m_s
    z = np.random.default_rng(5).normal(size=40_000)
    near = np.abs(design.grid.speed_m_s - level) < 0.15
    for v, p in zip(design.grid.speed_m_s[near], found[near], strict=True):
        simulated = (np.rint((v + noise * z) / q) * q > level).mean()
        assert p == pytest.approx(simulated, abs=4 * np.sqrt(0.25 / len(z)))


def test_density_is_a_distribution(plant_52t: Plant) -> None:
    design = persistent_chain(
        plant_52t, Resolution(path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=3, resistance_nodes=1)
    )
    lines = lines_of(table_of(plant_52t), design.grid.path_m)
    density = exit_density(design.quantised(), lines)
    assert density.probability.sum() + density.stalled == pytest.approx(1.0, abs=1e-8)


@pytest.mark.requirement("PRED-02")
def test_a_stall_counts_as_an_exit_at_rest() -> None:
    """By hand: 0.1 of the cuts stand, the others leave with 1, 2 and 3 m/s."""
    density = ExitDensity(np.arange(4.0), np.array([0.0, 0.25, 0.5, 0.15]), stalled=0.1, escaped=0.0, switchings=1.0)
    exits_m_s = np.repeat([0.0, 1.0, 2.0, 3.0], [10, 25, 50, 15])
    predicted = prediction_of(density, 2.0)
    assert predicted.bias_m_s == pytest.approx((exits_m_s - 2.0).mean())
    assert predicted.rms_m_s == pytest.approx(np.sqrt(((exits_m_s - 2.0) ** 2).mean()))
    assert (predicted.p_stall, predicted.switchings) == (0.1, 1.0)
