"""Designs of lines: rounds, days, doubts and baselines.

The rounds of a polish.
Days of another mean friction: the cuts of one are of a plant with that mean, all together those of any day.
Designs whose grid is not believed are done again, and what is left is told.
Baselines: the energy rule's lines lead to the target, and tuning finds members worth comparing with.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import synth
from plant_models import Friction, Plant, PlantError
from synth.kernels.loop.motion import LEFT, advance
from synth.problem.problem import Aim, Problem
from synth.problem.resolution import Resolution, finer_for_check
from synth.retarder import checked_design
from synth.retarder.checked_design import CheckedDesign, design_of
from synth.retarder.comparison.baselines import FAMILIES, TunedBaseline, energy_rule, relay, tune_baselines
from synth.retarder.estimation.tuning_days import tuning_days, tuning_row
from synth.retarder.tuned_case import GridCheck
from synth.retarder.tuned_table import PredictedTable, with_prediction
from synth.simulation.closed_loop import LineController, close_loop, simulate
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import PATH_CELLS, RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.descent import CoarseGridError
from synth.solver.evaluation import Gradient
from synth.solver.switching_lines import PolynomialLines, SwitchingLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from synth.solver.tuned_lines import cost_at_full_brake, remembering
from tests.synth.case_factory import make_case
from tuning_tables import Generator


def test_the_same_lines_are_evaluated_once() -> None:
    """Equal lines have the answer of before, others their own: lower and upper lines are not taken for one another."""
    asked: list[SwitchingLines] = []

    def evaluate(lines: SwitchingLines) -> Gradient:
        asked.append(lines)
        return float(len(asked)), lines.lower_m_s

    def lines(lower: float, upper: float) -> SwitchingLines:
        return SwitchingLines(np.zeros(1), np.full((2, 1), lower), np.full((2, 1), upper))

    answer = remembering(evaluate)
    costs = [answer(lines(*each))[0] for each in ((1.0, 2.0), (2.0, 1.0), (1.0, 2.0), (1.0, 2.0 + 1e-12), (2.0, 1.0))]
    assert costs == [1.0, 2.0, 1.0, 3.0, 2.0]
    assert len(asked) == 3


def test_what_no_lines_avoid_is_what_passes_at_full_brake_cost(plant_of: Callable[[float], Plant]) -> None:
    """The recursion at the highest stage all the way against simulated passes; nothing for a cut that it stops."""
    heavy, light = plant_of(85.0), plant_of(22.0)
    found = cost_at_full_brake(check_chain(heavy, finer_for_check(Resolution())), Aim(2.0))
    slowest = common_passes(heavy, stratified_passes(5, 0, 20_000)).at_full_brake
    excess = np.maximum(slowest.exit_speed_m_s - 2.0, 0.0)
    assert found == pytest.approx(np.average(excess**2, weights=slowest.weight), rel=0.05)
    assert found > 0.01
    assert cost_at_full_brake(persistent_chain(light, Resolution(friction_nodes=4)), Aim(3.0)) < 1e-6


LOW_DAY, HIGH_DAY = 1.0 - np.sqrt(3.0) * 0.1, 1.0 + np.sqrt(3.0) * 0.1


def with_mean_cv(plant: Plant, mean_cv: float) -> Plant:
    return replace(plant, friction=replace(plant.friction, mean_cv=mean_cv))


def some_lines(plant: Plant) -> LineController:
    upper = np.linspace(4.5, 3.2, 5) + 0.3 * np.arange(plant.top_stage + 1)[:, None]
    lower = upper - 0.8
    lower[0], upper[-1] = -np.inf, np.inf
    return LineController(SwitchingLines(np.linspace(0.0, plant.exit_m, 5), lower, upper))


def test_a_known_mean_has_one_day_and_its_passes_to_the_bit(plant_52t: Plant) -> None:
    passes = random_passes(3, 0, 300)
    days = tuning_days(plant_52t, passes)
    asked = close_loop(plant_52t, plant_52t.top_stage + 1).draws(passes)
    assert days.weight.tolist() == [1.0]
    (found,) = days.draws
    for name, values in zip(asked._fields, asked, strict=True):
        np.testing.assert_array_equal(getattr(found, name), values)


def test_a_day_has_the_cuts_of_its_mean_and_all_days_those_of_any_day(plant_52t: Plant) -> None:
    """The mixture of the days has the moments of N(1, CV² + mean_cv²) up to the fourth (Gauss–Hermite, three nodes)."""
    plant = with_mean_cv(plant_52t, 0.1)
    passes = stratified_passes(4, 0, 60_000)
    days = tuning_days(plant, passes)
    by_day = [(np.asarray(d.cut_factor), np.asarray(d.weight) / np.asarray(d.weight).sum()) for d in days.draws]
    means = [float(w @ factor) for factor, w in by_day]
    assert means == pytest.approx([LOW_DAY, 1.0, HIGH_DAY], abs=2e-3)
    for (factor, w), mean in zip(by_day, means, strict=True):
        assert np.sqrt(w @ (factor - mean) ** 2) == pytest.approx(0.15, rel=0.01)
    moments = [sum(q * (w @ (f - 1.0) ** k) for q, (f, w) in zip(days.weight, by_day, strict=True)) for k in (2, 4)]
    whole = 0.15**2 + 0.1**2
    assert moments == pytest.approx([whole, 3.0 * whole**2], rel=0.02)


def test_without_spread_a_day_is_a_plant_of_that_friction(plant_52t: Plant) -> None:
    """The mean square of a day is that of passes whose friction is told to the simulator."""
    plant = with_mean_cv(replace(plant_52t, friction=Friction(0.0, 0.0, 0.1, 2.0)), 0.1)
    passes, lines = random_passes(5, 0, 600), some_lines(plant_52t)
    found = tuning_days(plant, passes).mean_squares(lines, 3.0)
    for day, factor in enumerate((LOW_DAY, 1.0, HIGH_DAY)):
        told = simulate(plant, lines, passes.part(200 * day, 200 * day + 200), cut_factor=float(factor))
        assert found[day] == pytest.approx(np.mean((told.exit_speed_m_s - 3.0) ** 2), rel=1e-9)


def test_rare_cuts_of_low_friction_count_where_the_mean_is_uncertain(plant_52t: Plant) -> None:
    plain = tuning_row(plant_52t.friction)(7, 0, 200, PATH_CELLS)
    strata = tuning_row(with_mean_cv(plant_52t, 0.1).friction)(7, 0, 200, PATH_CELLS)
    assert (plain.weight == 1.0).all()
    assert (strata.cut_z < -2.0).mean() > 0.2
    assert strata.weight @ (strata.cut_z < -2.0) / 200 == pytest.approx(0.0228, abs=0.02)


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


TARGET_M_S = 3.0


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(seed=5, first_pass=0, count=400)


@pytest.fixture(scope="module")
def tuned(plant_52t: Plant, passes: RandomPasses) -> dict[str, TunedBaseline]:
    return {baseline.name: baseline for baseline in tune_baselines(common_passes(plant_52t, passes), TARGET_M_S)}


@pytest.mark.parametrize("stage", [0, 1, 2, 3])
def test_a_cut_on_the_energy_line_leaves_with_the_target(plant_52t: Plant, stage: int) -> None:
    loop = close_loop(plant_52t, 5)
    friction = 0.9
    lines = energy_rule(loop, TARGET_M_S, 4, friction, 0.1, 0.0, 0.2).lines
    path = loop.path
    free = path.gravity_m_s2 - path.drag_m_s2_per_n_kn * plant_52t.resistance.mean_n_per_kn
    brake = friction * path.brake_m_s2_per_kpa
    kpa = loop.stage_overpressures_kpa[stage]
    entry = lines.upper_m_s[stage, 0]
    *_, speed, _, status = advance(path.edges_m, free, brake, kpa, 1e3, 0, 0.0, entry)
    assert status == LEFT
    assert speed == pytest.approx(TARGET_M_S + 0.1, abs=1e-9)
    assert lines.lower_m_s[stage + 1] == pytest.approx(lines.upper_m_s[stage] - 0.2)


def test_thresholds_jump_to_their_stage_and_back(plant_52t: Plant) -> None:
    loop = close_loop(plant_52t, 5)
    lines = relay(loop, TARGET_M_S, 3, 0.1, 0.2).lines
    assert np.all(lines.upper_m_s[:3] == pytest.approx(3.3))
    assert np.all(np.isposinf(lines.upper_m_s[3:]))
    assert np.all(lines.lower_m_s[1:] == pytest.approx(3.1))
    assert np.all(np.isneginf(lines.lower_m_s[0]))


def test_tuning_is_deterministic_and_reports_what_it_reached(
    plant_52t: Plant, passes: RandomPasses, tuned: dict[str, TunedBaseline]
) -> None:
    assert list(tuned) == [family.name for family in FAMILIES]
    again = {baseline.name: baseline for baseline in tune_baselines(common_passes(plant_52t, passes), TARGET_M_S)}
    for name, baseline in tuned.items():
        figures = exit_statistics(simulate(plant_52t, baseline.controller, passes), TARGET_M_S)
        assert figures.rms_m_s == pytest.approx(
            baseline.rms_m_s, rel=1e-12
        )  # sums of other lengths end in other last bits
        assert again[name].parameters == baseline.parameters


def test_richer_laws_are_no_worse_and_all_are_sensible(tuned: dict[str, TunedBaseline]) -> None:
    assert tuned["relay"].rms_m_s < 0.2
    assert tuned["energy rule"].rms_m_s < 0.7 * tuned["relay"].rms_m_s


def test_tuned_baseline_holds_on_fresh_passes(plant_52t: Plant, tuned: dict[str, TunedBaseline]) -> None:
    fresh = random_passes(seed=6, first_pass=0, count=4000)
    for baseline in tuned.values():
        figures = exit_statistics(simulate(plant_52t, baseline.controller, fresh), TARGET_M_S)
        assert figures.rms_m_s < 1.4 * baseline.rms_m_s
