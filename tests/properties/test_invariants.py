"""What must hold of solutions whatever the plant, and of the probabilities of commands and their slopes."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import product

import numpy as np
import pytest
from scipy.stats import norm

from plant_models import Plant
from scripts.studies.point_sensors.worth import with_known_friction
from synth.kernels.sweep.commands import CERTAIN, command_probabilities, command_slopes
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.chain.decisions import Decisions, steps_of
from synth.solver.evaluation import Evaluation
from synth.solver.switching_lines import SwitchingLines

TARGET_M_S = 2.5

CRITERION = Criterion(1.0, 1e-5)


def solved_cost(t: Chain, criterion: Criterion = CRITERION) -> float:
    """Cost of the solver's own lines, evaluated exactly."""
    lines = solve(t, Aim(TARGET_M_S, criterion)).lines
    return Evaluation(t, Aim(TARGET_M_S, criterion)).cost(lines)


def test_information_cannot_hurt(small: Callable[[], Chain]) -> None:
    """Told ξ, each scenario with its own lines costs on average less than one set of lines for all."""
    t = small()
    lines = solve(t, Aim(TARGET_M_S, CRITERION)).lines
    common, known = [], []
    for factor in t.scenarios.factor:
        told = with_known_friction(t, float(factor))
        common.append(Evaluation(told, Aim(TARGET_M_S, CRITERION)).cost(lines))
        known.append(solved_cost(told))
    weight = t.scenarios.weight
    assert weight @ common == pytest.approx(solved_cost(t), rel=1e-9)  # one resistance: the same three scenarios
    print("information", common, known, weight @ common, weight @ known)
    assert all(k <= 1.02 * c + 1e-5 for k, c in zip(known, common, strict=True))  # lines are not quite optimal
    assert weight @ known < weight @ common


def bytes_of(solution: Solution) -> tuple[bytes, ...]:
    """Everything a solution holds."""
    arrays = (solution.values, solution.lines.lower_m_s, solution.lines.upper_m_s, solution.gain_down, solution.gain_up)
    return tuple(np.ascontiguousarray(a).tobytes() for a in arrays)


def test_same_bytes_twice_and_from_two_threads(plant_with: Callable[..., Plant], coarse: Resolution) -> None:
    """Nothing depends on memory left over, on the order of threads, or on what ran before."""
    t = persistent_chain(plant_with(), coarse)
    first = bytes_of(solve(t, Aim(TARGET_M_S, CRITERION)))
    again = persistent_chain(plant_with(), coarse)
    assert again.landings.energy_m2_s2.tobytes() == t.landings.energy_m2_s2.tobytes()
    assert bytes_of(solve(again, Aim(TARGET_M_S, CRITERION))) == first
    with ThreadPoolExecutor(2) as pool:
        runs = [pool.submit(solve, t, Aim(target, CRITERION)) for target in (TARGET_M_S, 2.0, TARGET_M_S, 2.0)]
        assert bytes_of(runs[0].result()) == bytes_of(runs[2].result()) == first
        assert bytes_of(runs[1].result()) == bytes_of(runs[3].result())


SPEED_M_S = np.sqrt(0.02 * np.arange(201.0))
NOISE_M_S = 0.07


