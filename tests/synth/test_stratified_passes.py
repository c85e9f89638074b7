"""Strata and weights against the law that they stand for, and the row of passes against itself."""

from __future__ import annotations

import numpy as np
import pytest

from synth.simulation.random_passes import random_passes
from synth.simulation.replicates import REPLICATE_PASSES, mean_of, quantiles_of, rms_of, share_of
from synth.simulation.stratified_passes import AS_THEY_COME, stratified_passes
from tests.effort import every

N = 100_000


def test_weights_give_the_moments_of_a_standard_normal_number() -> None:
    passes = stratified_passes(1, 0, N, path_cells=1)
    assert passes.weight.max() <= 2.0
    assert passes.weight.mean() == pytest.approx(1.0, abs=1e-3)
    for power, moment in ((1, 0.0), (2, 1.0), (3, 0.0), (4, 3.0)):
        found = mean_of(passes.cut_z**power, passes.weight)
        assert abs(found.value - moment) < 2.0 * found.half_width + 1e-3, power
    low = float(np.sum(passes.weight[passes.cut_z < -3.5]) / N)
    assert low == pytest.approx(2.326e-4, rel=0.03)  # a plain sample of this size meets 23 of these


def test_every_replicate_has_one_pass_in_every_stratum() -> None:
    passes = stratified_passes(2, 0, 3000, path_cells=1)
    for name in ("entry_u", "phase_u", "resistance_u"):
        strata = np.floor(getattr(passes, name).reshape(-1, REPLICATE_PASSES) * REPLICATE_PASSES)
        assert np.array_equal(np.sort(strata, axis=1), np.tile(np.arange(REPLICATE_PASSES), (30, 1))), name
    below_median = (passes.cut_z.reshape(-1, REPLICATE_PASSES) < -2.0).sum(axis=1)
    assert np.all((below_median >= AS_THEY_COME // 2) & (below_median <= AS_THEY_COME // 2 + 3))


def test_a_pass_does_not_depend_on_the_others_asked_for() -> None:
    whole, part = stratified_passes(3, 0, 2500, path_cells=40), stratified_passes(3, 1234, 321, path_cells=40)
    for name, array in vars(part).items():
        assert np.array_equal(array, getattr(whole, name)[1234 : 1234 + 321]), name
    assert np.array_equal(whole.path_z, random_passes(3, 0, 2500, 40).path_z)


@pytest.mark.requirement("PRED-05")
@pytest.mark.parametrize("passes", every(2, [1000, 5000]))
def test_intervals_hold_the_truth_in_95_of_100_samples(passes: int) -> None:
    """A squared error with a rare heavy tail, of which everything is known: e = 0.03 ± noise, but 1.5 z below −3."""
    trials, tail = 500, 1.3498980e-3
    square = tail + (1.0 - tail) * 0.06**2 / 12.0
    held = {"rms": 0, "share": 0, "quantile": 0}
    for trial in range(trials):
        row = stratified_passes(4, trial * passes, passes, path_cells=1)  # the whole row would fill gigabytes
        out = row.cut_z < -3.0
        error = np.where(out, 1.0, 0.06 * (row.entry_u - 0.5))
        low, high = rms_of(error + 0.01 * row.noise_z[:, 0], row.weight)[1]
        held["rms"] += low <= np.sqrt(square + 0.01**2) <= high
        low, high = share_of(out, row.weight)[1]
        held["share"] += low <= tail <= high
        low, high = quantiles_of(row.entry_u, row.weight, (0.95,))[0][1]
        held["quantile"] += low <= 0.95 <= high
    # 95 % ± 4 standard errors of 500 trials; the strata leave the uniform number next to no error.
    assert 0.911 <= held["rms"] / trials <= 0.989
    assert 0.911 <= held["share"] / trials <= 1.0
    assert 0.90 <= held["quantile"] / trials <= 1.0


def test_a_share_without_a_hit_has_an_upper_limit() -> None:
    """P(no hit) at the limit is 2.5 % for plain passes, and no more for weighted ones."""
    none = np.zeros(1000, dtype=np.bool_)
    share, (low, high) = share_of(none, np.ones(1000))
    assert (share, low) == (0.0, 0.0)
    assert (1.0 - high) ** 1000 == pytest.approx(0.025, rel=1e-9)
    assert share_of(none, np.full(1000, 2.0))[1][1] == pytest.approx(2.0 * high)
    assert share_of(~none, np.ones(1000))[1] == (1.0 - high, 1.0)


def test_a_share_that_rounds_to_1_has_an_interval() -> None:
    """One pass of the least weight that a low friction can have is not met, all others are."""
    hits, weight = np.ones(1000, dtype=np.bool_), np.ones(1000)
    hits[7], weight[7] = False, 1e-16
    share, (low, high) = share_of(hits, weight)
    assert share == 1.0
    assert 0.999 < low <= high <= 1.0
