"""Figures of quality against their definitions; exact limits of a probability."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from synth.simulation.exit_statistics import brake_power, clopper_pearson, exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample


def sample_of(speed: NDArray[np.float64], weight: NDArray[np.float64] | None = None) -> ExitSample:
    n = len(speed)
    switchings = np.full(n, 3, dtype=np.int32)
    return ExitSample(speed, speed == 0.0, switchings, np.full(n, 9.0), np.ones(n) if weight is None else weight)


def test_figures_of_a_sample() -> None:
    speed = np.tile([4.0, 4.4, 3.8, 0.0], 100)
    figures = exit_statistics(sample_of(speed), 4.0)
    assert figures.passes == 400
    assert figures.rms_m_s == pytest.approx(math.sqrt((0.16 + 0.04 + 16.0) / 4))
    assert figures.bias_m_s == pytest.approx(-0.95)
    assert (figures.overspeed, figures.stalled, figures.switchings) == (0.25, 0.25, 3.0)
    assert figures.rms_m_s**2 == pytest.approx(figures.bias_m_s**2 + figures.std_m_s**2)
    assert figures.switchings_ci95 == (3.0, 3.0)


def test_quantiles_and_zero_error() -> None:
    figures = exit_statistics(sample_of(3.0 + np.arange(1001) / 10_000), 3.0)
    assert (figures.p95_m_s, figures.p99_m_s) == pytest.approx((0.095, 0.099))
    least = exit_statistics(sample_of(3.0 + np.arange(200) / 1024), 3.0)  # that so many of them do not exceed
    assert (least.p95_m_s, least.p99_m_s) == pytest.approx((189 / 1024, 197 / 1024))
    exact = exit_statistics(sample_of(np.full(200, 3.0)), 3.0)
    assert exact.rms_ci95_m_s == (0.0, 0.0)


def test_every_interval_holds_its_figure_and_that_of_a_mean_is_students() -> None:
    rng = np.random.default_rng(8)
    sample = replace(sample_of(3.0 + 0.2 * rng.standard_normal(500)), switchings=rng.integers(1, 9, 500, np.int32))
    sample = replace(sample, stalled=rng.random(500) < 0.1, transit_time_s=rng.normal(9.0, 1.0, 500))
    figures = asdict(exit_statistics(sample, 3.0))
    intervals = {name.replace("_ci95", ""): ends for name, ends in figures.items() if "_ci95" in name}
    assert len(intervals) == 8
    for name, (low, high) in intervals.items():
        assert low < figures[name] < high, name
    means: dict[str, NDArray[Any]] = {"switchings": sample.switchings, "time_s": sample.transit_time_s}
    for name, values in {"bias_m_s": sample.exit_speed_m_s - 3.0, **means}.items():
        groups = values.reshape(5, 100).mean(axis=1)
        student = stats.t.interval(0.95, 4, groups.mean(), stats.sem(groups))
        assert intervals[name] == pytest.approx(student), name


def test_a_weight_counts_as_so_many_passes() -> None:
    """Passes of weight 2 against the same passes written out twice."""
    rng = np.random.default_rng(4)
    error = rng.normal(0.01, 0.05, 5000)
    twice = rng.random(5000) < 0.3
    weighted = exit_statistics(sample_of(3.0 + error, np.where(twice, 2.0, 1.0)), 3.0)
    written = exit_statistics(sample_of(3.0 + np.concatenate([error, error[twice]])), 3.0)
    for name in ("rms_m_s", "bias_m_s", "overspeed", "p95_m_s", "p99_m_s", "switchings"):
        assert getattr(weighted, name) == pytest.approx(getattr(written, name), abs=1e-9), name


def test_brake_power_parts_what_no_table_can_hold() -> None:
    speed = np.full(1000, 3.02)
    speed[::10] = 4.0
    full = np.where(speed > 3.9, 3.9, 2.0)
    power = brake_power(sample_of(speed), sample_of(full), 3.0)
    assert power.brake_saturated == pytest.approx(0.1)
    assert power.rms_within_m_s == pytest.approx(0.02)
    none = brake_power(sample_of(speed), sample_of(np.full(1000, 5.0)), 3.0)
    assert (none.brake_saturated, none.rms_within_m_s, none.rms_within_ci95_m_s) == (1.0, None, None)


def test_the_ratio_of_paired_samples() -> None:
    """A controller whose every error is twice another's has ratio 2 without any doubt."""
    rng = np.random.default_rng(6)
    one = sample_of(3.0 + 0.1 * rng.standard_normal(2000))
    other = replace(one, exit_speed_m_s=3.0 + 0.5 * (one.exit_speed_m_s - 3.0))
    ratio, (low, high) = rms_ratio(one, other, 3.0)
    assert ratio == pytest.approx(2.0)
    assert high - low == pytest.approx(0.0, abs=1e-9)


def test_the_interval_of_the_ratio_covers() -> None:
    hits = 0
    for seed in range(200):
        rng = np.random.default_rng(seed)
        wide, narrow = (sample_of(3.0 + std * rng.standard_normal(2000)) for std in (0.06, 0.05))
        low, high = rms_ratio(wide, narrow, 3.0)[1]
        hits += low < 1.2 < high
    assert 180 <= hits <= 199  # 95 % of 200, and four standard deviations


@pytest.mark.parametrize(("hits", "n"), [(0, 3000), (1, 20), (7, 100), (20, 20)])
def test_clopper_pearson_is_the_exact_interval(hits: int, n: int) -> None:
    exact = stats.binomtest(hits, n).proportion_ci(0.95, method="exact")
    assert clopper_pearson(hits, n) == pytest.approx((exact.low, exact.high), abs=1e-12)


def test_one_replicate_has_no_statistics() -> None:
    with pytest.raises(ValueError, match="at least 101"):
        exit_statistics(sample_of(np.full(100, 3.0)), 3.0)
