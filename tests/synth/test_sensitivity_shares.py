"""Shares of variance on functions whose shares are known by pencil and paper."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from SALib.analyze import rbd_fast

from synth.retarder.sensitivity.hypercube import unit_hypercube
from synth.retarder.sensitivity.outputs import OUTPUTS
from synth.retarder.sensitivity.ranking import UNDECIDABLE, measure_first
from synth.retarder.sensitivity.sensitivity import OutputShares, mean_of_cases, output_shares
from synth.retarder.sensitivity.shares import FEWEST_POINTS, GROUPS, HARMONICS, first_order, noise_share
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.passes import ExitSample

Floats = NDArray[np.float64]
INPUTS, POINTS = 12, 600

WEIGHTS = np.array([4.0, 3.0, 2.0, 1.0, *([0.0] * (INPUTS - 4))])
LINEAR = WEIGHTS**2 / (WEIGHTS**2).sum()
"""A sum of independent terms: each share is its part of the sum of squares."""


def standard(unit: Floats) -> Floats:
    """Uniform numbers of mean 0 and variance 1."""
    return (unit - 0.5) * float(np.sqrt(12.0))


def linear(unit: Floats) -> Floats:
    return np.asarray(standard(unit) @ WEIGHTS)


def shares_of(seed: int, points: int = POINTS) -> OutputShares:
    unit = unit_hypercube(INPUTS, points, seed)
    return output_shares(OUTPUTS[0], unit, linear(unit), linear(unit)[:100])


def test_intervals_hold_the_shares_of_a_linear_function() -> None:
    held = [
        [share.ci95[0] <= true <= share.ci95[1] for share, true in zip(shares_of(seed).shares, LINEAR, strict=True)]
        for seed in range(40)
    ]
    assert np.mean(held, axis=0).min() >= 0.85  # of 40: three standard errors under 95 %
    assert np.mean(held) >= 0.95


def test_intervals_are_no_wider_than_they_must_be() -> None:
    """A wide interval would hold everything: half of one is a few standard deviations of the estimate over seeds."""
    found = [shares_of(seed) for seed in range(40)]
    spread = np.std([[share.value for share in each.shares] for each in found], axis=0)
    half = np.mean([[0.5 * (s.ci95[1] - s.ci95[0]) for s in each.shares] for each in found], axis=0)
    assert (half <= 7.0 * spread).all()
    assert half.max() < 0.1


def test_shares_of_a_sum_are_all_and_those_of_a_product_are_none() -> None:
    unit = unit_hypercube(INPUTS, 2000, 5)
    x = standard(unit)
    # Variance of 2·x0: 4; of x1·x2: 1, none of it by one input alone; so 0.8 and 0.2.
    found = first_order(unit, 2.0 * x[:, 0] + x[:, 1] * x[:, 2])
    assert found.share(0).value == pytest.approx(0.8, abs=0.04)
    assert not found.share(1).decided
    assert not found.share(2).decided
    low, high = found.rest.share(0).ci95
    assert low <= 0.2 <= high
    whole = first_order(unit, linear(unit)).rest.share(0)
    assert whole.ci95[0] <= 0.0 <= whole.ci95[1]


def ishigami(unit: Floats) -> Floats:
    """sin x + 7 sin² y + 0.1 z⁴ sin x, all within ±π."""
    x, y, z = (2.0 * np.pi * (unit - 0.5)).T
    return np.asarray(np.sin(x) * (1.0 + 0.1 * z**4) + 7.0 * np.sin(y) ** 2)


@pytest.mark.parametrize("points", [200, 801, 4000])
def test_estimates_are_those_of_salib(points: int) -> None:
    """On the points of a hypercube, all of them and those that the jackknife keeps."""
    unit = unit_hypercube(3, points, 7)
    output, place = ishigami(unit), np.arange(points) % GROUPS
    found = first_order(unit, output)
    problem = {"num_vars": 3, "names": ["x", "y", "z"], "bounds": [[0.0, 1.0]] * 3}
    for ours, kept in ((found.whole, place >= 0), (found.without[4], place != 4)):
        theirs = rbd_fast.analyze(problem, unit[kept], output[kept], M=HARMONICS, num_resamples=2)
        np.testing.assert_allclose(ours, theirs["S1"], rtol=0.0, atol=1e-12)


def test_noise_of_the_passes_is_told_apart() -> None:
    """Noise of variance 1 on a signal of variance 4, and a shift of all repeats: share 1/5."""
    rng = np.random.default_rng(3)
    held = 0
    for seed in range(40):
        signal = 2.0 * standard(unit_hypercube(1, 1000, seed))[:, 0]
        once, twice = rng.normal(size=1000), rng.normal(size=100)
        share = noise_share(signal + once, signal[:100] + twice + 7.0).share(0)
        held += share.ci95[0] <= 0.2 <= share.ci95[1]
    assert held >= 34


def test_an_output_that_does_not_vary_has_no_shares() -> None:
    unit = unit_hypercube(3, FEWEST_POINTS, 1)
    found = output_shares(OUTPUTS[2], unit, np.zeros(FEWEST_POINTS), np.zeros(100))
    assert not found.varies
    assert all(share.value == 0.0 for share in found.shares)
    assert "nothing has to be measured" in measure_first(("a", "b", "c"), found)


def test_too_few_points_are_refused() -> None:
    with pytest.raises(ValueError, match="199 points; at least 200"):
        first_order(np.zeros((199, 2)), np.zeros(199))


def test_the_sentence_names_the_largest_decided_shares_first() -> None:
    names = tuple("abcdefghijkl")
    assert measure_first(names, shares_of(1)).startswith("measure first, for the rms exit error: a, 5")
    unit = unit_hypercube(INPUTS, FEWEST_POINTS, 1)
    noise = np.random.default_rng(0).normal(size=FEWEST_POINTS)
    sentence = measure_first(names[:1], output_shares(OUTPUTS[0], unit[:, :1], noise, noise[:100]))
    assert UNDECIDABLE in sentence


def test_a_mean_over_cases_leaves_out_those_without_variance() -> None:
    one = shares_of(1)
    unit = unit_hypercube(INPUTS, POINTS, 1)
    still = output_shares(OUTPUTS[0], unit, np.zeros(POINTS), np.zeros(100))
    assert mean_of_cases([one, still]).shares == mean_of_cases([one]).shares == one.shares


def test_outputs_are_those_of_the_exit_statistics() -> None:
    rng = np.random.default_rng(4)
    speed = rng.normal(3.0, 0.4, size=500)
    sample = ExitSample(
        speed, np.zeros(500, dtype=np.bool_), np.zeros(500, dtype=np.int32), np.ones(500), rng.random(500)
    )
    known = exit_statistics(sample, 3.0)
    told = [output.of(sample, 3.0) for output in OUTPUTS]
    assert told == pytest.approx([known.rms_m_s, known.bias_m_s, known.overspeed], rel=1e-12)
