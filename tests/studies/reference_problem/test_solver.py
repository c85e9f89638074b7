"""The reference problem: the published solution, a plain-numpy oracle, equal bytes, and threads that do not come."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import numba
import numpy as np
import pytest
from numpy.typing import NDArray

from synth.studies.reference_problem.by_numpy import backward, largest_regret, solve_by_numpy
from synth.studies.reference_problem.by_plain_loops import solve_by_plain_loops
from synth.studies.reference_problem.by_quantecon import quantecon_is_there, solve_by_quantecon
from synth.studies.reference_problem.by_scipy import solve_by_scipy, solve_targets_by_scipy
from synth.studies.reference_problem.kernels.shared_work import fetch_add, finish, take, wait
from synth.studies.reference_problem.operator_work import operator_work
from synth.studies.reference_problem.problem import ReferenceProblem, batch_of_16
from synth.studies.reference_problem.solver import ReferenceSolution, ReferenceSolver

Words = NDArray[np.int64]
INTERPRETED = bool(numba.config.DISABLE_JIT)  # type: ignore[attr-defined]  # numba sets it when it is loaded

pytestmark = pytest.mark.skipif(INTERPRETED, reason="LLVM vectors exist only in compiled kernels")

EXCERPT = np.load(Path(__file__).with_name("reference_excerpt.npz"))
"""Every fourth pressure and every tenth speed of the solution that was published with the problem (float64)."""

TOLERANCE = 1e-5


def small_problem(seed: int, coarsest: int = 30) -> ReferenceProblem:
    """Sizes that no vector width and no group of pressures divides; brakes and noise up to clipping on both sides.

    Costs of the published size, up to 16 m²/s²; `coarsest` is the least number of speeds.
    """
    rng = np.random.default_rng(seed)
    return ReferenceProblem(
        target_speed_m_s=float(rng.uniform(2.0, 4.5)),
        braking_m_s2_per_kpa=float(rng.uniform(1e-3, 9e-3)),
        mean_resistance=float(rng.uniform(-0.03, 0.02)),
        stages=int(rng.integers(1, 20)),
        pressure_points=int(rng.integers(2, 26)),
        speed_points=int(rng.integers(coarsest, 75)),
        lowest_speed_m_s=float(rng.uniform(0.2, 1.0)),
        highest_speed_m_s=float(rng.uniform(5.0, 6.0)),
        commands=int(rng.integers(1, 6)),
        friction_std=float(rng.uniform(0.0, 0.2)),
        friction_nodes=int(rng.integers(1, 8)),
        resistance_nodes=int(rng.integers(1, 5)),
    )


def same_bytes(one: ReferenceSolution, other: ReferenceSolution) -> bool:
    return all(
        np.array_equal(a.view(np.uint8), b.view(np.uint8))
        for a, b in (
            (one.value_at_entry, other.value_at_entry),
            (np.ascontiguousarray(one.best_command), np.ascontiguousarray(other.best_command)),
        )
    )


@pytest.mark.parametrize(("stages", "published"), [(120, "value_at_entry"), (60, "value_mid")])
def test_value_is_the_published_one(stages: int, published: str) -> None:
    problem = ReferenceProblem(stages=stages)
    with ReferenceSolver(2) as solver:
        value = solver.solve(problem).value_at_entry
    assert np.abs(value[::4, ::10] - EXCERPT[published]).max() < TOLERANCE
    assert np.abs(value - solve_by_scipy(problem)[0]).max() < TOLERANCE


def test_oracle_is_the_published_solution() -> None:
    problem = ReferenceProblem(stages=60)
    assert np.abs(solve_by_scipy(problem)[0][::4, ::10] - EXCERPT["value_mid"]).max() < 1e-12


def test_policy_of_the_whole_problem_has_no_regret() -> None:
    problem = ReferenceProblem()
    with ReferenceSolver(1) as solver:
        commands = solver.solve(problem).best_command
    assert largest_regret(problem, commands) < TOLERANCE


def test_a_single_wrong_command_has_regret() -> None:
    problem = ReferenceProblem(stages=2)
    expected, value = next(backward(problem))
    state = np.unravel_index(np.argmax(expected[4] - value), value.shape)
    wrong = solve_by_numpy(problem)[1]
    assert largest_regret(problem, wrong) == 0.0
    wrong[1][state] = 4
    assert largest_regret(problem, wrong) == float((expected[4] - value)[state]) > 0.01


@pytest.mark.parametrize("seed", range(40))
def test_small_problems_of_any_shape_agree_with_the_oracle(seed: int) -> None:
    problem = small_problem(seed)
    with ReferenceSolver(2) as solver:
        solution = solver.solve(problem)
    value, _ = solve_by_numpy(problem)
    assert np.abs(solution.value_at_entry - value).max() < TOLERANCE
    assert largest_regret(problem, solution.best_command) < TOLERANCE


@pytest.mark.parametrize("seed", range(200, 215))
def test_coarse_grids_agree_with_the_oracle_as_far_as_float32_goes(seed: int) -> None:
    """Few speeds far apart: rounding of a landing, 2⁻²² of a cell or so, weighs with the difference of neighbours."""
    problem = small_problem(seed, coarsest=2)
    with ReferenceSolver(2) as solver:
        solution = solver.solve(problem)
    value, _ = solve_by_numpy(problem)
    steepest = np.abs(np.diff(problem.terminal_cost)).max()
    assert np.abs(solution.value_at_entry - value).max() < TOLERANCE + problem.stages * 2.0**-22 * steepest
    assert largest_regret(problem, solution.best_command) < TOLERANCE


def test_same_bytes_for_any_number_of_threads_alone_and_in_a_batch() -> None:
    batch = [replace(problem, stages=9) for problem in batch_of_16()]
    with ReferenceSolver(1) as one, ReferenceSolver(2) as two, ReferenceSolver(4) as four:
        alone = [one.solve(problem) for problem in batch]
        for solver in (two, four):
            assert all(map(same_bytes, alone, [solver.solve(problem) for problem in batch]))
        for solver in (one, two, four):
            assert all(map(same_bytes, alone, solver.solve_batch(batch)))
            three = [replace(batch[0], target_speed_m_s=speed) for speed in (2.0, 3.0, 5.0)]
            assert all(map(same_bytes, [one.solve(problem) for problem in three], solver.solve_batch(three)))


def test_solution_of_the_batch_is_right() -> None:
    problem = replace(batch_of_16()[13], stages=30)
    with ReferenceSolver(2) as solver:
        value = solver.solve_batch([problem])[0].value_at_entry
    assert np.abs(value - solve_by_scipy(problem)[0]).max() < TOLERANCE


def test_helpers_that_never_come_hang_nobody() -> None:
    """All threads of the pool are held up, so that only the caller's thread works."""
    problem, release = ReferenceProblem(stages=5), Event()
    with ReferenceSolver(3) as solver:
        expected = solver.solve(problem)
        held = [solver._pool.submit(release.wait, 60.0) for _ in range(3)]
        try:
            assert same_bytes(solver.solve(problem), expected)
        finally:
            release.set()
        assert all(future.result() for future in held)


