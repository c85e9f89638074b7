"""Tables for the estimated speed: the estimator knows the plant's work, its error is what is designed for, it helps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Friction, Plant
from scripts.studies.estimator.pair import speed_error_m_s
from synth.problem.problem import Aim
from synth.problem.resolution import LEAST_ERROR_M_S, Resolution, design_error_m_s
from synth.retarder.estimation.estimated_lines import SLOW_DAY_SHARE, SLOW_DAY_Z, estimate_chain, rms_with_white_error
from synth.retarder.estimation.estimated_table import SHIFTS, Trim, moved, trimmed
from synth.retarder.estimation.estimator_design import estimator_of
from synth.simulation.closed_loop import LineController, close_loop, trace
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.chain import persistent_chain
from synth.solver.chain.speed_measurement import SmoothMeasurement
from synth.solver.evaluation import Evaluation
from synth.solver.switching_lines import PolynomialLines, SwitchingLines, opened
from synth.solver.tuned_lines import tuned_lines

COARSE = Resolution(path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=4, resistance_nodes=1)


def uncertain(plant: Plant, mean_cv: float, day_spread: float = 0.0) -> Plant:
    """`plant` whose friction and valves differ from day to day."""
    drive = replace(plant.position.pneumatics, day_spread=day_spread)
    friction = replace(plant.friction, mean_cv=mean_cv)
    return replace(plant, friction=friction, position=replace(plant.position, pneumatics=drive))


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(11, 0, 1500)


def climbing(plant: Plant) -> SwitchingLines:
    """Some lines under which every stage is used."""
    nodes = np.linspace(0.0, plant.exit_m, 5)
    stages = plant.top_stage + 1
    upper = np.array([np.linspace(5.5 + 0.3 * k, 3.2 + 0.3 * k, 5) for k in range(stages)])
    lower = upper - 0.8
    lower[0], upper[-1] = -np.inf, np.inf
    return SwitchingLines(nodes, lower, upper)


def test_the_work_is_that_of_the_simulated_cut(plant_of: Callable[[float], Plant], passes: RandomPasses) -> None:
    """Energy along a simulated pass without path noise, at the friction of the cut, follows D(s) − ξ p W(s)."""
    quiet = replace(plant_of(36.0), friction=Friction(0.15, 0.0, 0.0, 2.0))
    quiet = replace(quiet, resistance=replace(quiet.resistance, std_n_per_kn=0.0))
    estimator = estimator_of(quiet)
    factor = 0.85
    seen = trace(quiet, LineController(climbing(quiet)), passes, 3, cut_factor=factor)
    drive = np.diff(np.interp(seen.path_m, estimator.s_m, estimator.drive_m2_s2))
    brake = np.diff(np.interp(seen.path_m, estimator.s_m, estimator.brake_m2_s2_per_kpa))
    gained = drive - factor * seen.overpressure_kpa[:-1] * brake
    assert seen.stage.max() >= 2
    assert np.cumsum(gained) == pytest.approx(0.5 * seen.speed_m_s[1:] ** 2 - 0.5 * seen.speed_m_s[0] ** 2, abs=1e-6)


def test_the_estimate_is_closer_than_the_sensor(plant_of: Callable[[float], Plant], passes: RandomPasses) -> None:
    plant = plant_of(36.0)
    loop, lines = close_loop(plant, plant.top_stage + 1), climbing(plant)
    raw = speed_error_m_s(loop, LineController(lines), passes.part(0, 100))
    estimated = speed_error_m_s(loop, LineController(lines, estimator=estimator_of(plant)), passes.part(0, 100))
    sensor = plant.sensor
    assert raw == pytest.approx(np.hypot(sensor.noise_m_s, sensor.resolution_m_s / np.sqrt(12.0)), rel=0.05)
    assert estimated < 0.55 * raw


def test_a_missing_reading_is_bridged_by_the_estimator_alone(
    plant_of: Callable[[float], Plant], passes: RandomPasses
) -> None:
    plant, one = plant_of(36.0), passes.part(7, 8)
    gap = one.noise_z.copy()
    gap[:, 15:25] = np.nan
    blind = replace(one, noise_z=gap)
    still = np.full((plant.top_stage + 1, 2), np.inf)
    lines = SwitchingLines(np.array([0.0, plant.exit_m]), -still, still)  # no command: every sample is one at rest
    without = trace(plant, LineController(lines), blind, 0)
    bridged = trace(plant, LineController(lines, estimator=estimator_of(plant)), blind, 0)
    sampled = slice(1, -1)  # the first event is the entrance, the last the exit
    assert np.isnan(without.measured_m_s[sampled]).sum() == 10
    assert np.abs(bridged.measured_m_s - bridged.speed_m_s)[sampled].max() < 0.2


def test_a_trim_may_change_along_the_path() -> None:
    wanted = np.array([[0.03, -0.01], [0.02, 0.0], [-0.01, 0.015]])
    found, before, after = trimmed(lambda by: float(((np.array(by) - wanted) ** 2).sum()), Trim(3, 400))
    assert after < 0.01 * before
    assert np.array(found) == pytest.approx(wanted, abs=2e-3)


def test_the_chain_says_what_passes_with_a_white_error_say(
    plant_of: Callable[[float], Plant], passes: RandomPasses
) -> None:
    """The two ways to judge one design: the exact recursion on its grid, and simulated passes without a grid."""
    plant = uncertain(plant_of(36.0), 0.0)
    chain = estimate_chain(plant, Resolution(), 3.0)
    lines = tuned_lines(chain, Aim(3.0), 3).best
    exact = Evaluation(chain, Aim(3.0)).rms_m_s(lines.at(chain.grid.path_m))
    sampled = rms_with_white_error(plant, lines, 3.0, stratified_passes(14, 0, 6000))
    assert exact == pytest.approx(sampled, rel=0.15)


def test_no_error_is_too_small_to_design_for(plant_of: Callable[[float], Plant]) -> None:
    exact = replace(plant_of(36.0).sensor, noise_m_s=0.0, resolution_m_s=0.0)
    assert design_error_m_s(exact) == LEAST_ERROR_M_S
    assert design_error_m_s(replace(exact, noise_m_s=0.1)) == pytest.approx(0.045)


def test_the_cost_of_several_days_is_their_mean(plant_of: Callable[[float], Plant]) -> None:
    """Cost and gradient: those of the usual day and of the slow one, each as of a plant that is always so."""
    plant = uncertain(plant_of(36.0), 0.08, 0.3)
    chain, aim = estimate_chain(plant, COARSE, 3.0), Aim(3.0)
    ((share, slow),) = chain.other_days
    usual = replace(chain, other_days=())
    some, nodes_m = climbing(plant), chain.grid.path_m
    lines = SwitchingLines(nodes_m, on_nodes(nodes_m, some, some.lower_m_s), on_nodes(nodes_m, some, some.upper_m_s))
    found, each = Evaluation(chain, aim).gradient(lines), [Evaluation(c, aim).gradient(lines) for c in (usual, slow)]
    assert share == SLOW_DAY_SHARE
    for k in range(2):
        np.testing.assert_allclose(found[k], (1.0 - share) * each[0][k] + share * each[1][k], rtol=1e-12)
    drive, always = plant.position.pneumatics, slow.plant.position.pneumatics
    assert always.fill_time_constant_s == pytest.approx(np.exp(0.3 * SLOW_DAY_Z) * drive.fill_time_constant_s)
    assert (always.day_spread, always.dead_band_kpa) == (0.0, drive.dead_band_kpa)


def on_nodes(nodes_m: np.ndarray, lines: SwitchingLines, rows: np.ndarray) -> np.ndarray:
    """`rows` of lines at other nodes, infinite where they are."""
    inside = [np.interp(nodes_m, lines.nodes_m, np.nan_to_num(row, posinf=0.0, neginf=0.0)) for row in rows]
    return np.where(np.isfinite(rows[:, :1]), np.array(inside), rows[:, :1])


def test_where_the_mean_is_known_lines_are_designed_as_for_the_friction_of_a_cut(
    plant_of: Callable[[float], Plant],
) -> None:
    """Scenarios to the bit; an uncertain mean gives others."""
    plant = plant_of(36.0)
    known, wide = (estimate_chain(uncertain(plant, mean_cv), COARSE, 3.0) for mean_cv in (0.0, 0.15))
    asked = persistent_chain(plant, known.resolution)
    np.testing.assert_array_equal(known.scenarios.factor, asked.scenarios.factor)
    assert wide.scenarios.factor.min() < known.scenarios.factor.min() - 0.1


def test_a_trim_never_makes_worse() -> None:
    assert trimmed(lambda by: 1.0 + by[0][0] ** 2 + by[0][1] ** 2, SHIFTS) == (((0.0, 0.0),), 1.0, 1.0)
    ((a, b),), before, after = trimmed(lambda by: 1.0 + (by[0][0] - 0.03) ** 2 + 4.0 * (by[0][1] + 0.01) ** 2, SHIFTS)
    assert (a, b) == pytest.approx((0.03, -0.01), abs=0.005)
    assert after < before


def test_a_trim_cannot_make_lines_meet(plant_of: Callable[[float], Plant]) -> None:
    constant = np.zeros((2, 2, 2))
    constant[:, 0, 0], constant[:, 1, 0] = 3.0, 3.1
    lines = PolynomialLines(0.0, 37.0, constant, np.array([[False, True], [True, True]]))
    at = opened(moved(lines, ((0.09, -0.05),))).at(np.linspace(0.0, 37.0, 5))
    assert (at.upper_m_s - at.lower_m_s)[1] == pytest.approx(0.04)
    assert (0.5 * (at.upper_m_s + at.lower_m_s))[1] == pytest.approx(3.07)
    near = opened(moved(lines, ((0.01, -0.02),)))
    assert near.coefficients[1, :, 0] == pytest.approx([3.01, 3.08])


def test_a_white_error_enters_the_commands_alone(plant_of: Callable[[float], Plant]) -> None:
    """Lines for another measurement of the same chain are, to the bit, those of a plant with a sensor like that."""
    plant, coarse = (
        plant_of(36.0),
        Resolution(path_step_m=1.0, speed_step_m_s=0.04, friction_nodes=4, resistance_nodes=1),
    )
    seen = replace(persistent_chain(plant, coarse), measurement=SmoothMeasurement(0.02))
    other = replace(plant, sensor=replace(plant.sensor, noise_m_s=0.02, resolution_m_s=0.0))
    lines = [tuned_lines(chain, Aim(3.0), 3).best for chain in (seen, persistent_chain(other, coarse))]
    np.testing.assert_array_equal(lines[0].coefficients, lines[1].coefficients)
