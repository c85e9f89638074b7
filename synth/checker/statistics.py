"""Figures of simulated passes, and tests of a stated value that hold for heavy tails too."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Final

from synth.checker.coarse_simulation import Passes

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

    `squares`: e² of each pass, m²/s²; `square_std`: their standard deviation; `over`, `stalls`: numbers of passes;
    `switchings`: mean, and its spread.
    """

    squares: tuple[float, ...]
    mean_square: float
    square_std: float
    bias_m_s: float
    error_std: float
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


def figures_of(passes: Passes, target_m_s: float) -> ExitFigures:
    """The figures of at least two passes."""
    errors = [v - target_m_s for v in passes.exit_m_s]
    squares = tuple(e * e for e in errors)
    mean_square, square_std = mean_and_std(squares)
    bias, error_std = mean_and_std(errors)
    switchings, switchings_std = mean_and_std(passes.switchings)
    return ExitFigures(
        squares=squares,
        mean_square=mean_square,
        square_std=square_std,
        bias_m_s=bias,
        error_std=error_std,
        over=sum(e > OVERSPEED_M_S for e in errors),
        stalls=sum(passes.stalled),
        switchings=switchings,
        switchings_std=switchings_std,
    )


def mean_and_std(values: Sequence[float]) -> tuple[float, float]:
    """Mean, and sample standard deviation."""
    mean = math.fsum(values) / len(values)
    return mean, math.sqrt(math.fsum((x - mean) ** 2 for x in values) / (len(values) - 1))


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