def test_every_chunk_is_taken_once() -> None:
    def takers(taken: Words, done: Words, order: Words) -> tuple[int, int]:
        for turn in range(order.shape[0]):
            order[turn] = take(taken, 1, turn % 2, 3, order.shape[0])
            finish(done, 1)
        wait(done, 1, order.shape[0])
        return take(taken, 1, 2, 3, order.shape[0]), fetch_add(done, 8, 5)

    taken, done, order = np.zeros(2 * 3 * 8, np.int64), np.zeros(2 * 8, np.int64), np.empty(10, np.int64)
    compiled: Any = numba.njit(takers)
    assert compiled(taken, done, order) == (-1, 10)
    assert sorted(order) == list(range(10))
    assert list(order[:2]) == [0, 1], "own chunks come first"
    assert done[8] == 15


def test_the_yardsticks_solve_the_same_problem() -> None:
    for seed in range(5):
        problem = small_problem(100 + seed)
        value, policy = solve_by_numpy(problem)
        for solve in (solve_by_scipy, solve_by_plain_loops, *([solve_by_quantecon] if quantecon_is_there() else [])):
            found, commands = solve(problem)
            assert np.abs(found - value).max() < 1e-11, solve.__name__
            assert largest_regret(problem, commands) < 1e-11, solve.__name__
        other = replace(problem, target_speed_m_s=2.5)
        both = solve_targets_by_scipy([problem, other])
        assert np.abs(both[0][0] - value).max() < 1e-11
        assert np.abs(both[1][0] - solve_by_numpy(other)[0]).max() < 1e-11
        assert policy.shape == both[0][1].shape


def test_work_is_what_the_landings_need() -> None:
    """One speed block, one command that holds: a window from the farthest landing of any lane to the nearest."""
    problem = ReferenceProblem(stages=1, speed_points=16, pressure_points=2, commands=1, friction_nodes=1,
                               resistance_nodes=1, braking_m_s2_per_kpa=0.0, mean_resistance=0.010)  # fmt: skip
    work = operator_work(problem)  # no force at all: every speed lands where it is
    assert (work.units, work.weights) == (2, 2)
    assert work.products == 1 + 2, "pressure 0 stays on its row, 800 kPa falls between the two"


@pytest.mark.parametrize(
    "wrong",
    [{"stages": 0}, {"speed_points": 1}, {"commands": 300}, {"lowest_speed_m_s": 0.0}, {"command_step_kpa": 500.0},
     {"friction_std": 0.4}],
    ids=str,
)  # fmt: skip
def test_impossible_problems_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"must|needs|at most"):
        ReferenceProblem(**wrong)
