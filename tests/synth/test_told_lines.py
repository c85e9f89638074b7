"""Lines for known frictions: never worse than the common ones, and the best where all constants are tried."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from plant_models import Friction, Plant
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.evaluation import Evaluation
from synth.solver.switching_lines import MINIMUM_GAP_M_S, PolynomialLines, gap_of
from synth.solver.told_lines import (
    SQUARED_ERROR_ALONE,
    Effort,
    ToldLines,
    from_the_middle,
    knowing,
    mean_square,
    mean_squares,
    of_degree,
    told_factors,
    told_lines,
)
from synth.solver.tuned_lines import Fit, fitted, polished

COARSE = Resolution(path_step_m=1.0, speed_step_m_s=0.04, friction_nodes=4, resistance_nodes=1)
TARGET_M_S = 3.0


def beginning(design: Chain, target_m_s: float, degree: int) -> tuple[PolynomialLines, Fit]:
    """Polished lines for all frictions, and the fit that they began with."""
    solution = solve(design, Aim(target_m_s, SQUARED_ERROR_ALONE))
    fit = fitted(solution, degree)
    return polished(solution, fit).best, fit


@pytest.mark.parametrize(("mass_t", "target_m_s"), [(22.0, 3.0), (66.0, 2.0)])
def test_at_no_friction_it_is_worse_not_to_be_told(
    plant_of: Callable[[float], Plant], mass_t: float, target_m_s: float
) -> None:
    """Exact costs on the grid: never above those of the common lines, well below where brake power is no matter."""
    design = persistent_chain(plant_of(mass_t), COARSE)
    common, fit = beginning(design, target_m_s, 3)
    found = told_lines(design, target_m_s, common, fit.curvature)
    factor, weight = told_factors(design.plant, Effort().frictions)
    assert len(factor) == len(found.lines) == 9
    evaluations = [knowing(design, target_m_s, float(each), 1) for each in factor]
    without = np.array([mean_square(each, common) for each in evaluations])
    told = np.array([mean_square(each, lines) for each, lines in zip(evaluations, found.lines, strict=True)])
    assert (told <= without * (1.0 + 1e-6)).all()
    assert weight @ told < weight @ without
    if mass_t == 22.0:
        assert (told[3:6] < 0.97 * without[3:6]).any()
    assert all(gap_of(lines) >= 0.99 * MINIMUM_GAP_M_S for lines in found.lines)


def test_the_best_constant_lines_are_found(plant_of: Callable[[float], Plant]) -> None:
    """Two stages and lines of degree 0: two numbers for each friction, and all pairs of them are tried."""
    plant = plant_of(36.0)
    position = replace(plant.position, stage_pressures_kpa=(0.0, 300.0))
    two = replace(plant, position=position, cut=replace(plant.cut, allowed_stage=1))
    design = persistent_chain(two, COARSE)
    common, fit = beginning(design, TARGET_M_S, 0)
    effort = Effort(frictions=5, degree=0, iterations=(60, 60), tolerance=1e-7, least_share=0.0)
    found = told_lines(design, TARGET_M_S, common, fit.curvature, effort)
    for factor, lines in list(zip(found.factor, found.lines, strict=True))[1:4]:
        evaluation = knowing(design, TARGET_M_S, float(factor), 1)
        reached = mean_square(evaluation, lines)
        tried = []
        for down, up in product(np.arange(1.5, 5.0, 0.1), repeat=2):
            if up - down >= MINIMUM_GAP_M_S:
                coefficients = np.zeros((2, 2, 1))
                coefficients[1, 0, 0], coefficients[0, 1, 0] = down, up
                tried.append(mean_square(evaluation, replace(lines, coefficients=coefficients)))
        assert reached <= 1.03 * min(tried)


def test_lines_between_two_frictions_lie_between() -> None:
    has_line = np.array([[False, True], [True, False]])
    low, high = (PolynomialLines(0.0, 10.0, np.full((2, 2, 2), value), has_line) for value in (2.0, 4.0))
    told = ToldLines(np.array([0.8, 1.0]), (low, high))
    for factor, value in ((0.5, 2.0), (0.8, 2.0), (0.85, 2.5), (1.0, 4.0), (1.3, 4.0)):
        assert told.at(factor).coefficients == pytest.approx(np.full((2, 2, 2), value))
    alone = ToldLines(np.array([1.0]), (low,))
    assert alone.at(0.7) is alone.at(1.4) is low


def test_frictions_at_the_floor_are_one(plant_of: Callable[[float], Plant]) -> None:
    """Φ of the whole law is kept: weights sum to one, and the mean of the factors is that of the law."""
    plant = plant_of(36.0)
    factor, weight = told_factors(replace(plant, friction=Friction(0.25, 0.0, 0.0, 2.0, floor=0.5)), 13)
    assert factor[0] == 0.5
    assert (np.diff(factor) > 0.0).all()
    assert weight.sum() == pytest.approx(1.0)
    same, certain = told_factors(replace(plant, friction=Friction(0.0, 0.0, 0.0, 2.0)), 13)
    assert same.tolist() == [1.0]
    assert certain == pytest.approx([1.0])


def test_a_higher_degree_writes_the_same_lines() -> None:
    rng = np.random.default_rng(1)
    lines = PolynomialLines(-4.0, 30.0, rng.normal(3.0, 0.1, (3, 2, 4)), np.ones((3, 2), dtype=bool))
    nodes = lines.nodes_m(50)
    assert of_degree(lines, 7).degree == 7
    assert np.allclose(of_degree(lines, 7).at(nodes).upper_m_s, lines.at(nodes).upper_m_s, atol=1e-12)


def test_every_friction_has_a_neighbour_before_it() -> None:
    for count in (1, 2, 5, 13):
        order = list(from_the_middle(count))
        assert sorted(order) == list(range(count))
        assert all({i - 1, i + 1} & set(order[:place]) for place, i in enumerate(order) if place)


def test_the_resistance_counts_where_it_is_asked_for(plant_of: Callable[[float], Plant]) -> None:
    """Told the friction, not the resistance: with two values of it the mean square is the mean of both."""
    design = persistent_chain(plant_of(22.0), COARSE)
    common, _ = beginning(design, TARGET_M_S, 3)
    both = knowing(design, TARGET_M_S, 1.1, 2)
    one = [
        Evaluation(replace(design, scenarios=replace(
            both.chain.scenarios, factor=np.array([1.1]), extra_m_s2=both.chain.scenarios.extra_m_s2[i : i + 1],
            weight=np.ones(1))), both.aim)
        for i in range(2)
    ]  # fmt: skip
    expected = both.chain.scenarios.weight @ np.array([mean_square(each, common) for each in one])
    assert mean_square(both, common) == pytest.approx(expected, rel=1e-9)
    assert mean_square(both, common) > mean_square(knowing(design, TARGET_M_S, 1.1, 1), common)


def test_one_recursion_looks_at_all_frictions(plant_of: Callable[[float], Plant]) -> None:
    """The mean squares of the same lines at several frictions are those at each alone."""
    design = persistent_chain(plant_of(22.0), COARSE)
    common, _ = beginning(design, TARGET_M_S, 3)
    factor = np.array([0.6, 1.0, 1.3])
    for nodes in (1, 2):
        alone = [mean_square(knowing(design, TARGET_M_S, float(each), nodes), common) for each in factor]
        assert mean_squares(design, TARGET_M_S, common, factor, nodes) == pytest.approx(alone, rel=1e-12)
