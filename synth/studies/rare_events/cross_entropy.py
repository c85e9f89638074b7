"""Where to draw passes for a rare event: a proposal learnt on pilot passes by the cross-entropy method.

Rubinstein & Kroese, The Cross-Entropy Method (2004), ch. 3: of all normal laws the one nearest to the law of passes
given the event has its mean and covariance, and both are weighted means over passes drawn from any other law.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from synth.studies.rare_events.gaussian_mixture import BROAD, NOMINAL, GaussianComponent, GaussianMixture
from synth.studies.rare_events.importance_sampling import weighted_passes
from synth.studies.rare_events.pass_coordinates import DIMENSIONS, PassCoordinates
from synth.studies.rare_events.pass_score import PassScore

RIDGE = 0.02
"""Added to the variances of a fit: few pilot hits in a row must not make a law that is too narrow to leave."""


@dataclass(frozen=True)
class Pilot:
    """How much is spent on learning: `passes` a round, the `elite` share that a level keeps, at most `rounds`.

    A small elite on purpose: the first level must lie above the plain noise of good passes.
    """

    passes: int = 4000
    elite: float = 0.015
    rounds: int = 10

    def __post_init__(self) -> None:
        if self.passes < 100 or not 0.0 < self.elite < 1.0 or self.rounds < 1:
            raise ValueError("pilot: at least 100 passes, an elite share within (0, 1) and one round are needed")


@dataclass(frozen=True)
class LearntComponents:
    """One component for each margin that could be reached, in rising order, and the pilot passes spent."""

    components: tuple[GaussianComponent, ...]
    passes: int


def learn(
    score: PassScore, coordinates: PassCoordinates, margins_m_s: Sequence[float], seed: int, pilot: Pilot,
    threads: int = 1,
) -> LearntComponents:  # fmt: skip
    """Components for every margin, each begun where the one before ended.

    Rounds draw from the true law, the broad one and the current fit. The broad law is what finds cuts without brake
    power at once: begun at the true law, the levels climb into the plain noise of good passes instead and stay
    there (seen for 36 t to 3 m/s). A margin that no round reaches ends the list; nothing is assumed about it.
    """
    learnt: list[GaussianComponent] = []
    spent, current = 0, BROAD
    for margin in sorted(margins_m_s):
        reached = False
        for turn in range(pilot.rounds):
            law = GaussianMixture((NOMINAL, BROAD, current), (0.1, 0.4, 0.5))
            found = weighted_passes(score, coordinates, law, seed, pilot.passes, spent, threads)
            spent += pilot.passes
            level = min(margin, float(np.quantile(found.score, 1.0 - pilot.elite)))
            hits = found.score > level
            if np.count_nonzero(hits) > 2 * DIMENSIONS:
                current = fitted(found.coordinates[hits], found.weight[hits])
            reached = level >= margin
            if reached and turn > 0:
                break
        if not reached:
            break
        learnt.append(current)
    return LearntComponents(tuple(learnt), spent)


def fitted(x: NDArray[np.float64], weight: NDArray[np.float64]) -> GaussianComponent:
    """The normal law with the weighted mean and covariance of `x` (n, 4), widened by `RIDGE`."""
    share = weight / weight.sum()
    mean = share @ x
    apart = x - mean
    covariance = (apart * share[:, None]).T @ apart + RIDGE * np.eye(x.shape[1])
    return GaussianComponent(mean, np.linalg.cholesky(covariance))


def mixture_of(learnt: LearntComponents, nominal: float = 0.1, broad: float = 0.1) -> GaussianMixture:
    """`nominal` of the passes from the true law, `broad` from the broad one, the rest in equal parts from the fits.

    For probabilities take few from the true law. For the rms take half: the second moment of the terms is then at
    most twice that of plain passes, and much less where rare passes make the mean square. Without any fit the true
    law takes the share of the fits.
    """
    count = len(learnt.components)
    if count == 0:
        return GaussianMixture((NOMINAL, BROAD), (1.0 - broad, broad))
    fits = (1.0 - nominal - broad) / count
    return GaussianMixture((NOMINAL, BROAD, *learnt.components), (nominal, broad, *([fits] * count)))