def lines(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Of 5 nodes and 4 stages: below, within and above all speeds, on a speed, so far from one that it is certain."""
    found = np.random.default_rng(seed).uniform(-0.5, 2.7, (2, 5, 4))
    found[:, 0] = -np.inf, np.inf, SPEED_M_S[7], SPEED_M_S[-1]
    found[:, 1, :2] = SPEED_M_S[90] + CERTAIN * NOISE_M_S, SPEED_M_S[90] - CERTAIN * NOISE_M_S
    lower, upper = found
    return lower, upper


@pytest.mark.parametrize("seed", range(3))
def test_commands_are_those_of_the_normal_law(seed: int) -> None:
    lower, upper = lines(seed)
    (down, up), (down_slope, up_slope) = chances, slopes = np.full((2, 2, 5, 4, len(SPEED_M_S)), np.nan)
    command_probabilities(np.stack([lower, upper]), SPEED_M_S, NOISE_M_S, chances)
    command_slopes(np.stack([lower, upper]), SPEED_M_S, NOISE_M_S, slopes)
    below = (lower[:, :, None] - SPEED_M_S) / NOISE_M_S
    above = (SPEED_M_S - upper[:, :, None]) / NOISE_M_S
    for found, slope, z, sign in ((down, down_slope, below, 1.0), (up, up_slope, above, -1.0)):
        np.testing.assert_allclose(found, norm.cdf(z), rtol=1e-12, atol=1.1 * norm.sf(CERTAIN))
        least = 1.1 * norm.pdf(CERTAIN) / NOISE_M_S
        np.testing.assert_allclose(slope, sign * norm.pdf(z) / NOISE_M_S, rtol=1e-12, atol=least)
        certain = np.abs(z) > CERTAIN * (1.0 + 1e-12)
        assert (found[certain] == (z[certain] > 0.0)).all()
        assert (slope[certain] == 0.0).all()


def test_a_command_that_goes_farther_is_not_one_that_goes_just_so_far() -> None:
    """Lines for one and for two stages: the probabilities of both are those of the normal law between the lines."""
    near, far = np.full((2, 1, 1), 1.0), np.array([[[0.8]], [[1.3]]])
    lines_of_both = np.concatenate([near, far])  # down by 1, up by 1, down by 2, up by 2
    found = np.empty((4, 1, 1, len(SPEED_M_S)))
    command_probabilities(lines_of_both, SPEED_M_S, NOISE_M_S, found)
    below, beyond = ((SPEED_M_S - line) / NOISE_M_S for line in (0.8, 1.3))
    by_law = norm.sf((SPEED_M_S - 1.0) / NOISE_M_S)
    expected = (by_law - norm.cdf(-below), 1.0 - by_law - norm.cdf(beyond), norm.cdf(-below), norm.cdf(beyond))
    for command, probability in enumerate(expected):
        np.testing.assert_allclose(found[command, 0, 0], probability, atol=2.5 * norm.sf(CERTAIN))
    assert found.sum(axis=0).max() <= 1.0 + 1e-12


@pytest.mark.parametrize("farthest", [1, 2, 4])
def test_a_command_goes_on_as_long_as_the_same_reading_asks(farthest: int) -> None:
    """Lines of five stages in any order: the thresholds of the commands say what asking stage by stage says."""
    rng = np.random.default_rng(farthest)
    lower = rng.uniform(1.0, 3.0, (5, 4))
    upper = lower + rng.uniform(0.01, 1.0, (5, 4))
    lower[0], upper[4] = -np.inf, np.inf
    node = np.arange(3)
    decisions = Decisions(node, node.astype(float), np.zeros(3), farthest, 1)
    thresholds = SwitchingLines(np.arange(4.0), lower, upper).at_decisions(decisions)
    seen = set()
    for n, k, v in product(range(3), range(5), rng.uniform(0.5, 4.5, 300)):
        reached = asked(lower[:, n], upper[:, n], k, v, farthest)
        gone = [steps_of(c) for c, line in enumerate(thresholds[:, n, k]) if (v < line, v > line)[c % 2]]
        assert max(gone, key=abs, default=0) == reached - k
        seen.add(reached - k)
    assert seen == set(range(-farthest, farthest + 1))


def asked(lower: np.ndarray, upper: np.ndarray, stage: int, v: float, farthest: int) -> int:
    """The stage at which asking stage by stage ends, from `stage` on, after `farthest` steps at the latest."""
    going = 0
    for _ in range(farthest):
        step = int(v > upper[stage]) - int(v < lower[stage])
        if step == 0 or step == -going:
            break
        stage, going = stage + step, step
    return stage
