"""The experiments on one table: one parameter at a time, sweeps, all parameters together, named conditions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import frozen_arrays
from synth.simulation.exit_statistics import clopper_pearson
from synth.studies.robustness.parameter import Parameter
from synth.studies.robustness.perturbation import Ends, Perturbation, all_off, one_off
from synth.studies.robustness.trial import Outcome, Trial

Item = TypeVar("Item")
Found = TypeVar("Found")

CLIFF = 2.0
"""A step of a sweep that multiplies the rms by more than this is called a cliff."""


@dataclass(frozen=True)
class BothSigns:
    """One parameter below and above its nominal value, all else nominal."""

    parameter: Parameter
    less: Outcome
    more: Outcome

    @property
    def worst(self) -> Outcome:
        """The one with the larger rms."""
        return max(self.less, self.more, key=lambda outcome: outcome.statistics.rms_m_s)


@dataclass(frozen=True)
class Sweep:
    """One parameter over a range: `relative` (n,) ascending, with 0, and the outcomes."""

    parameter: Parameter
    relative: tuple[float, ...]
    outcomes: tuple[Outcome, ...]

    @property
    def rms_m_s(self) -> tuple[float, ...]:
        """Simulated rms at each point."""
        return tuple(outcome.statistics.rms_m_s for outcome in self.outcomes)

    @property
    def steepest(self) -> float:
        """The largest rms ratio between neighbouring points."""
        return max(max(a, b) / min(a, b) for a, b in pairwise(self.rms_m_s))

    def tolerated(self, limit_m_s: float) -> tuple[float | None, float | None]:
        """How far the parameter may fall and rise before the rms passes the limit; None where it never does.

        Linear between the points; (0, 0) where the nominal plant itself is beyond it.
        """
        centre = self.relative.index(0.0)
        rms = np.array(self.rms_m_s)
        if rms[centre] > limit_m_s:
            return 0.0, 0.0
        down = first_crossing(self.relative[centre::-1], rms[centre::-1], limit_m_s)
        return down, first_crossing(self.relative[centre:], rms[centre:], limit_m_s)


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Together:
    """All assumed parameters off at once, at n points of a Latin hypercube over ±`span`.

    `relative` (n, parameters), `rms_m_s` (n,), shares of over-speed and stalls (n,); `rank_correlation` (parameters,)
    of the rms with the parameters (Spearman).
    """

    parameters: tuple[Parameter, ...]
    span: float
    passes: int
    relative: NDArray[np.float64]
    rms_m_s: NDArray[np.float64]
    overspeed: NDArray[np.float64]
    stalls: NDArray[np.float64]
    rank_correlation: NDArray[np.float64]

    def share_within(self, limit_m_s: float) -> tuple[float, tuple[float, float]]:
        """Share of the points whose rms is within the limit, and its 95 % interval."""
        hits, n = int(np.count_nonzero(self.rms_m_s <= limit_m_s)), len(self.rms_m_s)
        return hits / n, clopper_pearson(hits, n)

    def quantile_m_s(self, share: float) -> tuple[float, tuple[float, float]]:
        """Quantile of the rms over the points, and its 95 % interval from order statistics."""
        from scipy.stats import binom  # start-up: scipy only where it is needed

        ordered, n = np.sort(self.rms_m_s), len(self.rms_m_s)
        low, high = (int(binom.ppf(tail, n, share)) for tail in (0.025, 0.975))
        return float(np.quantile(ordered, share)), (float(ordered[max(low - 1, 0)]), float(ordered[min(high, n - 1)]))


def one_at_a_time(
    trial: Trial, parameters: Sequence[Parameter], ends: Callable[[Plant, Parameter], Ends], threads: int
) -> tuple[BothSigns, ...]:
    """Every parameter at both `ends` (of `perturbation.ends_by` or `sensible_ends`), the largest rms first."""

    def both(parameter: Parameter) -> BothSigns:
        less, more = (trial.outcome(perturbation) for perturbation in ends(trial.plant, parameter))
        return BothSigns(parameter, less, more)

    return tuple(sorted(spread(both, parameters, threads), key=lambda x: -x.worst.statistics.rms_m_s))


def sweep(trial: Trial, parameter: Parameter, relative: Sequence[float], threads: int) -> Sweep:
    """`parameter` at each of `relative`, which must contain 0."""
    outcomes = spread(lambda x: trial.outcome(one_off(trial.plant, parameter, x)), relative, threads)
    return Sweep(parameter, tuple(relative), tuple(outcomes))


def together(
    trial: Trial, parameters: Sequence[Parameter], span: float, points: int, seed: int, threads: int
) -> Together:
    """Latin hypercube over ±`span` in all assumed `parameters` that are not nominally zero."""
    from scipy.stats import qmc, spearmanr  # start-up: scipy only where it is needed

    varied = tuple(p for p in parameters if p.assumed and p.nominal != 0.0)
    unit = qmc.LatinHypercube(len(varied), rng=np.random.default_rng(seed)).random(points)
    relative = span * (2.0 * unit - 1.0)
    outcomes = spread(lambda row: trial.outcome(all_off(varied, row)), [row.tolist() for row in relative], threads)
    rms = np.array([outcome.statistics.rms_m_s for outcome in outcomes])
    return Together(
        parameters=varied,
        span=span,
        passes=len(trial.passes),
        relative=relative,
        rms_m_s=rms,
        overspeed=np.array([outcome.statistics.overspeed for outcome in outcomes]),
        stalls=np.array([outcome.statistics.stalled for outcome in outcomes]),
        rank_correlation=np.array([spearmanr(column, rms).statistic for column in relative.T]),
    )


def under_conditions(trial: Trial, named: Sequence[Perturbation], threads: int) -> tuple[Outcome, ...]:
    """Every named condition, in their order."""
    return tuple(spread(trial.outcome, named, threads))


def first_crossing(relative: Sequence[float], rms_m_s: NDArray[np.float64], limit_m_s: float) -> float | None:
    """Where the rms first passes the limit on the way from `relative[0]`; linear between points, None if nowhere."""
    for (x, a), (y, b) in pairwise(zip(relative, rms_m_s.tolist(), strict=True)):
        if b > limit_m_s:
            return float(x + (y - x) * (limit_m_s - a) / (b - a))
    return None


def spread(work: Callable[[Item], Found], items: Iterable[Item], threads: int) -> list[Found]:
    """`work` for all items, in their order, by `threads` threads; each result depends on its item alone."""
    with ThreadPoolExecutor(max_workers=threads) as pool:
        return list(pool.map(work, items))
