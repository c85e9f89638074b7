"""Chains of estimates and of told frictions, and the memory of their passes.

The error of an estimate along the path: found again where it is known, and met by chain and simulator alike.
Passes leave their memory as they found it, so that no evaluation knows of those before it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, RollingResistance
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import design_resolution
from synth.retarder.estimation.estimator_design import decisions, error_of_estimate, estimator_of
from synth.simulation.closed_loop import close_loop
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.any_time.polynomial_surfaces import CUBIC_AND_SLOPE, PolynomialSurfaces
from synth.solver.any_time.sampled_chain import EstimateError, SampledChain, error_along_path, sampled_chain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation
from synth.solver.any_time.surface_polish import NEGLIGIBLE_MASS
from synth.solver.chain.scenarios import Scenarios
from synth.solver.chain.speed_measurement import SmoothMeasurement
from tests.synth.any_time.conftest import tabled
from tests.synth.any_time.test_surfaces import TARGET_M_S, at, falling

AIM = Aim(TARGET_M_S, Criterion())
STD_M_S = 0.05


@pytest.fixture(scope="module")
def spread(plant: Plant) -> Plant:
    """With a running resistance that differs from cut to cut."""
    return replace(plant, resistance=RollingResistance(1.75, 0.5))


@pytest.fixture(scope="module")
def chain(spread: Plant) -> SampledChain:
    return sampled_chain(spread, replace(design_resolution(spread, TARGET_M_S), friction_nodes=2, resistance_nodes=2))


def error(exit_m: float, per_friction: float = 0.0, per_acceleration_s: float = 0.0) -> EstimateError:
    """Noise that grows along the path only where the estimate is shifted, too."""
    growth = 0.0 if per_friction == per_acceleration_s == 0.0 else 0.02
    path = np.array([0.0, exit_m])
    shifts = np.outer([per_friction, per_acceleration_s], [0.5, 1.0])
    return EstimateError(path, STD_M_S + growth * np.array([0.0, 1.0]), *shifts)


def test_without_shifts_it_is_a_sensor_with_this_noise(chain: SampledChain) -> None:
    lines = at(falling(chain.plant), chain)
    as_estimate = replace(chain, estimate=error(chain.plant.exit_m))
    as_sensor = replace(chain, measurement=SmoothMeasurement(STD_M_S))
    a, b = (SurfaceEvaluation(each).gradient(lines, AIM) for each in (as_estimate, as_sensor))
    assert a.cost_m2_s2 == b.cost_m2_s2
    assert a.slopes.tobytes() == b.slopes.tobytes()
    other = replace(chain, estimate=error(chain.plant.exit_m, 0.2, -0.5))
    assert SurfaceEvaluation(other).gradient(lines, AIM).cost_m2_s2 != a.cost_m2_s2


def test_who_reads_too_much_leaves_too_slowly(chain: SampledChain) -> None:
    """By as much as is read too much: the lines of this plant end at the exit."""
    lines = at(falling(chain.plant), chain)
    means = []
    for per_friction in (0.0, 0.3):
        known = error(chain.plant.exit_m, per_friction)
        shifted = replace(known, std_m_s=np.full(2, STD_M_S), per_friction=np.full(2, per_friction))
        scenarios = Scenarios(np.array([1.2]), np.zeros(1), np.ones(1))
        found = SurfaceEvaluation(replace(chain, estimate=shifted, scenarios=scenarios)).density(lines)
        means.append(float(found.probability @ found.speed_m_s))
    moved = SurfaceEvaluation(replace(chain, estimate=error(chain.plant.exit_m), scenarios=scenarios))
    by_lines = moved.density(lines - 0.3 * 0.2)
    assert means[1] < means[0] - 0.02
    assert means[1] == pytest.approx(float(by_lines.probability @ by_lines.speed_m_s), abs=1e-12)


def test_slopes_are_those_of_differences(chain: SampledChain) -> None:
    evaluation = SurfaceEvaluation(replace(chain, estimate=error(chain.plant.exit_m, 0.2, -0.5)))
    lines = at(falling(chain.plant), chain)
    slopes, step = evaluation.gradient(lines, AIM).slopes, 1e-4
    for side in (0, 1):
        up, down = lines.copy(), lines.copy()
        up[side] += step
        down[side] -= step
        costs = [evaluation.gradient(each, AIM).cost_m2_s2 for each in (up, down)]
        finite = np.isfinite(lines[side])
        assert (costs[0] - costs[1]) / (2.0 * step) == pytest.approx(slopes[side][finite].sum(), rel=1e-4)


def test_known_shifts_are_found_again() -> None:
    rng, n = np.random.default_rng(4), 40_000
    path, friction, extra = rng.uniform(0.0, 10.0, n), rng.normal(0.0, 0.15, n), rng.normal(0.0, 0.01, n)
    true = EstimateError(np.array([2.5, 7.5]), np.array([0.03, 0.02]), np.array([0.05, 0.01]), np.array([-0.2, -2.0]))
    late = (path >= 5.0).astype(int)
    observed = true.per_friction[late] * friction + true.per_acceleration_s[late] * extra
    rows = np.column_stack([path, observed + true.std_m_s[late] * rng.normal(size=n), friction, extra, np.ones(n)])
    found = error_along_path(rows, np.array([0.0, 5.0, 10.0]), 0.025)
    assert found.path_m.tolist() == true.path_m.tolist()
    assert found.std_m_s == pytest.approx([0.03, 0.025], rel=0.02)  # the second: no less than asked for
    assert found.per_friction == pytest.approx(true.per_friction, abs=0.005)
    assert found.per_acceleration_s == pytest.approx(true.per_acceleration_s, abs=0.1)
    few = error_along_path(rows[:60], np.array([0.0, 10.0, 20.0]), 0.0)
    assert few.std_m_s[1] == few.std_m_s[0]


def test_other_passes_err_as_was_found(plant_of: Callable[[float], Plant]) -> None:
    """Cuts that roll easily are thought too slow at the end: an estimator learns their resistance by and by."""
    plant = plant_of(36.0)
    stages = plant.top_stage + 1
    coefficients, has_line = np.zeros((stages, 2, 5)), np.ones((stages, 2), dtype=bool)
    coefficients[:, :, 0] = TARGET_M_S + np.array([0.0, 0.4]) + 0.2 * np.arange(stages)[:, None]
    coefficients[:, :, 1], has_line[0, 0], has_line[-1, 1] = -0.4, False, False
    kpa = np.asarray(plant.position.stage_pressures_kpa[:stages])
    flat = PolynomialSurfaces(plant.start_m, plant.exit_m, kpa, CUBIC_AND_SLOPE, coefficients, has_line)
    controller = tabled(plant, flat, estimator_of(plant))
    loop = close_loop(plant, controller.stages)
    found = error_of_estimate(loop, controller, loop.draws(stratified_passes(3, 0, 200)), 0.0)
    draws = loop.draws(stratified_passes(4, 0, 200))
    last, acceleration = [], -plant.cut.reduced_gravity_m_s2 * 1e-3
    for i, passed, decided in decisions(loop, controller, draws):
        late = decided & (passed.path_m > found.path_m[-2])
        if late.any():
            extra = acceleration * (draws.resistance_n_kn[i] - plant.resistance.mean_n_per_kn)
            last.append((extra, float((passed.measured_m_s - passed.speed_m_s)[late].mean())))
    extra, mean_error = np.array(last).T
    slope = float(np.polyfit(extra, mean_error, 1)[0])
    assert found.per_acceleration_s[-1] < -0.2
    assert slope == pytest.approx(found.per_acceleration_s[-1], rel=0.25)


MEMORY_AIM = Aim(3.0, Criterion())


@pytest.fixture(scope="module")
def memory_chain(plant: Plant) -> SampledChain:
    return sampled_chain(plant, design_resolution(plant, 3.0, coarser=2.0))


def level_lines(memory_chain: SampledChain, lower_m_s: float, upper_m_s: float) -> np.ndarray:
    """The same two speeds at every node and mode; no command that a mode does not have."""
    lines = np.empty((2, len(memory_chain.drive_m2_s2) - 1, len(memory_chain.modes.stage)))
    lines[0] = np.where(memory_chain.modes.allowed[:, 0], lower_m_s, -np.inf)
    lines[1] = np.where(memory_chain.modes.allowed[:, 2], upper_m_s, np.inf)
    return lines


def test_memory_is_zeros_between_passes(memory_chain: SampledChain) -> None:
    evaluation = SurfaceEvaluation(memory_chain, threads=2)
    evaluation.gradient(level_lines(memory_chain, 3.0, 3.2), MEMORY_AIM)
    evaluation.density(level_lines(memory_chain, 2.0, 4.0))
    assert 1 <= len(evaluation.free) <= 2
    for memory in evaluation.free:
        assert not memory.heading.any()
        assert not memory.here.any()


def test_an_evaluation_after_others_has_the_bits_of_a_first_one(memory_chain: SampledChain) -> None:
    lines, used = level_lines(memory_chain, 3.0, 3.2), SurfaceEvaluation(memory_chain)
    for other in ((1.0, 1.5), (4.0, 6.0)):
        used.gradient(level_lines(memory_chain, *other), MEMORY_AIM)
    again, first = used.gradient(lines, MEMORY_AIM), SurfaceEvaluation(memory_chain).gradient(lines, MEMORY_AIM)
    assert again.cost_m2_s2 == first.cost_m2_s2
    assert np.array_equal(again.slopes, first.slopes)
    assert np.array_equal(again.bends, first.bends)
    assert np.array_equal(used.density(lines).probability, SurfaceEvaluation(memory_chain).density(lines).probability)


def test_leaving_out_more_costs_less_than_a_polish_can_tell(memory_chain: SampledChain) -> None:
    lines = level_lines(memory_chain, 3.0, 3.2)
    exact, coarse = (
        SurfaceEvaluation(memory_chain, negligible_mass=m).gradient(lines, MEMORY_AIM) for m in (1e-12, NEGLIGIBLE_MASS)
    )
    assert coarse.cost_m2_s2 == pytest.approx(exact.cost_m2_s2, rel=1e-4)
    assert coarse.cost_m2_s2 != exact.cost_m2_s2
