"""Figures of quality against their definitions; intervals against simulated coverage and exact limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from synth.simulation.exit_statistics import clopper_pearson, exit_statistics, pooled_statistics
from synth.simulation.passes import ExitSample


def sample_of(speed: NDArray[np.float64]) -> ExitSample:
    n = len(speed)
    return ExitSample(speed, speed == 0.0, np.full(n, 3, dtype=np.int32), np.full(n, 9.0))


def test_figures_of_a_small_sample() -> None:
    figures = exit_statistics(sample_of(np.array([4.0, 4.4, 3.8, 0.0])), 4.0)
    assert figures.passes == 4
    assert figures.rms_m_s == pytest.approx(math.sqrt((0.16 + 0.04 + 16.0) / 4))
    assert figures.bias_m_s == pytest.approx(-0.95)
    assert figures.overspeed == 0.25
    assert figures.stalls == 1
    assert figures.switchings == 3.0
    assert figures.rms_m_s**2 == pytest.approx(figures.bias_m_s**2 + figures.std_m_s**2 * 3 / 4)


def test_p99_and_zero_error() -> None:
    figures = exit_statistics(sample_of(3.0 + np.arange(101) / 1000), 3.0)
    assert figures.p99_m_s == pytest.approx(0.099)
    exact = exit_statistics(sample_of(np.full(10, 3.0)), 3.0)
    assert exact.rms_ci95_m_s == (0.0, 0.0)


@pytest.mark.parametrize("heavy", [False, True])
def test_rms_interval_covers_in_95_percent_of_samples(heavy: bool) -> None:
    rng = np.random.default_rng(3)
    truth, hits, trials = 0.1, 0, 600
    for _ in range(trials):
        error = rng.standard_t(8, 500) / math.sqrt(8 / 6) if heavy else rng.standard_normal(500)
        low, high = exit_statistics(sample_of(3.0 + truth * error), 3.0).rms_ci95_m_s
        hits += low <= truth <= high
    # 95 % ± 4 standard errors of 600 trials, and the slightly low coverage that heavy tails cost
    assert (0.89 if heavy else 0.914) <= hits / trials <= 0.986


@pytest.mark.parametrize(("hits", "n"), [(0, 3000), (1, 20), (7, 100), (20, 20)])
def test_clopper_pearson_is_the_exact_interval(hits: int, n: int) -> None:
    exact = stats.binomtest(hits, n).proportion_ci(0.95, method="exact")
    assert clopper_pearson(hits, n) == pytest.approx((exact.low, exact.high), abs=1e-12)


def test_one_pass_has_no_statistics() -> None:
    with pytest.raises(ValueError, match="at least 2"):
        exit_statistics(sample_of(np.array([3.0])), 3.0)


def test_pooled_strata_give_the_figures_of_the_mixture() -> None:
    """Two strata of unequal size and weight against the same mixture written out as one sample."""
    rng = np.random.default_rng(11)
    common, rare = 3.0 + 0.02 * rng.normal(size=600), 3.0 + 0.6 * rng.random(200)
    strata = [sample_of(common), sample_of(rare)]
    pooled = pooled_statistics(strata, [0.9, 0.1], 3.0)
    mixture = exit_statistics(sample_of(np.concatenate([np.tile(common, 3), rare])), 3.0)  # 1800 to 200
    assert pooled.passes == 800
    for name in ("rms_m_s", "bias_m_s", "overspeed", "p99_m_s"):
        assert getattr(pooled, name) == pytest.approx(getattr(mixture, name), rel=0.02), name
    low, high = pooled.rms_ci95_m_s
    assert low < pooled.rms_m_s < high
    error = math.sqrt(sum(w**2 * ((s - 3.0) ** 2).var(ddof=1) / len(s) for w, s in ((0.9, common), (0.1, rare))))
    assert math.log(high / low) == pytest.approx(1.96 * error / pooled.rms_m_s**2, rel=1e-3)
