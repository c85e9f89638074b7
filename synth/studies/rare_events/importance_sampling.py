"""Importance sampling of the closed loop: passes drawn where it matters, weighted back exactly."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.simulation.closed_loop import CHUNK_PASSES
from synth.simulation.exit_statistics import NORMAL_95, rms_interval
from synth.simulation.random_passes import random_passes
from synth.studies.rare_events.gaussian_mixture import GaussianMixture
from synth.studies.rare_events.pass_coordinates import DIMENSIONS, PassCoordinates
from synth.studies.rare_events.pass_score import PassScore
from synth.studies.rare_events.tail_probability import TailProbability, sampled_tail


@frozen_arrays
@dataclass(frozen=True, eq=False)
class WeightedPasses:
    """n passes of a mixture: `score` (n,), `weight` (n,), `coordinates` (n, 4), `ends` (K,) of the components."""

    score: NDArray[np.float64]
    weight: NDArray[np.float64]
    coordinates: NDArray[np.float64]
    ends: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.score)

    def mean(self, values: NDArray[np.float64]) -> tuple[float, float]:
        """(estimate of the expectation of `values` (n,) under the true law, its standard error).

        The error is that of a stratified sample: how many passes a component draws is no chance.
        """
        terms = self.weight * values
        variance = sum(len(part) * float(part.var(ddof=1)) for part in np.split(terms, self.ends[:-1]))
        return float(terms.mean()), math.sqrt(variance) / len(terms)

    def tail(self, margin_m_s: float) -> TailProbability:
        """P(score > margin) with a 95 % interval; above ½ by its complement, whose weights vary less."""
        over = self.score > margin_m_s
        probability, error = self.mean(over.astype(np.float64))
        if probability > 0.5:
            rest, error = self.mean((~over).astype(np.float64))
            probability = 1.0 - rest
        return sampled_tail(
            margin_m_s, probability, error, NORMAL_95, int(self.ends[0]), "importance sampling", len(self)
        )

    def root_mean_square(self) -> WeightedRms:
        """Rms of the score, with the gain over plain passes, both from these passes."""
        square, error = self.mean(self.score**2)
        fourth, _ = self.mean(self.score**4)
        plain = (fourth - square**2) / len(self)
        return WeightedRms(math.sqrt(square), rms_interval(square, error), plain / error**2, len(self))

    def effective_passes(self, margin_m_s: float) -> float:
        """(Σ w)² / Σ w² over the passes above `margin_m_s`: how many equal weights their spread is worth."""
        hits = self.weight[self.score > margin_m_s]
        return float(hits.sum() ** 2 / (hits**2).sum()) if len(hits) else 0.0


@dataclass(frozen=True)
class WeightedRms:
    """Rms in m/s with its 95 % interval; `gain`: variance of the mean square by as many plain passes / by these."""

    rms_m_s: float
    rms_ci95_m_s: tuple[float, float]
    gain: float
    passes: int


def weighted_passes(
    score: PassScore, coordinates: PassCoordinates, law: GaussianMixture, seed: int, count: int,
    first_pass: int = 0, threads: int = 1,
) -> WeightedPasses:  # fmt: skip
    """Score `count` passes of `seed` from `first_pass` on, with their coordinates drawn from `law` instead.

    The result does not depend on `threads`.
    """

    def chunk(start: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        passes = random_passes(seed, first_pass + start, min(CHUNK_PASSES, count - start))
        here = coordinates.of(passes)
        there = law.placed(here, start, count)
        return there, score(coordinates.moved(passes, here, there))

    law.ends(count)  # refuses a count too small before anything is simulated
    with ThreadPoolExecutor(max_workers=threads) as pool:
        parts = list(pool.map(chunk, range(0, count, CHUNK_PASSES)))
    x = np.concatenate([part[0] for part in parts]).reshape(count, DIMENSIONS)
    scores = np.concatenate([part[1] for part in parts])
    return WeightedPasses(scores, law.weights(x, count), x, law.ends(count))
