"""Surfaces: what they promise, and surfaces for a told friction.

What surfaces promise: against simulated passes, against the stage-locked solver, against their own differences.
Surfaces for a regulator that is told the friction: each is best at its own, and between them they are joined.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, Pneumatics
from plant_models.track_profile import Approach
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution, design_resolution
from synth.simulation.closed_loop import close_loop
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.any_time.polynomial_surfaces import CUBIC_ALONE, CUBIC_AND_SLOPE, PolynomialSurfaces
from synth.solver.any_time.sampled_chain import SampledChain, check_sampled_chain, sampled_chain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation
from synth.solver.any_time.surface_polish import ToldSurfaces, least_gap, polish_surfaces, told_surfaces
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain, known_factors, persistent_chain
from synth.solver.descent import Descent
from synth.solver.evaluation import exit_density
from synth.solver.switching_lines import MINIMUM_GAP_M_S
from synth.solver.told_lines import SQUARED_ERROR_ALONE
from tests.synth.any_time.conftest import at_rest_only, short_plant, tabled

Polished = Descent[PolynomialSurfaces]
TARGET_M_S = 3.0
AIM = Aim(TARGET_M_S, Criterion())
PRICED = Aim(TARGET_M_S, Criterion(time_price_m2_s3=0.01))
KNOWN = Resolution(path_step_m=0.15, speed_step_m_s=0.01, friction_nodes=1, resistance_nodes=1)


def one_stage_a_command(chain: Chain) -> Chain:
    """As surfaces command."""
    return replace(chain, decisions=replace(chain.decisions, farthest=1))


def falling(plant: Plant, slope_m_s: float = 0.03) -> PolynomialSurfaces:
    """Surfaces that fall along the path towards the target."""
    coefficients = np.zeros((3, 2, 5))
    coefficients[:, :, 0] = TARGET_M_S + np.array([0.15, 0.35])
    coefficients[:, :, 1], coefficients[:, :, 2], coefficients[:, :, 4] = -0.25, 0.05, slope_m_s
    has_line = np.array([[False, True], [True, True], [True, False]])
    stages = np.asarray(plant.position.stage_pressures_kpa)
    return PolynomialSurfaces(plant.start_m, plant.exit_m, stages, CUBIC_AND_SLOPE, coefficients, has_line)


@pytest.fixture(scope="module")
def chain(plant: Plant) -> SampledChain:
    return sampled_chain(plant, design_resolution(plant, TARGET_M_S))


@pytest.fixture(scope="module")
def polish(plant: Plant, chain: SampledChain) -> Polished:
    return polish_surfaces(falling(plant), SurfaceEvaluation(chain, 2), AIM)


def at(surfaces: PolynomialSurfaces, chain: SampledChain) -> np.ndarray:
    return surfaces.at(chain.grid.path_m[:-1], chain.modes)


def test_cost_by_values_is_cost_by_density(plant: Plant, chain: SampledChain) -> None:
    evaluation, lines = SurfaceEvaluation(chain), at(falling(plant), chain)
    density = evaluation.density(lines)
    exits, stalled = AIM.criterion.exit_costs(chain.grid.speed_m_s, TARGET_M_S)
    price = AIM.criterion.switching_tolerance_m2_s2 * density.switchings
    cost = float(density.probability @ exits) + density.stalled * stalled + price
    assert evaluation.gradient(lines, AIM).cost_m2_s2 == pytest.approx(cost, abs=1e-9)
    assert density.probability.sum() + density.stalled == pytest.approx(1.0, abs=1e-8)
    assert density.escaped < 1e-12


@pytest.mark.parametrize("aim", [AIM, PRICED])
def test_slopes_and_bends_are_those_of_differences(plant: Plant, chain: SampledChain, aim: Aim) -> None:
    evaluation, surfaces = SurfaceEvaluation(chain), falling(plant)
    lines = at(surfaces, chain)
    found = evaluation.gradient(lines, aim)
    for side, stage, h in ((0, 1, 1e-4), (1, 0, 1e-4), (1, 1, 1e-4), (0, 2, 1e-4)):
        moved = np.zeros(lines.shape)
        moved[side][:, chain.modes.stage == stage] = 1.0
        above, below = (evaluation.gradient(lines + sign * h * moved, aim).cost_m2_s2 for sign in (1.0, -1.0))
        assert (found.slopes * moved).sum() == pytest.approx((above - below) / (2.0 * h), rel=3e-5)
    most = np.unravel_index(np.argmax(np.abs(found.bends)), lines.shape)
    one = np.zeros(lines.shape)
    one[most] = 1e-2
    above, below = (evaluation.gradient(lines + sign * one, aim).slopes[most] for sign in (1.0, -1.0))
    assert found.bends[most] == pytest.approx((above - below) / 2e-2, rel=0.02)


@pytest.mark.requirement("PRED-02")
@pytest.mark.parametrize("ahead_m", [0.0, 3.0])
def test_a_prediction_is_what_passes_find(plant: Plant, ahead_m: float) -> None:
    """From the entrance and from before it, where a stage may be set and no higher one."""
    placed = replace(plant, approach=Approach(ahead_m, 1, 1)) if ahead_m else plant
    check = check_sampled_chain(placed, design_resolution(placed, TARGET_M_S))
    surfaces = falling(placed)
    density = SurfaceEvaluation(check, 2).density(at(surfaces, check))
    loop = close_loop(placed, placed.position.top_stage + 1)
    sample = loop.run(tabled(placed, surfaces), loop.draws(stratified_passes(21, 0, 20_000)))
    found = exit_statistics(sample, TARGET_M_S)
    low, high = found.rms_ci95_m_s
    assert 0.99 * low < density.rms_m_s(TARGET_M_S) < 1.01 * high
    assert density.bias_m_s(TARGET_M_S) == pytest.approx(found.bias_m_s, abs=0.004)
    assert density.switchings == pytest.approx(found.switchings, rel=0.03)
    free, priced = (SurfaceEvaluation(check, 2).gradient(at(surfaces, check), aim).cost_m2_s2 for aim in (AIM, PRICED))
    time_s, transit = (priced - free) / PRICED.criterion.time_price_m2_s3, sample.transit_time_s
    assert time_s == pytest.approx(float(np.average(transit, weights=sample.weight)), rel=2e-3)


def test_without_transients_locked_lines_cost_what_the_locked_solver_says(plant: Plant) -> None:
    """Every change of stage ends within its period: nothing can be commanded on its way."""
    valves = Pneumatics(700.0, 0.0, 0.002, 0.004, 0.002, 0.006, 0.006, 15.0)
    quick = replace(plant, position=replace(plant.position, pneumatics=valves))
    resolution = replace(KNOWN, path_step_m=0.15, speed_step_m_s=0.02)
    here = sampled_chain(quick, resolution)
    assert here.modes.rests.all()
    locked = one_stage_a_command(persistent_chain(quick, resolution))
    solution = solve(locked, AIM)
    theirs = exit_density(locked, solution.lines)
    same = SurfaceEvaluation(here).density(at_rest_only(solution.lines, here.modes))
    assert same.rms_m_s(TARGET_M_S) == pytest.approx(theirs.rms_m_s(TARGET_M_S), rel=0.02)


def test_a_polish_lowers_the_cost_that_passes_find(plant: Plant, polish: Polished) -> None:
    loop = close_loop(plant, plant.position.top_stage + 1)
    draws = loop.draws(stratified_passes(22, 0, 20_000))
    before, after = (
        exit_statistics(loop.run(tabled(plant, each), draws), TARGET_M_S) for each in (falling(plant), polish.best)
    )
    assert polish.converged
    assert polish.evaluations <= 40
    assert polish.cost_after < polish.cost_before
    assert after.rms_ci95_m_s[1] < before.rms_ci95_m_s[0]


def test_polished_surfaces_keep_their_order_at_all_pressures(polish: Polished, chain: SampledChain) -> None:
    lower, upper = at(polish.best, chain)
    assert (upper - lower).min() >= 0.0399


def test_a_regulator_without_gauge_gains_less(plant: Plant, chain: SampledChain, polish: Polished) -> None:
    """Cubics alone are among cubics with a slope."""
    start = falling(plant, 0.0)
    bare = replace(start, degrees=CUBIC_ALONE, coefficients=start.coefficients[:, :, :4].copy())
    found = polish_surfaces(bare, SurfaceEvaluation(chain, 2), AIM)
    assert polish.cost_after < found.cost_after * 1.001


def test_a_retarder_of_one_stage_has_no_pairs_and_is_polished_too() -> None:
    plant = short_plant((0.0, 250.0))
    coefficients = np.zeros((2, 2, 5))
    coefficients[:, :, 0], coefficients[:, :, 1] = TARGET_M_S + np.array([0.05, 0.35]), -0.25
    has_line = np.array([[False, True], [True, False]])
    start = PolynomialSurfaces(0.0, plant.exit_m, np.array([0.0, 250.0]), CUBIC_AND_SLOPE, coefficients, has_line)
    chain = sampled_chain(plant, design_resolution(plant, TARGET_M_S))
    found = polish_surfaces(start, SurfaceEvaluation(chain, 2), AIM)
    assert found.cost_after < 0.9 * found.cost_before
    draws = close_loop(plant, plant.position.top_stage + 1).draws(stratified_passes(23, 0, 20_000))
    before, after = (
        exit_statistics(
            close_loop(plant, plant.position.top_stage + 1).run(tabled(plant, each), draws), TARGET_M_S
        ).rms_m_s
        for each in (start, found.best)
    )
    assert after < before


@pytest.mark.parametrize("threads", [2, 4])
def test_threads_change_no_bit(plant: Plant, chain: SampledChain, threads: int) -> None:
    lines = at(falling(plant), chain)
    one, many = (SurfaceEvaluation(chain, each).gradient(lines, AIM) for each in (1, threads))
    assert one.cost_m2_s2 == many.cost_m2_s2
    assert (one.slopes == many.slopes).all()
    assert (one.bends == many.bends).all()
    assert one.slopes.any()


def test_halving_all_steps_changes_the_prediction_little(plant: Plant, polish: Polished) -> None:
    design = design_resolution(plant, TARGET_M_S)
    finer = replace(design, path_step_m=0.5 * design.path_step_m, speed_step_m_s=0.5 * design.speed_step_m_s)
    rms = []
    for resolution, kpa in ((design, 30.0), (finer, 30.0), (finer, 15.0)):
        each = sampled_chain(plant, resolution, pressure_step_kpa=kpa)
        rms.append(SurfaceEvaluation(each, 2).density(at(polish.best, each)).rms_m_s(TARGET_M_S))
    assert rms[0] == pytest.approx(rms[1], rel=0.02)
    assert rms[1] == pytest.approx(rms[2], rel=0.01)


@pytest.fixture(scope="module")
def design(plant: Plant) -> SampledChain:
    return sampled_chain(plant, design_resolution(plant, TARGET_M_S))


@pytest.fixture(scope="module")
def told(plant: Plant, design: SampledChain) -> ToldSurfaces:
    """From surfaces that are polished for all frictions."""
    common = polish_surfaces(falling(plant), SurfaceEvaluation(design, 2), AIM).best
    found = told_surfaces(design, TARGET_M_S, common)
    return ToldSurfaces(found.factor, found.surfaces)


def cost(design: SampledChain, told: ToldSurfaces, at: float, factor: float) -> float:
    """Of the surfaces for friction `at`, where the friction is `factor`."""
    known = replace(design, scenarios=known_factors(design.plant, np.array([factor]), 1))
    lines = told.at(at).at(design.grid.path_m[:-1], design.modes)
    return SurfaceEvaluation(known).gradient(lines, Aim(TARGET_M_S, SQUARED_ERROR_ALONE)).cost_m2_s2


def test_at_each_friction_its_own_surfaces_are_best(design: SampledChain, told: ToldSurfaces) -> None:
    for factor, other in ((0.85, 1.15), (1.15, 0.85), (1.0, 1.3)):
        assert cost(design, told, factor, factor) < cost(design, told, other, factor)


def test_between_two_frictions_surfaces_are_joined_and_keep_their_distance(told: ToldSurfaces) -> None:
    low, high = told.factor[3:5]
    middle = told.at(float(0.5 * (low + high)))
    mean = 0.5 * (told.surfaces[3].coefficients + told.surfaces[4].coefficients)
    assert middle.coefficients == pytest.approx(mean)
    assert (told.at(0.0).coefficients == told.surfaces[0].coefficients).all()
    assert (told.at(9.0).coefficients == told.surfaces[-1].coefficients).all()
    for factor in np.linspace(0.3, 1.7, 15):
        assert least_gap(told.at(float(factor))).min() >= MINIMUM_GAP_M_S - 1e-9
