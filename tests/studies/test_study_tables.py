"""The tables and references that studies measure are those of a tune, and two ways to the same figure agree."""

from __future__ import annotations

import numpy as np
import pytest

from synth.book.class_setup import class_setup, origin_of
from synth.book.comparison.told_regulator import by_lines, run_told
from synth.book.tuned_table import solutions
from synth.book.tuned_table import tuned_table as tuned_table_of_a_tune
from synth.configuration.config_file import load_config, parse_config
from synth.problem.aim import Aim
from synth.problem.resolution import finer_for_check
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import check_chain, persistent_chain
from synth.solver.one_blas_thread import one_blas_thread
from synth.solver.told_lines import SQUARED_ERROR_ALONE, knowing, mean_square, told_factors, told_lines
from synth.solver.tuned_lines import fitted, polished
from synth.studies.accuracy_grid.study import Class, Row, figures_of, plain_table
from synth.studies.cases import Case, named_cases
from synth.studies.convergence.study import METHOD, studied
from synth.studies.tuned_table import CREATED, tuned_table


@one_blas_thread()
def test_the_table_of_a_study_is_that_of_a_tune() -> None:
    config = parse_config("[regulator]\nestimator = false\n", "measured speed")
    cases = named_cases(config, ("52:2", "52:3", "52:4"))
    setup = class_setup(config, cases[0].label, cases[0].plant, random_passes(1, 0, 100), origin_of("0" * 64, CREATED))
    for case, solution in zip(
        cases, solutions(setup.design, [Aim(c.target_m_s, config.criterion) for c in cases]), strict=True
    ):
        ours = tuned_table(config, case.plant, case.target_m_s)
        assert ours.stages == tuned_table_of_a_tune(setup, solution).table.stages


@pytest.fixture(scope="module")
def shared() -> tuple[Case, Class]:
    """52 t to 3 m/s as the grid has it, with few passes."""
    config = load_config(None)
    (case,) = named_cases(config, ("52:3",))
    design = persistent_chain(case.plant, config.resolution)
    check = check_chain(case.plant, finer_for_check(config.resolution))
    trim = stratified_passes(2, 0, 3000)
    passes = Row(stratified_passes(1, 0, 5000), random_passes(2, 0, 3000), trim, stratified_passes(3, 0, 1000))
    return case, Class(config, case.plant, design, check, 0.5, passes, common_passes(case.plant, passes.fresh))


def test_what_is_told_is_simulated_as_the_check_grid_predicts(shared: tuple[Case, Class]) -> None:
    """Passes in time, and Chapman–Kolmogorov on a finer grid than the lines were polished on, friction by friction."""
    case, mine = shared
    target, plant = case.target_m_s, case.plant
    solution = solve(mine.design, Aim(target, SQUARED_ERROR_ALONE))
    fit = fitted(solution, 3)
    lines = told_lines(mine.design, target, polished(solution, fit).lines, fit.curvature)
    factor, weight = told_factors(plant, 13)
    squares = [mean_square(knowing(mine.check, target, float(each), 2), lines.at(float(each))) for each in factor]
    sample = exit_statistics(run_told(mine.fresh.loop, mine.fresh.draws, by_lines(lines)), target)
    assert sample.rms_m_s == pytest.approx(float(np.sqrt(weight @ np.array(squares))), rel=0.08)


def test_figures_of_a_case_agree_with_one_another(shared: tuple[Case, Class]) -> None:
    case, mine = shared
    plain = plain_table(mine, case.target_m_s, mine.design, mine.config.resolution)
    found = figures_of(mine, case.target_m_s, plain)
    assert 0.95 < found.honesty < 1.05
    assert 0.9 < found.honesty_estimated < 1.1
    assert found.ratio == pytest.approx(found.estimated.rms_m_s / found.table.rms_m_s)
    assert 0.99 < found.regret < 1.3
    assert 0.99 < found.regret_estimated < 1.2
    assert found.told_estimated.rms_m_s < found.told.rms_m_s
    assert found.table.rms_m_s < found.baselines["relay"].rms_m_s
    assert found.best_baseline == "energy rule"
    assert 0.5 < found.table_s < found.estimated_s


@pytest.mark.slow
def test_a_refinement_that_changes_nothing_gives_the_same_bits() -> None:
    config = load_config(None)
    (case,) = named_cases(config, METHOD.smallest.cases)
    found = studied(case, config, 3)
    for refinement in found.refinements:
        assert [level.share for level in refinement.levels] == [2.0, 1.0, 0.5]
        assert refinement.levels[1].own_rms_m_s == found.default_own_rms_m_s
        assert refinement.levels[-1].lines_move_m_s is None
    path, speed, transient, together = (each.levels[0].own_rms_m_s for each in found.refinements)
    assert len({path, speed, transient, together}) == 4
    assert found.check_rms_m_s == pytest.approx(found.halved_check_rms_m_s, rel=0.03)
