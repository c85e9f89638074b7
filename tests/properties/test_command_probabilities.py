"""The probabilities of the commands and their slopes are those of the normal law, at every node, stage and speed."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from scipy.stats import norm

from synth.kernels.sweep.commands import CERTAIN, command_probabilities, command_slopes
from synth.solver.chain.decisions import Decisions, steps_of
from synth.solver.switching_lines import SwitchingLines

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
