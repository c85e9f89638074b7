"""Rare events by sampling: exact weights, unbiased estimates of closed forms, honest intervals, the same bytes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import ndtr
from scipy.stats import multivariate_normal

from plant_models import Plant
from synth.simulation.closed_loop import close_loop
from synth.simulation.exit_statistics import NORMAL_95
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.studies.rare_events.cross_entropy import LearntComponents, Pilot, fitted, learn, mixture_of
from synth.studies.rare_events.gaussian_mixture import BROAD, NOMINAL, GaussianComponent, GaussianMixture
from synth.studies.rare_events.importance_sampling import WeightedPasses, weighted_passes
from synth.studies.rare_events.pass_coordinates import PassCoordinates, path_work_coordinates
from synth.studies.rare_events.subset_simulation import SubsetPlan, subset_tails
from synth.studies.rare_events.tail_probability import TailProbability, crude_tail, sampled_tail

TOY_CELLS = 4
TOY = PassCoordinates(np.full(TOY_CELLS, 0.5))
TOY_DIRECTION = np.array([-0.6, -0.4, 0.6, -math.sqrt(1.0 - 0.88)])
"""Unit vector: the toy score is standard normal, so P(score > x) = Φ(−x)."""

TILTED = GaussianComponent(
    np.array([-1.0, 0.5, 0.3, 0.0]), np.asarray(np.linalg.cholesky(0.5 * np.eye(4) + 0.2), float)
)


def toy_score(passes: RandomPasses) -> NDArray[np.float64]:
    """A linear limit state in the four coordinates."""
    score: NDArray[np.float64] = TOY.of(passes) @ TOY_DIRECTION
    return score


@pytest.fixture(scope="module")
def toy_passes() -> WeightedPasses:
    """20 000 weighted passes of the toy, drawn from what was learnt for tails at 2, 3.5 and 5."""
    learnt = learn(toy_score, TOY, (2.0, 3.5, 5.0), seed=1, pilot=Pilot(passes=2000), threads=2)
    assert len(learnt.components) == 3
    return weighted_passes(toy_score, TOY, mixture_of(learnt), seed=2, count=20_000, threads=2)


def test_weights_are_the_ratio_of_the_densities() -> None:
    law = GaussianMixture((NOMINAL, BROAD, TILTED), (0.2, 0.3, 0.5))
    x = 2.0 * np.random.default_rng(1).standard_normal((50, 4))
    used = np.array([20, 30, 51]) / 101  # 101 passes cannot be shared out exactly
    density = [multivariate_normal(c.mean, c.factor @ c.factor.T).pdf(x) for c in law.components]
    expected = density[0] / (used @ np.array(density))
    np.testing.assert_allclose(law.weights(x, 101), expected, rtol=1e-12)
    assert law.weights(x, 101).max() <= 1.0 / used[0]


def test_a_moved_pass_stands_where_it_was_put_and_keeps_the_rest() -> None:
    passes = random_passes(3, 0, 200)
    here = TOY.of(passes)
    there = 1.5 * here - 0.7
    moved = TOY.moved(passes, here, there)
    np.testing.assert_allclose(TOY.of(moved), there, atol=2e-6)  # path_z is float32
    across = np.array([[1.0, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -1.0]])
    np.testing.assert_allclose(moved.path_z[:, :4] @ across.T, passes.path_z[:, :4] @ across.T, atol=2e-6)
    for name in ("noise_z", "phase_u"):
        np.testing.assert_array_equal(getattr(moved, name), getattr(passes, name))
    np.testing.assert_array_equal(moved.path_z[:, 4:], passes.path_z[:, 4:])


def test_the_direction_along_the_path_is_the_gradient_of_the_brake_work(plant_22t: Plant) -> None:
    loop = close_loop(plant_22t, 3)
    coordinates, path = path_work_coordinates(loop), loop.path
    cells = len(path.gravity_m_s2)

    def work(z: NDArray[np.float64]) -> float:
        x, total = 0.0, 0.0
        for j in range(cells):
            x = path.eta_memory[j] * x + path.eta_fresh[j] * z[j]
            total += path.brake_m_s2_per_kpa[j] * path.eta_std[j] * x * (path.edges_m[j + 1] - path.edges_m[j])
        return total

    gradient = np.array([work(row) for row in np.eye(cells)])
    np.testing.assert_allclose(coordinates.direction, gradient / np.linalg.norm(gradient), rtol=1e-12)


def test_weights_have_mean_one_and_coordinates_their_law(toy_passes: WeightedPasses) -> None:
    """Within 4 standard errors: mean weight 1, mean of each coordinate 0, of its square 1."""
    for values, expected in (
        (np.ones(len(toy_passes)), 1.0),
        *((toy_passes.coordinates[:, i], 0.0) for i in range(4)),
        *((toy_passes.coordinates[:, i] ** 2, 1.0) for i in range(4)),
    ):
        found, error = toy_passes.mean(values)
        assert abs(found - expected) < 4.0 * error, f"{found} ± {error}, not {expected}"


@pytest.mark.parametrize("limit", [-4.0, 0.0, 2.0, 3.5, 5.0])
def test_importance_sampling_gives_the_normal_tail(toy_passes: WeightedPasses, limit: float) -> None:
    """Within 4 standard errors, tails to 3e-7, and these within some per cent; −4 is a limit that nobody learnt."""
    found, expected = toy_passes.tail(limit), float(ndtr(-limit))
    rare = min(expected, 1.0 - expected)
    error = math.log(min(found.high, 1.0 - found.low) / min(found.probability, 1.0 - found.probability)) / NORMAL_95
    assert error < (1.0 if limit < 0.0 else 0.08)
    assert abs(found.probability - expected) < 4.0 * error * rare


def test_importance_sampling_gives_the_rms_and_foretells_its_gain(toy_passes: WeightedPasses) -> None:
    """The positive part of a normal number, cubed, has a heavy tail: E x⁶ / 2 = 7.5, E x¹² / 2 = 5197.5."""
    cubed = WeightedPasses(
        np.maximum(toy_passes.score, 0.0) ** 3,
        toy_passes.weight.copy(),
        toy_passes.coordinates.copy(),
        toy_passes.ends.copy(),
    )
    rms = cubed.root_mean_square()
    spread = math.log(rms.rms_ci95_m_s[1] / rms.rms_m_s) / NORMAL_95
    assert abs(math.log(rms.rms_m_s / math.sqrt(7.5))) < 4.0 * spread
    exact = (5197.5 - 7.5**2) / 20_000 / (2.0 * 7.5 * spread) ** 2
    assert rms.gain == pytest.approx(exact, rel=0.3)
    assert rms.gain > 10.0


def test_subset_simulation_is_unbiased_and_its_intervals_cover() -> None:
    """12 runs: mean / truth within 4 standard errors of 1 at 1e-2 and 3e-5; at least 17 of 24 intervals cover."""
    limits, covered = (2.3, 4.0), 0
    plan = SubsetPlan(replicates=8, particles=150, moves=3)
    runs = [subset_tails(toy_score, TOY_CELLS, limits, seed, plan, threads=2) for seed in range(12)]
    for i, limit in enumerate(limits):
        expected = float(ndtr(-limit))
        ratio = np.array([run.tails[i].probability for run in runs]) / expected
        error = ratio.std(ddof=1) / math.sqrt(len(runs))
        assert error < 0.2
        assert abs(ratio.mean() - 1.0) < 4.0 * error
        covered += sum(run.tails[i].low <= expected <= run.tails[i].high for run in runs)
    assert covered >= 17


def test_sampling_does_not_depend_on_threads() -> None:
    law = mixture_of(LearntComponents((TILTED,), 0))
    one, two = (weighted_passes(toy_score, TOY, law, 5, 4500, threads=n) for n in (1, 2))
    assert one.score.tobytes() == two.score.tobytes()
    assert one.weight.tobytes() == two.weight.tobytes()
    plan = SubsetPlan(replicates=3, particles=50, moves=2)
    first, second = (subset_tails(toy_score, TOY_CELLS, (1.0, 3.0), 5, plan, threads=n) for n in (1, 2))
    assert first == second
    assert first != subset_tails(toy_score, TOY_CELLS, (1.0, 3.0), 6, plan, threads=2)


def test_what_never_and_what_always_happens() -> None:
    def bounded(passes: RandomPasses) -> NDArray[np.float64]:
        return np.asarray(passes.entry_u, dtype=np.float64)

    learnt = learn(bounded, TOY, (1.5,), seed=1, pilot=Pilot(passes=500, rounds=2))
    assert learnt.components == ()
    found = weighted_passes(bounded, TOY, mixture_of(learnt), seed=2, count=2000)
    subset = subset_tails(bounded, TOY_CELLS, (-0.5, 1.5), 3, SubsetPlan(replicates=3, particles=100, most_levels=3))
    for never in (found.tail(1.5), subset.tails[1]):
        assert (never.probability, never.low) == (0.0, 0.0)
        assert 0.0 < never.high < 0.02
    for always in (found.tail(-0.5), subset.tails[0]):
        assert (always.probability, always.high) == (1.0, 1.0)
        assert 0.98 < always.low < 1.0


def test_a_fit_is_the_weighted_mean_and_covariance() -> None:
    x = np.random.default_rng(2).standard_normal((400, 4)) * [1.0, 2.0, 0.5, 1.0] + [3.0, 0.0, -1.0, 0.0]
    twice = np.concatenate([x[:100], x[:100], x[100:]])
    weighted = fitted(x, np.where(np.arange(400) < 100, 2.0, 1.0))
    repeated = fitted(twice, np.ones(500))
    np.testing.assert_allclose(weighted.mean, repeated.mean, rtol=1e-12)
    np.testing.assert_allclose(weighted.factor, repeated.factor, rtol=1e-12, atol=1e-12)


def test_intervals_of_tails() -> None:
    """Normal in the logarithm, mirrored above ½, exact without variance; gaps as defined; nonsense refused."""
    small = sampled_tail(0.3, 1e-5, 1e-6, NORMAL_95, 100, "m", 1000)
    assert (small.low, small.high) == pytest.approx((8.22e-6, 1.2165e-5), rel=1e-3)
    large = sampled_tail(0.3, 1.0 - 1e-5, 1e-6, NORMAL_95, 100, "m", 1000)
    assert (1.0 - large.high, 1.0 - large.low) == pytest.approx((8.22e-6, 1.2165e-5), rel=1e-3)
    assert crude_tail(0.3, 0, 1000).high == pytest.approx(1.0 - 0.025**0.001, rel=1e-9)
    left, right = (TailProbability(0.3, p, p - 0.1, p + 0.1, "m", 1) for p in (0.2, 0.5))
    assert left.gap(right) == right.gap(left) == pytest.approx(1.5)
    assert left.gap(left) == 0.0
    with pytest.raises(ValueError, match="no interval"):
        TailProbability(0.3, 0.5, 0.6, 0.7, "m", 1)


def test_mixtures_without_the_true_law_or_with_too_few_passes_are_refused() -> None:
    with pytest.raises(ValueError, match="the first component must be the true law"):
        GaussianMixture((BROAD, NOMINAL), (0.5, 0.5))
    with pytest.raises(ValueError, match="must sum to 1"):
        GaussianMixture((NOMINAL, BROAD), (0.5, 0.6))
    with pytest.raises(ValueError, match="fewer than 2"):
        GaussianMixture((NOMINAL, BROAD), (0.5, 0.5)).ends(3)
