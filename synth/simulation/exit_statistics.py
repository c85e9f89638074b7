"""Figures of quality of a sample of exits, with their confidence intervals (model §3)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from synth.simulation.passes import ExitSample

OVERSPEED_M_S = 0.3
"""An exit that is faster than the target by more than this is an over-speed."""

NORMAL_95 = 1.959963984540054
"""97.5 % quantile of the normal law."""


@dataclass(frozen=True)
class ExitStatistics:
    """Exit-speed error e = V_exit − V_target over `passes` passes; a stalled pass counts with V_exit = 0.

    `rms_ci95_m_s` and `overspeed_ci95` are (low, high); `p99_m_s` is the 99 % quantile of |e|;
    `overspeed` the share of passes with e > 0.3 m/s; `switchings` the mean number of commands per pass.
    """

    passes: int
    rms_m_s: float
    rms_ci95_m_s: tuple[float, float]
    bias_m_s: float
    std_m_s: float
    p99_m_s: float
    overspeed: float
    overspeed_ci95: tuple[float, float]
    stalls: int
    switchings: float


def exit_statistics(sample: ExitSample, target_m_s: float) -> ExitStatistics:
    """Statistics of `sample` against the commanded exit speed; raises `ValueError` for less than two passes."""
    n = len(sample)
    if n < 2:
        raise ValueError(f"exit statistics: {n} passes; at least 2 are needed")
    error = sample.exit_speed_m_s - target_m_s
    over = int(np.count_nonzero(error > OVERSPEED_M_S))
    square = error**2
    return ExitStatistics(
        passes=n,
        rms_m_s=math.sqrt(square.mean()),
        rms_ci95_m_s=rms_interval(float(square.mean()), float(square.std(ddof=1)) / math.sqrt(n)),
        bias_m_s=float(error.mean()),
        std_m_s=float(error.std(ddof=1)),
        p99_m_s=float(np.quantile(np.abs(error), 0.99)),
        overspeed=over / n,
        overspeed_ci95=clopper_pearson(over, n),
        stalls=int(np.count_nonzero(sample.stalled)),
        switchings=float(sample.switchings.mean()),
    )


def pooled_statistics(samples: Sequence[ExitSample], weights: Sequence[float], target_m_s: float) -> ExitStatistics:
    """Statistics of a mixture: stratum i has probability `weights`[i] and was sampled by `samples`[i].

    The intervals follow from the strata's own variances; the one of `overspeed` is normal.
    """
    share = np.concatenate([np.full(len(s), w / len(s)) for s, w in zip(samples, weights, strict=True)])
    share /= share.sum()
    error = np.concatenate([s.exit_speed_m_s for s in samples]) - target_m_s
    over = (error > OVERSPEED_M_S).astype(float)
    mean_square, overspeed = float(share @ error**2), float(share @ over)
    bias = float(share @ error)
    square_se, over_se = 0.0, 0.0
    for s, w in zip(samples, weights, strict=True):
        e = s.exit_speed_m_s - target_m_s
        square_se += (w**2) * float((e**2).var(ddof=1)) / len(s)
        over_se += (w**2) * float((e > OVERSPEED_M_S).var(ddof=1)) / len(s)
    order = np.argsort(np.abs(error))
    p99 = np.abs(error)[order][np.searchsorted(np.cumsum(share[order]), 0.99)]
    half = NORMAL_95 * math.sqrt(over_se)
    return ExitStatistics(
        passes=len(error),
        rms_m_s=math.sqrt(mean_square),
        rms_ci95_m_s=rms_interval(mean_square, math.sqrt(square_se)),
        bias_m_s=bias,
        std_m_s=math.sqrt(max(mean_square - bias**2, 0.0)),
        p99_m_s=float(p99),
        overspeed=overspeed,
        overspeed_ci95=(max(overspeed - half, 0.0), min(overspeed + half, 1.0)),
        stalls=sum(int(np.count_nonzero(s.stalled)) for s in samples),
        switchings=float(share @ np.concatenate([s.switchings for s in samples])),
    )


def rms_interval(mean_square: float, standard_error: float) -> tuple[float, float]:
    """95 % interval of a root mean square, from the mean square and its standard error.

    Normal limits of log(mean square) (delta method: its standard error is the relative one), mapped back;
    so the low limit is never negative, and heavy-tailed errors widen the interval through the variance of e².
    """
    if mean_square == 0.0:
        return 0.0, 0.0
    spread = math.exp(0.5 * NORMAL_95 * standard_error / mean_square)
    rms = math.sqrt(mean_square)
    return rms / spread, rms * spread


def rms_ratio(sample: ExitSample, other: ExitSample, target_m_s: float) -> tuple[float, tuple[float, float]]:
    """rms of `sample` / rms of `other`, same passes, and its 95 % interval (delta method on the logarithm, paired)."""
    a, b = ((x.exit_speed_m_s - target_m_s) ** 2 for x in (sample, other))
    if a.mean() == 0.0 or b.mean() == 0.0:
        raise ValueError("rms ratio: a sample without any error has no ratio")
    ratio = math.sqrt(a.mean() / b.mean())
    of_log = 0.5 * float(np.std(a / a.mean() - b / b.mean(), ddof=1)) / math.sqrt(len(a))
    return ratio, (ratio * math.exp(-NORMAL_95 * of_log), ratio * math.exp(NORMAL_95 * of_log))


def clopper_pearson(hits: int, n: int, confidence: float = 0.95) -> tuple[float, float]:
    """Exact interval of a probability after `hits` in `n` independent trials (Clopper and Pearson 1934)."""
    from scipy.special import betaincinv  # start-up: scipy only where it is needed

    tail = 0.5 * (1.0 - confidence)
    low = 0.0 if hits == 0 else float(betaincinv(hits, n - hits + 1, tail))
    high = 1.0 if hits == n else float(betaincinv(hits + 1, n - hits, 1.0 - tail))
    return low, high
