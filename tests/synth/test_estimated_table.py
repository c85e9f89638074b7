"""Tables for the estimated speed: the estimator knows the plant's work, its error is what is designed for, it helps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Friction, Plant, PressingForce
from synth.book.estimation.estimated_table import (
    SHIFTS,
    Trim,
    controller_of,
    designed_lines,
    estimated_table,
    estimator_design,
    moved,
    trimmed,
)
from synth.book.estimation.estimator_design import estimator_of, speed_error_m_s
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.problem import Problem
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import LineController, close_loop, simulate, trace
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.chain.chain import persistent_chain
from synth.solver.chain.speed_measurement import SmoothMeasurement
from synth.solver.polynomial_lines import PolynomialLines, opened
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tuned_lines import tuned_lines


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


@pytest.mark.slow
def test_it_is_designed_for_its_own_error_and_better_than_no_estimator(
    plant_of: Callable[[float], Plant], passes: RandomPasses
) -> None:
    plant = plant_of(36.0)
    problem = Problem(plant, Aim(3.0, Criterion()))
    coarse = Resolution(path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=4, resistance_nodes=1)
    measured = tuned_lines(persistent_chain(plant, coarse), Aim(3.0, problem.criterion), 3).lines
    made = estimated_table(problem, estimator_design(plant, coarse, 3.0), measured, passes)
    assert made.designed
    assert made.gains
    assert made.rms_after_m_s <= made.rms_before_m_s
    assert made.rounds <= 3
    lines = made.lines.at(np.linspace(0.0, plant.exit_m, 301))
    fresh = random_passes(12, 0, 4000)
    exits = [simulate(plant, c, fresh) for c in (LineController(lines), controller_of(made.lines, made.estimator))]
    squares = [(sample.exit_speed_m_s - 3.0) ** 2 for sample in exits]
    gain = squares[0] - squares[1]
    assert gain.mean() > 3.0 * gain.std() / np.sqrt(len(gain))  # on the same passes
    assert np.sqrt(squares[1].mean()) < 0.04


@pytest.mark.slow
def test_lines_for_an_uncertain_mean_keep_a_reserve(plant_of: Callable[[float], Plant], passes: RandomPasses) -> None:
    """On a day of little friction fewer cuts leave too fast, beyond chance, and the mean day hardly pays."""
    coarse, target = Resolution(path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=4, resistance_nodes=1), 3.0
    plants = [
        replace(plant, friction=replace(plant.friction, mean_cv=m)) for m in (0.0, 0.15) for plant in [plant_of(36.0)]
    ]
    measured = tuned_lines(persistent_chain(plants[0], coarse), Aim(target), 3).lines
    made = [
        estimated_table(Problem(plant, Aim(target)), estimator_design(plant, coarse, target), measured, passes)
        for plant in plants
    ]
    assert made[0].worst_day == pytest.approx(made[0].rms_after_m_s / made[0].plain_rms_m_s)
    fresh = stratified_passes(13, 0, 6000)
    controllers = [controller_of(each.lines, each.estimator) for each in made]
    nominal = [exit_statistics(simulate(plants[0], each, fresh), target).rms_m_s for each in controllers]
    assert nominal[1] < 1.1 * nominal[0]
    force = PressingForce(0.7 * 20.0 / 550.0, 50.0)
    weak = replace(plants[0], position=replace(plants[0].position, force=force))
    samples = [simulate(weak, each, fresh) for each in controllers]
    fast = [sample.weight * (sample.exit_speed_m_s > target + 0.3) for sample in samples]
    fewer = (fast[0] - fast[1]).reshape(-1, 100).mean(axis=1)  # by replicate
    assert fewer.mean() > 4.0 * fewer.std() / np.sqrt(len(fewer))


def test_where_the_mean_is_known_lines_are_designed_as_for_the_friction_of_a_cut(
    plant_of: Callable[[float], Plant],
) -> None:
    """Scenarios and lines to the bit; an uncertain mean gives others."""
    plant, coarse = (
        plant_of(36.0),
        Resolution(path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=4, resistance_nodes=1),
    )
    uncertain = replace(plant, friction=replace(plant.friction, mean_cv=0.15))
    known, wide = (estimator_design(each, coarse, 3.0) for each in (plant, uncertain))
    asked = persistent_chain(plant, known.resolution)
    np.testing.assert_array_equal(known.scenarios.factor, asked.scenarios.factor)
    assert wide.scenarios.factor.min() < known.scenarios.factor.min() - 0.1
    seen = replace(asked, measurement=SmoothMeasurement(0.02))
    lines = designed_lines(Problem(plant, Aim(3.0)), known, 3, 0.02)
    np.testing.assert_array_equal(lines.coefficients, tuned_lines(seen, Aim(3.0), 3).lines.coefficients)


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
    lines = [tuned_lines(chain, Aim(3.0), 3).lines for chain in (seen, persistent_chain(other, coarse))]
    np.testing.assert_array_equal(lines[0].coefficients, lines[1].coefficients)
