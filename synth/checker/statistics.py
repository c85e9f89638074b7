"""Figures of simulated passes, and tests of a stated value that hold for heavy tails too."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Final

from synth.checker.coarse_simulation import Passes
from synth.checker.drawn_cuts import GROUP

OVERSPEED_M_S: Final = 0.3
"""An exit faster than the target by more than this is an over-speed."""

FALSE_ALARM: Final = 1e-3
"""Chance that a table whose claims are true has any of them doubted."""
TESTS_A_TABLE: Final = 18
"""Both rms, worse at three caps and better; bias, switchings, over-speed and stalls, too many and too few; with a
simulated prediction also predicted against validated rms, above and below."""
LEVEL: Final = FALSE_ALARM / TESTS_A_TABLE
"""Of one one-sided test."""
QUANTILE: Final = NormalDist().inv_cdf(1.0 - LEVEL)


@dataclass(frozen=True)
class ExitFigures:
    """Of `passes` passes: error e = exit speed − target, m/s; a stalled pass counts with exit speed 0.

    All figures are of cuts as they come: `weights` make up for the friction of the passes (mean 1). `squares`: e² of
    each pass, m²/s²; every `…_std` is the standard deviation of what a pass adds to the mean before it. `over` and
    `stalls` are counted in the `plain` passes, whose friction was drawn as it comes.
    """

    weights: tuple[float, ...]
    squares: tuple[float, ...]
    mean_square: float
    square_std: float
    bias_m_s: float
    error_std: float
    plain: int
    over: int
    stalls: int
    switchings: float
    switchings_std: float

    @property
    def passes(self) -> int:
        """Number of passes."""
        return len(self.squares)

    @property
    def rms_m_s(self) -> float:
        """Root mean square of e."""
        return math.sqrt(self.mean_square)

    @property
    def rms_ci95_m_s(self) -> tuple[float, float]:
        """Its 95 % interval, from the spread between groups of passes; (0, infinity) for a single group."""
        added = [w * (square - self.mean_square) for w, square in zip(self.weights, self.squares, strict=True)]
        groups = [math.fsum(added[i : i + GROUP]) for i in range(0, len(added), GROUP)]
        if len(groups) < 2 or self.mean_square == 0.0:
            return (0.0, math.inf) if self.mean_square else (0.0, 0.0)
        variance = math.fsum(x * x for x in groups) * len(groups) / (len(groups) - 1)
        of_log = 0.5 * student_975(len(groups) - 1) * math.sqrt(variance) / len(added) / self.mean_square
        return self.rms_m_s * math.exp(-of_log), self.rms_m_s * math.exp(of_log)


def figures_of(passes: Passes, target_m_s: float) -> ExitFigures:
    """The figures of at least two passes."""
    errors = [v - target_m_s for v in passes.exit_m_s]
    squares = tuple(e * e for e in errors)
    mean_weight = math.fsum(passes.weight) / len(errors)
    weights = tuple(w / mean_weight for w in passes.weight)
    mean_square, square_std = weighted_mean_and_std(squares, weights)
    bias, error_std = weighted_mean_and_std(errors, weights)
    switchings, switchings_std = weighted_mean_and_std(passes.switchings, weights)
    return ExitFigures(
        weights=weights,
        squares=squares,
        mean_square=mean_square,
        square_std=square_std,
        bias_m_s=bias,
        error_std=error_std,
        plain=sum(passes.as_it_comes),
        over=sum(e > OVERSPEED_M_S and plain for e, plain in zip(errors, passes.as_it_comes, strict=True)),
        stalls=sum(stalled and plain for stalled, plain in zip(passes.stalled, passes.as_it_comes, strict=True)),
        switchings=switchings,
        switchings_std=switchings_std,
    )


def weighted_mean_and_std(values: Sequence[float], weights: Sequence[float]) -> tuple[float, float]:
    """Mean under weights of mean 1, and the sample standard deviation of what a value adds to it."""
    mean = math.fsum(w * x for w, x in zip(weights, values, strict=True)) / len(values)
    square = math.fsum((w * (x - mean)) ** 2 for w, x in zip(weights, values, strict=True))
    return mean, math.sqrt(square / (len(values) - 1))


def student_975(freedom: int) -> float:
    """97.5 % quantile of Student's law, from that of the normal law (Abramowitz and Stegun 26.7.5; 0.3 % off at 4)."""
    if freedom <= 3:
        return (12.706, 4.303, 3.182)[freedom - 1]
    z, n = NormalDist().inv_cdf(0.975), float(freedom)
    first = (z**3 + z) / 4.0
    second = (5 * z**5 + 16 * z**3 + 3 * z) / 96.0
    third = (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384.0
    return z + first / n + second / n**2 + third / n**3


def binomial_tail(hits: int, n: int, p: float) -> float:
    """P(X >= hits) of the binomial law."""
    if hits <= 0 or p >= 1.0:
        return 1.0
    if p <= 0.0:
        return 0.0
    log_odds, log_rest = math.log(p) - math.log1p(-p), n * math.log1p(-p)
    log_n = math.lgamma(n + 1)
    terms = (log_n - math.lgamma(k + 1) - math.lgamma(n - k + 1) + k * log_odds + log_rest for k in range(hits, n + 1))
    return min(1.0, math.fsum(map(math.exp, terms)))


def joint_count(n: int, others: int | None) -> float:
    """As many values have a mean as uncertain as the difference of means of `n` and `others` values; None: exact."""
    return float(n) if others is None else n * others / (n + others)


def score_interval(share: float, n: int) -> tuple[float, float]:
    """Probabilities that a share of `n` trials does not contradict at `LEVEL`, either way (Wilson 1927)."""
    centre, square = share + QUANTILE**2 / (2 * n), QUANTILE**2 / n
    half = QUANTILE * math.sqrt(share * (1.0 - share) / n + square / (4 * n))
    return max(0.0, (centre - half) / (1.0 + square)), min(1.0, (centre + half) / (1.0 + square))


def too_many(hits: int, n: int, p: float) -> bool:
    """Whether `hits` of `n` are more than a probability of at most `p` explains."""
    return binomial_tail(hits, n, p) < LEVEL


def too_few(hits: int, n: int, p: float) -> bool:
    """Whether `hits` of `n` are fewer than a probability of at least `p` explains."""
    return binomial_tail(n - hits, n, 1.0 - p) < LEVEL
