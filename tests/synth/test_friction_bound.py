"""The friction-known reference: who is told what, and whose choice it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Friction, Plant
from synth.retarder.comparison.friction_bound import (
    Bias,
    Told,
    ToldWithEstimator,
    best_by_others,
    bound_of,
    by_lines,
    knowing,
    levelled,
    no_bias,
    run_told,
)
from synth.retarder.estimation.estimated_table import controller_of, moved
from synth.retarder.estimation.estimator_design import estimator_of
from synth.simulation.closed_loop import Controller, LineController, TableController, close_loop, trace
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.switching_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from synth.solver.told_lines import ToldLines
from tuning_tables import Generator
from tuning_tables.estimator import Estimator

TARGET_M_S = 3.0


def constant_lines(plant: Plant, height_m_s: float) -> PolynomialLines:
    """A relay that falls along the path: in its middle a stage goes up above `height_m_s` + 0.3, down below − 0.3."""
    stages = plant.top_stage + 1
    has_line = np.ones((stages, 2), dtype=bool)
    has_line[0, 0] = has_line[-1, 1] = False
    coefficients = np.zeros((stages, 2, 2))
    coefficients[:, 0], coefficients[:, 1] = (height_m_s - 0.3, -0.8), (height_m_s + 0.3, -0.8)
    return PolynomialLines(plant.start_m, plant.exit_m, coefficients, has_line)


@pytest.fixture(scope="module")
def passes(plant_of: Callable[[float], Plant]) -> CommonPasses:
    return common_passes(plant_of(36.0), stratified_passes(3, 0, 2000))


def sample_of(error_m_s: np.ndarray) -> ExitSample:
    n = len(error_m_s)
    return ExitSample(TARGET_M_S + error_m_s, np.zeros(n, bool), np.zeros(n, np.int32), np.ones(n), np.ones(n))


def test_every_pass_has_the_controller_for_its_friction(passes: CommonPasses) -> None:
    """In as many groups as passes the controller hears the very ξ_cut; in few groups the mean of the group."""
    heard: list[float] = []
    lines = constant_lines(passes.plant, 3.7)

    def told(factor: float) -> Controller:
        heard.append(factor)
        return LineController(lines.at(lines.nodes_m(301)))

    few = passes.first(300)
    alone = run_told(few.loop, few.draws, told, 300)
    assert heard == sorted(few.draws.cut_factor.tolist())
    heard.clear()
    grouped = run_told(few.loop, few.draws, told, 7)
    assert len(heard) == 7
    assert np.mean(heard) == pytest.approx(few.draws.cut_factor.mean(), abs=0.01)
    plain = few.run(LineController(lines.at(lines.nodes_m(301))))
    for found in (alone, grouped):  # one controller for all: the passes of a plain run, each in its place
        assert np.array_equal(found.exit_speed_m_s, plain.exit_speed_m_s)
        assert np.array_equal(found.switchings, plain.switchings)
        assert np.array_equal(found.weight, plain.weight)


def test_lines_are_those_of_the_friction(passes: CommonPasses) -> None:
    low, high = (constant_lines(passes.plant, height) for height in (3.5, 4.0))
    told = by_lines(ToldLines(np.array([0.7, 1.3]), (low, high)))
    controller = told(1.0)
    assert isinstance(controller, LineController)
    middle = constant_lines(passes.plant, 3.75)
    assert np.allclose(controller.lines.upper_m_s, middle.at(middle.nodes_m(301)).upper_m_s)


def test_a_choice_is_made_by_the_other_half() -> None:
    """What the passes of a half are has no part in which controller they are shown under."""
    rng = np.random.default_rng(2)
    a, b = (rng.normal(0.0, 1.0, 400) for _ in range(2))
    odd = np.arange(400) // 100 % 2 == 1
    a[odd], b[~odd] = 0.1 * a[odd], 0.1 * b[~odd]  # a is good in the odd replicates, b in the even ones
    found = best_by_others([sample_of(a), sample_of(b)], TARGET_M_S).exit_speed_m_s - TARGET_M_S
    assert np.allclose(found, np.where(odd, b, a))
    better = best_by_others([sample_of(a), sample_of(0.5 * a)], TARGET_M_S)
    assert np.allclose(better.exit_speed_m_s - TARGET_M_S, 0.5 * a)
    short = best_by_others([sample_of(a[:50]), sample_of(b[:50])], TARGET_M_S)  # there is no other half
    assert np.allclose(short.exit_speed_m_s - TARGET_M_S, a[:50])


def test_choosing_makes_no_figure_better_than_it_is() -> None:
    """Eight controllers that are alike: the mean square of the choice is theirs, where the least of them is less."""
    rng = np.random.default_rng(3)
    chosen, least = [], []
    for _ in range(400):
        samples = [sample_of(rng.normal(0.0, 1.0, 400)) for _ in range(8)]
        squares = [np.mean((each.exit_speed_m_s - TARGET_M_S) ** 2) for each in samples]
        chosen.append(np.mean((best_by_others(samples, TARGET_M_S).exit_speed_m_s - TARGET_M_S) ** 2))
        least.append(min(squares))
    error = np.std(chosen) / np.sqrt(len(chosen))
    assert np.mean(chosen) == pytest.approx(1.0, abs=4.0 * error)
    assert np.mean(least) < 1.0 - 20.0 * error


def test_a_table_that_is_better_than_what_is_told_is_the_reference(passes: CommonPasses) -> None:
    plant = passes.plant
    lines = constant_lines(plant, 3.7)
    table = tabulate(plant, lines, TARGET_M_S, UNPREDICTED, Generator("t", "0", "0" * 64), "t", "2000-01-01T00:00:00Z")
    sample = passes.run(TableController(table))
    bad, good = (by_lines(ToldLines(np.array([1.0]), (constant_lines(plant, height),))) for height in (4.6, 3.7))

    def ratio(regulators: list[Told]) -> float:
        return rms_ratio(sample, bound_of(passes, regulators, sample, TARGET_M_S), TARGET_M_S)[0]

    assert ratio([bad]) == 1.0
    assert ratio([]) == 1.0
    assert ratio([bad, good]) == pytest.approx(1.0, abs=0.02)  # the same lines, not rounded


def test_an_estimator_that_knows_the_friction_foretells_the_speed(plant_of: Callable[[float], Plant]) -> None:
    """Without noise along the path the work it reckons with is that of the simulated cut, and it learns nothing."""
    plant = plant_of(36.0)
    quiet = replace(plant, friction=Friction(0.15, 0.0, 0.0, 2.0))
    quiet = replace(quiet, resistance=replace(quiet.resistance, std_n_per_kn=0.0))
    factor = 0.8
    estimator = knowing(estimator_of(quiet), factor)
    lines = constant_lines(quiet, 3.7)
    nodes_m = lines.nodes_m(301)
    by_lines_alone = LineController(lines.at(nodes_m), farthest=1)  # all stages have the same lines
    seen = trace(quiet, by_lines_alone, random_passes(5, 0, 10), 3, cut_factor=factor)
    work = np.diff(np.interp(seen.path_m, estimator.s_m, estimator.brake_m2_s2_per_kpa))
    drive = np.diff(np.interp(seen.path_m, estimator.s_m, estimator.drive_m2_s2))
    gained = np.cumsum(drive - seen.overpressure_kpa[:-1] * work)
    assert gained == pytest.approx(0.5 * seen.speed_m_s[1:] ** 2 - 0.5 * seen.speed_m_s[0] ** 2, abs=1e-6)
    assert estimator.friction_cv == 0.0
    loop = close_loop(quiet, quiet.top_stage + 1)
    draws = loop.draws(random_passes(6, 0, 400), factor)

    def error(used: LineController) -> float:
        return exit_statistics(loop.run(used, draws), TARGET_M_S).std_m_s

    told = replace(by_lines_alone, estimator=estimator)
    mistaken = replace(by_lines_alone, estimator=knowing(estimator_of(quiet), 1.2))
    assert error(told) < error(by_lines_alone)
    assert error(told) < error(mistaken)


def test_the_bias_by_friction_is_taken_out() -> None:
    factor = np.linspace(0.7, 1.3, 200)
    bias = Bias(0.75, 1.25).and_of(factor, 0.2 * (np.clip(factor, 0.75, 1.25) - 1.0) ** 3 + 0.01)
    assert bias.at(1.1) == pytest.approx(0.2 * 0.1**3 + 0.01)
    assert bias.at(2.0) == pytest.approx(bias.at(1.25))
    again = bias.and_of(factor, np.full(200, 0.02))
    assert again.at(1.1) == pytest.approx(bias.at(1.1) + 0.02)
    assert Bias(1.0, 1.0).and_of(np.ones(50), np.full(50, 0.03)).at(1.0) == pytest.approx(0.03)


def one_stage_a_command(lines: PolynomialLines, estimator: Estimator | None) -> LineController:
    """All stages have the same lines: a command that went on would go to the last."""
    return replace(controller_of(lines, estimator), farthest=1)


def test_levelled_lines_leave_no_mean_error(passes: CommonPasses) -> None:
    plant = passes.plant
    tuning = passes.of_others(random_passes(9, 0, 1500))
    lines = constant_lines(plant, 3.7)

    def controller(shift: float, estimator: Estimator) -> LineController:
        return one_stage_a_command(moved(lines, ((shift, shift),)), estimator)

    told = ToldWithEstimator(estimator_of(plant), controller, no_bias(tuning))
    found = levelled(told, tuning, TARGET_M_S)
    plain = exit_statistics(run_told(tuning.loop, tuning.draws, replace(found, bias=Bias(0.5, 1.5))), TARGET_M_S)
    level = exit_statistics(run_told(tuning.loop, tuning.draws, found), TARGET_M_S)
    assert abs(plain.bias_m_s) > 0.05
    assert abs(level.bias_m_s) < 0.2 * abs(plain.bias_m_s)
    assert level.rms_m_s < plain.rms_m_s
