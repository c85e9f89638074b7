"""The command by a sorted list of thresholds is the one that a search over commands finds."""

from __future__ import annotations

import numpy as np
import pytest

from synth.aim.limit_speed import thresholds_of

BOUNDS = (0.5, 6.0)
GRID = np.arange(0.5, 6.0, 0.001)


@pytest.mark.parametrize("p", [0.02, 0.1, 0.5])
def test_the_limit_is_the_highest_command_of_a_search(p: float) -> None:
    thresholds = np.random.default_rng(1).normal(2.5, 0.6, (997, 3)) + np.array([0.0, 0.4, 0.8])
    limits = thresholds_of(thresholds).limit_speeds(p, BOUNDS)
    for k, limit in enumerate(limits):
        kept = GRID[(thresholds[:, k] < GRID[:, None]).mean(axis=1) <= p]
        assert kept[-1] <= limit < kept[-1] + 0.001


def test_weighted_limits_count_each_cut_by_its_weight() -> None:
    rng = np.random.default_rng(2)
    thresholds, weights = rng.normal(2.5, 0.6, (200, 2)), rng.integers(0, 5, 200)
    repeated = np.repeat(thresholds, weights, axis=0)
    weighted = thresholds_of(thresholds).weighted_limit_speeds(weights.astype(float), 0.1, BOUNDS)
    assert weighted == pytest.approx(thresholds_of(repeated).limit_speeds(0.1, BOUNDS))


def test_overspeed_is_the_share_of_lower_thresholds() -> None:
    thresholds = np.array([[1.0, 5.0], [2.0, 6.0], [3.0, 7.0], [4.0, 8.0]])
    listed = thresholds_of(thresholds)
    assert listed.overspeed(np.array([2.5, 4.0])).tolist() == [0.5, 0.0]
    assert listed.overspeed(np.array([2.0, 9.0])).tolist() == [0.25, 1.0]  # at its own threshold no cut is too fast


def test_no_command_where_the_lowest_is_too_fast_and_never_above_the_upper_bound() -> None:
    thresholds = np.stack([np.linspace(0.0, 1.0, 100), np.linspace(8.0, 9.0, 100)], axis=1)
    limits = thresholds_of(thresholds).limit_speeds(0.1, BOUNDS)
    assert np.isnan(limits[0])
    assert limits[1] == 6.0
