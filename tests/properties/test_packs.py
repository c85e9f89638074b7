"""Packs compute what their plain definitions say, and solving targets side by side changes no target."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray
from scipy.special import ndtr

from plant_models import Plant
from synth.kernels.vector import packs
from synth.kernels.vector.normal_packs import normal_cdf8, normal_density8
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve, solve_all
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.evaluation import Evaluation, exit_density

Doubles = NDArray[np.float64]
Singles = NDArray[np.float32]
Integers = NDArray[np.int64]

CRITERION = Criterion(1.0, 1e-5)


def everything(
    numbers: Doubles,
    singles: Singles,
    places: Integers,
    apart: Integers,
    kept: Integers,
    kept_singles: Singles,
    out: Doubles,
) -> None:
    """Every function and operator of `packs` once; the results in `out`."""
    a, b = packs.load8(numbers, 3), packs.load8(numbers, 17)
    where = packs.load8(places, 1)
    low = (a < b) & (a >= -1.0) | (b <= -1.5)
    mixed = packs.choose(low, a * 2.0 - b, (1.0 - a) / (b * b + 1.0))
    packs.store(out, 0, mixed)
    packs.store(out, 8, packs.least(packs.greatest(a, -0.5), b) + packs.gather(numbers, where))
    packs.store(out, 16, packs.fraction(packs.whole(a * 7.0) * 3 - where + 2))
    packs.store(out, 24, packs.magnitude(b) + packs.eight(0.25))
    packs.store(out, 32, a + b)
    packs.store(out, 40, a - b)
    packs.store(out, 48, a * b)
    packs.store(out, 56, -0.5 * a)
    packs.store(out, 64, packs.load16(numbers, 5) * packs.load16(numbers, 6))
    packs.store(kept_singles, 1, a)
    packs.store(kept_singles, 9, packs.load8(singles, 3) * 0.3)
    out[81] = packs.item(numbers, 11)
    packs.add_to(out, 81, 0.5)
    packs.fetch(numbers, 60)  # beyond the end: nothing is read
    single = packs.gather(singles, where) * packs.narrow(a)
    packs.store(out, 84, packs.wide(single) + packs.nearest(b * 3.0))
    packs.store(out, 92, packs.root(packs.magnitude(a)))
    packs.store(out, 100, packs.fraction(packs.gather(places, packs.least(where, 11))))
    packs.scatter(out, packs.load8(apart, 0) + 108, packs.opposite(low), b)
    out[124] = packs.keep(out, 125, low, a * 3.0) + packs.keep(kept, 1, low, where)
    out[82] = 1.0 if packs.holds_anywhere(low) else 0.0
    out[83] = 1.0 if packs.holds_anywhere((a > 9.0) | (where == 99)) else 0.0
    for count in range(9):
        mask = packs.fraction(where) * (count - 4.0) > 0.0
        out[133 + 2 * count], out[134 + 2 * count] = packs.first_lane(mask), packs.last_lane(low, count)
    first, second, third, fourth = packs.gather_four(numbers, packs.least(where, 36))
    packs.store(out, 151, first)
    packs.store(out, 159, second)
    packs.store(out, 167, third)
    packs.store(out, 175, fourth)


@pytest.mark.parametrize("seed", range(5))
def test_compiled_packs_are_the_plain_ones_to_the_bit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    numbers, places = rng.uniform(-2.0, 2.0, 40), rng.integers(0, 40, 12)
    singles, apart = rng.uniform(-2.0, 2.0, 40).astype(np.float32), rng.permutation(16)
    compiled, plain, kept, plainly = np.zeros(183), np.zeros(183), np.zeros(9, np.int64), np.zeros(9, np.int64)
    rounded, plainly_rounded = np.zeros(18, np.float32), np.zeros(18, np.float32)
    compiled_everything: Any = njit(everything)
    compiled_everything(numbers, singles, places, apart, kept, rounded, compiled)
    everything(numbers, singles, places, apart, plainly, plainly_rounded, plain)
    np.testing.assert_array_equal(compiled, plain)
    np.testing.assert_array_equal(kept, plainly)
    np.testing.assert_array_equal(rounded, plainly_rounded)
    np.testing.assert_array_equal(rounded[1:9], numbers[3:11].astype(np.float32))
    chosen = int(plain[124]) // 2
    assert 0 < chosen < 8
    assert np.count_nonzero(plain[108:124]) == 8 - chosen
    assert np.count_nonzero(plain[:108]) > 99  # all but a few were written
    assert (plain[82], plain[83]) == (1.0, 0.0)


@pytest.mark.parametrize("count", [1, 3, 8, 9])
def test_targets_side_by_side_are_solved_as_alone(small: Callable[[], Chain], count: int) -> None:
    """Padding to whole packs and neighbours in a pack change no bit of lines and values."""
    targets = np.linspace(1.5, 3.5, count)
    together = solve_all(small(), [Aim(float(target), CRITERION) for target in targets])
    for target, one in zip(targets, together, strict=True):
        alone = solve(small(), Aim(float(target), CRITERION))
        np.testing.assert_array_equal(one.lines.lower_m_s, alone.lines.lower_m_s)
        np.testing.assert_array_equal(one.lines.upper_m_s, alone.lines.upper_m_s)
        np.testing.assert_array_equal(one.values, alone.values)


def test_what_is_kept_of_the_values_does_not_matter(small: Callable[[], Chain]) -> None:
    whole, first = (solve_all(small(), [Aim(2.5, CRITERION)], nodes_kept=kept)[0] for kept in (None, 1))
    np.testing.assert_array_equal(first.values, whole.values[:, :1])
    np.testing.assert_array_equal(first.gain_up, whole.gain_up)
    np.testing.assert_array_equal(first.lines.lower_m_s, whole.lines.lower_m_s)


TINY = Resolution(
    path_step_m=2.0, speed_step_m_s=0.4, transient_substeps=2, friction_nodes=2, path_levels=2, resistance_nodes=1
)


def figures(plant: Plant) -> list[float]:
    """Sums over a solution of a tiny grid, its density, and the gradient of its cost."""
    t = persistent_chain(plant, TINY)
    # Without the compiler numpy decides where float32 meets float64; in one type there is nothing to decide.
    (solution,) = solve_all(t, [Aim(2.5, CRITERION)], value_type=np.float64)
    density = exit_density(t, solution.lines)
    cost, by_lines = Evaluation(t, solution.aim).gradient(solution.lines)
    by_lower, by_upper = by_lines
    lines = solution.lines.upper_m_s[np.isfinite(solution.lines.upper_m_s)]
    sums = (t.landings.ends, solution.values, solution.gain_up, lines, density.probability**2, by_lower**2, by_upper**2)
    return [cost, density.stalled, *(float(each.sum()) for each in sums)]


WITHOUT_COMPILER = """
import importlib.util, json, sys
def load(path):
    spec = importlib.util.spec_from_file_location("loaded", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules["loaded"] = module
    spec.loader.exec_module(module)
    return module
print(json.dumps(load(sys.argv[1]).figures(load(sys.argv[2]).random_plant())))
"""


def test_the_kernels_mean_the_same_without_the_compiler(plant_with: Callable[..., Plant], request: Any) -> None:
    """Solve, density and gradient as plain Python loops over numpy packs, in an interpreter of their own."""
    conftest = request.path.with_name("conftest.py")
    plain = subprocess.run(
        [sys.executable, "-c", WITHOUT_COMPILER, str(request.path), str(conftest)],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert plain.returncode == 0, plain.stderr
    np.testing.assert_allclose(json.loads(plain.stdout), figures(plant_with()), rtol=1e-11)


@njit
def normal_law(z: np.ndarray, below: np.ndarray, density: np.ndarray) -> None:
    """Φ and φ, pack by pack."""
    for j in range(0, z.shape[0], packs.EIGHT):
        packs.store(below, j, normal_cdf8(packs.load8(z, j)))
        packs.store(density, j, normal_density8(packs.load8(z, j)))


def test_the_normal_law_in_packs() -> None:
    """Against scipy: to rounding, in the lower tail relative to Φ itself; exactly 0 and 1 beyond six deviations."""
    z = np.concatenate([np.linspace(-6.0, 6.0, 160_000), [-np.inf, -6.1, -6.0 - 1e-15, 6.0 + 1e-15, 6.1, np.inf, 0, 0]])
    below, density = np.empty_like(z), np.empty_like(z)
    normal_law(z, below, density)
    inside, tail = np.abs(z) <= 6.0, (z < 0.0) & (z >= -6.0)
    np.testing.assert_allclose(below[inside], ndtr(z[inside]), rtol=0.0, atol=4e-16)
    np.testing.assert_allclose(below[tail], ndtr(z[tail]), rtol=2e-11)
    np.testing.assert_allclose(density[inside], np.exp(-0.5 * z[inside] ** 2) / np.sqrt(2 * np.pi), rtol=2e-13)
    assert set(below[~inside]) == {0.0, 1.0}
    assert not density[~inside].any()
