"""Density and value are transposes; float32 values and kernels without undocumented options do the same."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from plant_models import Plant
from synth.kernels.plain import VARIABLE
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.evaluation import Evaluation, commands_of, exit_density, forward_all, forward_one
from synth.solver.switching_lines import SwitchingLines
from tests.effort import sized
from tests.frame.small_command import results_in

SEEDS = st.integers(0, 2**32 - 1)

FEW = settings(
    max_examples=sized(5, 12),
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def random_lines(t: Chain, seed: int) -> SwitchingLines:
    """Ordered lines between 0.5 and 5.5 m/s, rough along the path, some of them absent."""
    rng = np.random.default_rng(seed)
    shape = (t.actuator.stages, len(t.grid.path_m))
    middle = rng.uniform(0.8, 5.0, (shape[0], 1)) + 0.3 * rng.standard_normal(shape)
    half = rng.uniform(0.05, 0.8, shape)
    lower, upper = middle - half, middle + half
    if rng.random() < 0.3:
        lower[int(rng.integers(shape[0]))] = -np.inf
    if rng.random() < 0.3:
        upper[int(rng.integers(shape[0]))] = np.inf
    lower[0], upper[-1] = -np.inf, np.inf
    return SwitchingLines(np.array(t.grid.path_m), lower, upper)


def shifted(lines: SwitchingLines, by_lower: NDArray[np.float64], by_upper: NDArray[np.float64]) -> SwitchingLines:
    """The lines moved by (K + 1, N) at the nodes before the exit."""
    lower, upper = lines.lower_m_s.copy(), lines.upper_m_s.copy()
    lower[:, :-1] += by_lower
    upper[:, :-1] += by_upper
    return SwitchingLines(np.array(lines.nodes_m), lower, upper)


@FEW
@given(seed=SEEDS, target=st.floats(1.0, 4.0), staircase=st.booleans(), stall_cost=st.floats(0.0, 20.0))
def test_density_and_value_agree(
    small: Callable[[], Chain], seed: int, target: float, staircase: bool, stall_cost: float
) -> None:
    """rms² + stall cost + cost of commands = value at the entrance, to 1e-8 (`NEGLIGIBLE_MASS` is dropped)."""
    t, criterion = small(), Criterion(stall_cost, 1e-3)
    chain, lines = t.quantised() if staircase else t, random_lines(t, seed)
    density = exit_density(chain, lines)
    forward = density.rms_m_s(target) ** 2 + density.stalled * stall_cost + 1e-3 * density.switchings
    assert Evaluation(chain, Aim(target, criterion)).cost(lines) == pytest.approx(forward, rel=1e-8)


@FEW
@given(seed=SEEDS)
def test_no_mass_is_lost(small: Callable[[], Chain], seed: int) -> None:
    """Exits and stalls sum to one within 1e-9. Cubic weights can leave stalls of −1e-6, which the density clips."""
    t, total, stalled = small(), 0.0, 0.0
    policy, band = commands_of(t, random_lines(t, seed)), np.empty((len(t.drive_m_s2), 2), dtype=np.int64)
    for i, weight in enumerate(t.scenarios.weight):
        exits, totals = forward_one(t, policy, i, np.empty((0, 0, 0, 0)), band)
        total += weight * (exits.sum() + totals[0])
        stalled += weight * totals[0]
    density = exit_density(t, random_lines(t, seed))
    assert total == pytest.approx(1.0, abs=1e-9)
    assert density.probability.sum() + density.stalled == pytest.approx(1.0 - min(stalled, 0.0), abs=1e-9)
    assert density.escaped < 1e-3
    assert stalled > -1e-5


@FEW
@given(seed=SEEDS)
def test_a_scenario_leaves_nothing_to_the_next(small: Callable[[], Chain], seed: int) -> None:
    """Followed after others, in the same memory, a scenario has the exits and totals that it has alone, to the bit."""
    t = small()
    policy = commands_of(t, random_lines(t, seed))
    scenarios, nothing = len(t.scenarios.weight), np.empty((0, 0, 0, 0))
    band = np.empty((scenarios, len(t.drive_m_s2), 2), dtype=np.int64)
    together = forward_all(t, policy, slice(None), np.empty((scenarios, 0, 0, 0, 0)), band)
    for i in range(scenarios):
        alone = forward_one(t, policy, i, nothing, band[i])
        np.testing.assert_array_equal(together[0][i], alone[0])
        np.testing.assert_array_equal(together[1][i], alone[1])


@FEW
@given(seed=SEEDS, target=st.floats(1.0, 4.0))
def test_gradient_is_the_slope_of_the_cost(small: Callable[[], Chain], seed: int, target: float) -> None:
    """Along a random direction: central difference over ±1e-4 m/s, 1e-5 of the largest slope (third derivative)."""
    t, criterion = small(), Criterion(1.0, 1e-4, time_price_m2_s3=0.02)
    lines = random_lines(t, seed)
    rng = np.random.default_rng(seed + 1)
    shape = lines.lower_m_s[:, :-1].shape
    direction = rng.standard_normal((2, *shape))
    cost, by_lines = Evaluation(t, Aim(target, criterion)).gradient(lines)
    by_lower, by_upper = (each.T for each in by_lines)
    h = 1e-4
    sides = [Evaluation(t, Aim(target, criterion)).cost(shifted(lines, *(s * h * direction))) for s in (1.0, -1.0)]
    size = np.abs(by_lower).sum() + np.abs(by_upper).sum()
    along = (by_lower * direction[0]).sum() + (by_upper * direction[1]).sum()
    assert along == pytest.approx((sides[0] - sides[1]) / (2 * h), abs=1e-5 * size + 1e-9)
    assert cost == pytest.approx(Evaluation(t, Aim(target, criterion)).cost(lines), rel=1e-8)


TARGETS = (1.0, 2.5, 4.0)


@pytest.fixture(scope="module", params=[0.0, 1e-5], ids=["free", "priced"])
def pairs(
    request: pytest.FixtureRequest, plant_with: Callable[..., Plant], coarse: Resolution
) -> list[tuple[Solution, Solution]]:
    """Solutions in float32 and in float64; the last path quantum is too short for any change of stage."""
    design = persistent_chain(plant_with(), replace(coarse, path_step_m=0.25))
    aims = [Aim(target, Criterion(1.0, request.param)) for target in TARGETS]
    return list(zip(*(solve_all(design, aims, value_type=kind) for kind in (np.float32, np.float64)), strict=True))


def test_values_are_those_of_float64_but_for_some_roundings(pairs: list[tuple[Solution, Solution]]) -> None:
    for single, double in pairs:
        assert (single.values.dtype, double.values.dtype) == (np.dtype(np.float32), np.dtype(np.float64))
        error = np.abs(single.values - double.values)
        assert 0.0 < error.max() < 2e-6 * double.values.max()


def test_lines_are_those_of_float64(pairs: list[tuple[Solution, Solution]]) -> None:
    """There are none more: rounding alone sends no command where nothing can be gained.

    They agree to 0.1 mm/s, but for the last quantum, where hardly anything can be gained on either side of a line.
    """
    for single, double in pairs:
        sides = (
            (single.lines.lower_m_s, double.lines.lower_m_s),
            (single.lines.upper_m_s, double.lines.upper_m_s),
        )
        for one, other in sides:
            there = np.isfinite(other)
            assert there.sum() > 20
            np.testing.assert_array_equal(np.isfinite(one), there)
            matters = there & (np.arange(one.shape[1]) < one.shape[1] - 2)
            assert np.abs(one[matters] - other[matters]).max() < 1e-4


def test_the_policy_costs_what_that_of_float64_does(pairs: list[tuple[Solution, Solution]]) -> None:
    """Evaluated exactly, in float64."""
    for single, double in pairs:
        cost, best = (
            Evaluation(t, each.aim).gradient(each.lines)[0] for each in (single, double) for t in (each.chain,)
        )
        assert abs(cost - best) < 1e-7 * best + 1e-10


ROOT = Path(__file__).parents[2]
CASE = """\
[[cut]]
car = "gondola-4"
mass_t = 22.0
[targets]
exit_speeds_m_s = [2.0]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.06
[validation]
passes = 1000
[output]
plots = false
report = false
"""
OPTIONS = "from synth.kernels.vector.numba_internals import *; print(WITHOUT_REFERENCE_COUNTS | WITHOUT_CALLBACK)"


def ran(*words: str, plain: bool, folder: Path = ROOT) -> str:
    """What Python prints with these words, with plain kernels or fast ones."""
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    environment |= {VARIABLE: "1" if plain else "0", "SOURCE_DATE_EPOCH": "1700000000"}
    done = subprocess.run(
        [sys.executable, *words], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_variable_leaves_the_options_out() -> None:
    assert ran("-c", OPTIONS, plain=True) == "{}\n"
    assert "_nrt" in ran("-c", OPTIONS, plain=False)


def test_packs_are_those_of_their_definitions() -> None:
    ran(
        "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/properties/test_packs.py", "-k", "to_the_bit", plain=True
    )


@pytest.mark.long
def test_a_tune_gives_the_same_bytes(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    tune = "import sys; from synth.cli import main; sys.exit(main(['tune', 'case.toml', '-o', sys.argv[1]]))"
    for name, plain in (("plain", True), ("fast", False)):
        ran("-c", tune, name, plain=plain, folder=tmp_path)
    assert results_in(tmp_path / "plain") == results_in(tmp_path / "fast")
