"""Designs whose grid is not believed are done again, and what is left is told."""

from __future__ import annotations

from dataclasses import replace

import pytest

import synth
from plant_models import PlantError
from synth.problem.problem import Problem
from synth.problem.resolution import Resolution, finer_for_check
from synth.retarder import checked_design
from synth.retarder.checked_design import CheckedDesign, design_of
from synth.retarder.rounded_table import PredictedTable, with_prediction
from synth.retarder.tuned_case import GridCheck
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.coarse_grid import CoarseGridError
from synth.solver.polynomial_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from tests.synth.case_factory import make_case
from tuning_tables import Generator

FEW_FRICTIONS = Resolution(path_step_m=1.0, speed_step_m_s=0.06, friction_nodes=2, resistance_nodes=1)
ENOUGH = Resolution()


@pytest.fixture(scope="module")
def problem() -> Problem:
    return synth.load_problem("gondola-4-52t", target_m_s=2.0)


def designs(problem: Problem, resolution: Resolution) -> tuple[Solution, Chain]:
    """A solution, and the chain that its lines are checked on."""
    chain = persistent_chain(problem.plant, resolution)
    return solve(chain, problem.aim), check_chain(problem.plant, finer_for_check(resolution))


def judge(lines: PolynomialLines) -> PredictedTable:
    """The table of the lines, predicted on the grid for checks."""
    plant = synth.load_problem("gondola-4-52t", target_m_s=2.0).plant
    origin = Generator("test", "0", "0" * 64), "t", "2026-01-01T00:00:00Z"
    check = check_chain(plant, finer_for_check(ENOUGH))
    return with_prediction(check, tabulate(plant, lines, 2.0, UNPREDICTED, *origin))


def test_a_design_that_both_grids_agree_on_is_taken(problem: Problem) -> None:
    found = checked_design.checked_design(*designs(problem, ENOUGH), 3, judge)
    assert found.grid.is_believed
    assert not found.grid.again
    assert found.grid.independent_rms_m_s == found.verdict.table.predicted.rms_m_s


@pytest.mark.long
def test_lines_that_live_on_their_scenarios_are_designed_again(problem: Problem) -> None:
    """Two frictions can be told apart by few samples: on their grid the lines cost next to nothing."""
    solution, check = designs(problem, FEW_FRICTIONS)
    first = design_of(solution, check, 3, judge, again=False)
    assert first.grid.share < 0.5
    second = checked_design.checked_design(solution, check, 3, judge)
    assert second.grid.again
    assert second.grid.is_believed
    assert second.verdict.rms_m_s < first.verdict.rms_m_s


@pytest.mark.long
def test_a_grid_too_coarse_for_lines_is_made_finer(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    solution, check = designs(problem, ENOUGH)

    def coarse(at: Solution, *others: object, again: bool) -> CheckedDesign[PredictedTable]:
        if at is solution:
            raise CoarseGridError("too coarse")
        return design_of(at, check, 3, judge, again)

    monkeypatch.setattr(checked_design, "design_of", coarse)
    assert checked_design.checked_design(solution, check, 3, judge).grid.again

    def always(at: Solution, *others: object, again: bool) -> CheckedDesign[PredictedTable]:
        raise CoarseGridError("too coarse")

    monkeypatch.setattr(checked_design, "design_of", always)
    with pytest.raises(PlantError, match="too coarse"):
        checked_design.checked_design(solution, check, 3, judge)


@pytest.mark.parametrize(
    ("design", "finer", "believed"),
    [(0.03, 0.03, True), (0.0, 0.03, False), (0.03, 0.02, False), (0.0, 0.0, True),
     (0.8, 1.0, True), (1.25, 1.0, True), (0.79, 1.0, False), (1.26, 1.0, False)],
)  # fmt: skip
def test_what_is_believed(design: float, finer: float, believed: bool) -> None:
    assert GridCheck(design, finer, again=False, most_off=1.25).is_believed is believed


def test_a_grid_that_is_not_believed_is_a_warning_of_its_case() -> None:
    case = make_case()
    assert case.warnings == ()
    doubtful = replace(case, grid=GridCheck(0.0123, 0.0345, again=True, most_off=1.25))
    (warning,) = doubtful.warnings
    assert warning.startswith("on the grid of its design the rms is 0.0123 m/s, without it 0.0345")
