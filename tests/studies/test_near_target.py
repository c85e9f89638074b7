"""Figures of the passes near the target: against plain formulas, finite differences, and the truth of many samples."""

from __future__ import annotations

import math

import numpy as np
import pytest

from scripts.studies.near_target import NEAR_M_S, log_rms_near, near_ratio, near_target
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import REPLICATE_PASSES

TARGET_M_S = 3.0


def sample_of(error: np.ndarray, weight: np.ndarray) -> ExitSample:
    none = np.zeros(len(error))
    values = {"exit_speed_m_s": TARGET_M_S + error, "weight": weight}
    names = ExitSample.__dataclass_fields__
    return ExitSample(**{name: values.get(name, none) for name in names})


def drawn(rng: np.random.Generator, count: int, std_m_s: float, far: float = 0.02) -> np.ndarray:
    """Errors of which a share `far` is brake saturated, 1 m/s too fast."""
    return np.where(rng.random(count) < far, 1.0, rng.normal(0.0, std_m_s, count))


def test_far_passes_count_in_the_share_alone() -> None:
    error, weight = np.array([0.1, -0.2, 0.5, 0.1] * 50), np.array([1.0, 2.0, 0.5, 1.5] * 50)
    found = near_target(sample_of(error, weight), TARGET_M_S)
    assert found.rms_m_s == pytest.approx(math.sqrt((1.0 * 0.01 + 2.0 * 0.04 + 1.5 * 0.01) / 4.5))
    assert found.outside == pytest.approx(0.5 / 5.0)


def test_the_influence_is_the_derivative_by_the_weights() -> None:
    rng = np.random.default_rng(1)
    error, weight = drawn(rng, 40, 0.1, 0.2), rng.uniform(0.5, 2.0, 40)
    _, influence = log_rms_near(error, weight)
    assert influence.sum() == pytest.approx(0.0, abs=1e-10)
    for i in range(len(error)):
        step = np.zeros(40)
        step[i] = 1e-6 * weight[i]
        slope = (log_rms_near(error, weight + step)[0] - log_rms_near(error, weight - step)[0]) / 2e-6
        assert influence[i] / weight.sum() == pytest.approx(slope, abs=1e-7)


def test_the_same_passes_have_the_ratio_one_for_certain() -> None:
    sample = sample_of(drawn(np.random.default_rng(2), 1000, 0.05), np.ones(1000))
    assert near_ratio(sample, sample, TARGET_M_S) == (1.0, (1.0, 1.0))


def test_doubled_errors_have_twice_the_rms() -> None:
    error = np.random.default_rng(3).uniform(-0.1, 0.1, 1000)
    ratio, ends = near_ratio(sample_of(2.0 * error, np.ones(1000)), sample_of(error, np.ones(1000)), TARGET_M_S)
    assert ratio == pytest.approx(2.0)
    assert ends == pytest.approx((2.0, 2.0))


def test_the_interval_holds_the_truth_as_often_as_it_says() -> None:
    """Two controllers on the same passes, whose errors are partly common; some passes are far by one of them only."""
    rng, held, blocks = np.random.default_rng(4), 0, 400
    for _ in range(blocks):
        count = 20 * REPLICATE_PASSES
        common, weight = rng.normal(0.0, 0.04, count), rng.uniform(0.2, 2.0, count)
        ours, theirs = (common + rng.normal(0.0, std, count) for std in (0.03, 0.05))
        ours[rng.random(count) < 0.01] = 1.0
        truth = math.hypot(0.04, 0.03) / math.hypot(0.04, 0.05)  # beyond 0.3 m/s lies next to nothing of either
        low, high = near_ratio(sample_of(ours, weight), sample_of(theirs, weight), TARGET_M_S)[1]
        held += low <= truth <= high
    assert 0.91 * blocks <= held <= 0.99 * blocks
    assert 4.0 * math.hypot(0.04, 0.05) < NEAR_M_S
