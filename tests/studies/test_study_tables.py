"""The tables and references that studies measure are those of a tune, and two ways to the same figure agree."""

from __future__ import annotations

import numpy as np
import pytest

from scripts.studies.cases import named_cases
from scripts.studies.tuned_table import CREATED, tuned_table
from synth.problem.aim import Aim
from synth.problem.resolution import finer_for_check
from synth.retarder.class_setup import class_setup, origin_of
from synth.retarder.comparison.told_regulator import by_lines, run_told
from synth.retarder.configuration.config_file import load_config, parse_config
from synth.retarder.tuned_table import solutions
from synth.retarder.tuned_table import tuned_table as tuned_table_of_a_tune
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import check_chain, persistent_chain
from synth.solver.one_blas_thread import one_blas_thread
from synth.solver.told_lines import SQUARED_ERROR_ALONE, knowing, mean_square, told_factors, told_lines
from synth.solver.tuned_lines import fitted, polished


@pytest.mark.long
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


@pytest.mark.long
def test_what_is_told_is_simulated_as_the_check_grid_predicts() -> None:
    """Passes in time, and Chapman–Kolmogorov on a finer grid than the lines were polished on, friction by friction."""
    config = load_config(None)
    (case,) = named_cases(config, ("52:3",))
    target, plant = case.target_m_s, case.plant
    design, check = persistent_chain(plant, config.resolution), check_chain(plant, finer_for_check(config.resolution))
    fresh = common_passes(plant, stratified_passes(1, 0, 5000))
    solution = solve(design, Aim(target, SQUARED_ERROR_ALONE))
    fit = fitted(solution, 3)
    lines = told_lines(design, target, polished(solution, fit).best, fit.curvature)
    factor, weight = told_factors(plant, 13)
    squares = [mean_square(knowing(check, target, float(each), 2), lines.at(float(each))) for each in factor]
    sample = exit_statistics(run_told(fresh.loop, fresh.draws, by_lines(lines)), target)
    assert sample.rms_m_s == pytest.approx(float(np.sqrt(weight @ np.array(squares))), rel=0.08)
