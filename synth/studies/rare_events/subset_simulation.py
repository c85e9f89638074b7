"""Subset simulation of the closed loop: passes are split at rising levels and moved on by a Markov chain.

Au & Beck, Prob. Eng. Mech. 16 (2001); moves are preconditioned Crank–Nicolson steps (Cotter et al., Stat. Sci. 28,
2013) in *all* random numbers of a pass, so nothing is assumed about which of them matter. The levels are fixed by
a pilot run, therefore the product of survival shares is unbiased for any number of particles and any number of
moves (Del Moral, Feynman–Kac Formulae, 2004, §7.4), and independent replicates give the interval.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.simulation.random_passes import NOISE_SAMPLES, RandomPasses
from synth.studies.rare_events.pass_coordinates import BELOW_ONE
from synth.studies.rare_events.pass_score import PassScore
from synth.studies.rare_events.tail_probability import TailProbability, sampled_tail

STEPS = (0.1, 0.3, 0.6, 1.0)
"""Sizes of a move, drawn anew for every particle and move; 1 forgets where it was."""

SCALARS = 4
"""cut, entry, resistance and phase; the numbers of path and sensor follow."""

PILOT, REPLICATE = 0, 1
"""First number of the spawn key of a random stream."""


@dataclass(frozen=True)
class SubsetPlan:
    """Size of a run: independent `replicates` of `particles` each, `moves` of all particles at every level.

    `share`: of the pilot's particles that survive a level; `most_levels` ends a pilot that gets nowhere.
    """

    replicates: int = 24
    particles: int = 1000
    moves: int = 4
    share: float = 0.15
    most_levels: int = 30

    def __post_init__(self) -> None:
        if self.replicates < 3 or self.particles < 20 or self.moves < 1 or not 0.0 < self.share < 1.0:
            raise ValueError("subset plan: at least 3 replicates, 20 particles, 1 move and a share within (0, 1)")


@dataclass(frozen=True)
class SubsetEstimate:
    """`tails` at the margins asked for, the `levels_m_s` used, share of `accepted` moves at each level."""

    tails: tuple[TailProbability, ...]
    levels_m_s: tuple[float, ...]
    accepted: tuple[float, ...]


def subset_tails(
    score: PassScore, path_cells: int, margins_m_s: Sequence[float], seed: int, plan: SubsetPlan, threads: int = 1
) -> SubsetEstimate:
    """P(score > margin) for all margins; `path_cells`: how many numbers along the path the score looks at."""
    from scipy.special import stdtrit  # start-up: scipy only where it is needed

    margins = tuple(sorted(margins_m_s))
    levels, spent = pilot_levels(score, path_cells, margins[-1], seed, plan)

    def one(replicate: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        rng = stream(seed, REPLICATE, replicate)
        return climb(score, Swarm.drawn(rng, plan.particles, path_cells), levels, margins, plan.moves, rng)

    with ThreadPoolExecutor(max_workers=threads) as pool:
        found = list(pool.map(one, range(plan.replicates)))
    estimates = np.array([estimate for estimate, _ in found])
    mean = estimates.mean(axis=0)
    error = estimates.std(axis=0, ddof=1) / math.sqrt(plan.replicates)
    quantile = float(stdtrit(plan.replicates - 1, 0.975))
    nominal = plan.replicates * plan.particles
    passes = spent + nominal * (1 + len(levels) * plan.moves)
    tails = tuple(
        sampled_tail(margin, float(p), float(e), quantile, nominal, "subset simulation", passes)
        for margin, p, e in zip(margins, mean, error, strict=True)
    )
    accepted = np.array([share for _, share in found]).mean(axis=0)
    return SubsetEstimate(tails, levels, tuple(float(share) for share in accepted))


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Swarm:
    """Particles as standard normal numbers: `scalars` (n, 4), `path` (n, C) and `noise` (n, 256) float32."""

    scalars: NDArray[np.float64]
    path: NDArray[np.float32]
    noise: NDArray[np.float32]

    @staticmethod
    def drawn(rng: np.random.Generator, count: int, path_cells: int) -> Swarm:
        """Particles of the true law."""
        return Swarm(
            rng.standard_normal((count, SCALARS)),
            rng.standard_normal((count, path_cells), dtype=np.float32),
            rng.standard_normal((count, NOISE_SAMPLES), dtype=np.float32),
        )

    def passes(self) -> RandomPasses:
        """The particles as passes; `path_z` is only as wide as the path has cells."""
        from scipy.special import ndtr  # start-up: scipy only where it is needed

        entry, resistance, phase = (np.minimum(ndtr(self.scalars[:, i]), BELOW_ONE) for i in (1, 2, 3))
        # Copies: passes freeze their arrays, and a swarm's belong to the swarm.
        first = self.scalars[:, 0].copy()
        noise, one = self.noise.copy(), np.ones(len(first))
        losses = np.ascontiguousarray(noise[:, -2:]).view(np.int64)[:, 0] & np.int64(2**63 - 1)  # told by the noise
        return RandomPasses(first, entry, phase, resistance, self.path.copy(), noise, losses, one)

    def chosen(self, rows: NDArray[np.int64]) -> Swarm:
        """Copies of the particles `rows`."""
        return Swarm(self.scalars[rows], self.path[rows], self.noise[rows])

    def proposed(self, rng: np.random.Generator) -> Swarm:
        """x·sqrt(1 − b²) + b·fresh, which leaves the standard normal law as it is; b drawn for each particle."""
        fresh = Swarm.drawn(rng, len(self.scalars), self.path.shape[1])
        b = rng.choice(np.array(STEPS), len(self.scalars))[:, None]
        keep = np.sqrt(1.0 - b**2)
        low_b, low_keep = b.astype(np.float32), keep.astype(np.float32)
        return Swarm(
            keep * self.scalars + b * fresh.scalars,
            low_keep * self.path + low_b * fresh.path,
            low_keep * self.noise + low_b * fresh.noise,
        )

    def where(self, taken: NDArray[np.bool_], other: Swarm) -> Swarm:
        """Particles of `other` where `taken`, else these."""
        rows = taken[:, None]
        return Swarm(
            np.where(rows, other.scalars, self.scalars),
            np.where(rows, other.path, self.path),
            np.where(rows, other.noise, self.noise),
        )


def stream(seed: int, *key: int) -> np.random.Generator:
    """The random stream of one run of `seed`."""
    return np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=key)))


def pilot_levels(
    score: PassScore, path_cells: int, highest_m_s: float, seed: int, plan: SubsetPlan
) -> tuple[tuple[float, ...], int]:
    """(levels below `highest_m_s` that each keep about `share` of the particles, passes spent on finding them)."""
    rng = stream(seed, PILOT)
    swarm = Swarm.drawn(rng, plan.particles, path_cells)
    scores = score(swarm.passes())
    levels: list[float] = []
    spent = plan.particles
    while len(levels) < plan.most_levels:
        level = float(np.quantile(scores, 1.0 - plan.share))
        if level >= highest_m_s or (levels and level <= levels[-1]) or not (scores > level).any():
            break
        levels.append(level)
        swarm, scores, _ = moved_on(score, swarm, scores, level, plan.moves, rng)
        spent += plan.particles * plan.moves
    return tuple(levels), spent


def climb(
    score: PassScore, swarm: Swarm, levels: tuple[float, ...], margins: tuple[float, ...], moves: int,
    rng: np.random.Generator,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:  # fmt: skip
    """One replicate: (estimates at the margins, accepted shares at the levels); a dead swarm leaves zeros."""
    scores = score(swarm.passes())
    estimates, accepted = np.zeros(len(margins)), np.zeros(len(levels))
    reached = 1.0
    for stage, level in enumerate((*levels, math.inf)):
        from_level = levels[stage - 1] if stage > 0 else -math.inf
        for i, margin in enumerate(margins):
            if from_level <= margin < level:
                estimates[i] = reached * float(np.mean(scores > margin))
        survived = float(np.mean(scores > level))
        reached *= survived
        if survived == 0.0:
            break
        swarm, scores, accepted[stage] = moved_on(score, swarm, scores, level, moves, rng)
    return estimates, accepted


def moved_on(
    score: PassScore, swarm: Swarm, scores: NDArray[np.float64], level: float, moves: int, rng: np.random.Generator
) -> tuple[Swarm, NDArray[np.float64], float]:
    """(particles above `level`, their scores, share of accepted moves): survivors drawn anew, then moved."""
    alive = np.flatnonzero(scores > level)
    rows = rng.choice(alive, len(scores))
    swarm, scores = swarm.chosen(rows), scores[rows]
    taken_in_all = 0
    for _ in range(moves):
        tried = swarm.proposed(rng)
        tried_scores = score(tried.passes())
        taken = tried_scores > level
        swarm, scores = swarm.where(taken, tried), np.where(taken, tried_scores, scores)
        taken_in_all += int(np.count_nonzero(taken))
    return swarm, scores, taken_in_all / (moves * len(scores))
